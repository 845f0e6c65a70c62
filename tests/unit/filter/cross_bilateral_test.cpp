// The cross-bilateral bank and Stein's estimate against their definitions, and against the error that is really made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/isa.h"
#include "filter/cross_bilateral.h"
#include "support/random_planes.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{71, 37};

struct Scene {
    Signals signals;
    Image albedo{kExtent, 3}, light{kExtent, 3};
    explicit Scene(uint32_t seed) {
        Random random(seed);
        signals.reset(kExtent, sureSignals(), 1);
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x) {
                const Vec3 n = normalize(Vec3(0.3f * random.between(-1, 1), 0.3f * random.between(-1, 1), 1));
                for (int c = 0; c < 3; ++c) {
                    signals[Signal::Normal].at(c, x, y) = n[c];
                    albedo.at(c, x, y) = random.between(0.2f, 0.6f);
                    light.at(c, x, y) = random.between(0, 2);
                }
                signals[Signal::InverseDepth].at(0, x, y) = x == 30 ? 0 : 0.5f + 0.01f * random.between(-1, 1);
            }
    }
};

double squared(const Image& image, Pixel p, Pixel q) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::pow(double(image.at(c, p.x, p.y)) - image.at(c, q.x, q.y), 2);
    return sum;
}

TEST(CrossBilateral, EachFilterAndItsRiskAreTheirDefinitions) {
    const Scene scene(1);
    SureSettings settings;
    settings.filters = 2;
    settings.sigmaColour = 1.3f;
    const Isa best = detectIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
        if (isa > best) continue;
        setIsa(isa);
        SureBank bank;
        Image out;
        ASSERT_TRUE(chooseBySure(scene.signals, scene.albedo, settings, scene.light, bank, out, {}));
        for (const Pixel p : {Pixel{0, 0}, Pixel{29, 5}, Pixel{31, 20}, Pixel{70, 36}, Pixel{50, 11}})
            for (int f = 0; f < 2; ++f) {
                const double sigma = 1 << f, variance = bank.variance.at(0, p.x, p.y);
                const int radius = 2 << f;
                double weights = 0, sum[3] = {0, 0, 0}, squares[3] = {0, 0, 0};
                for (int j = -radius; j <= radius; ++j)
                    for (int i = -radius; i <= radius; ++i) {
                        const Pixel q{p.x + i, p.y + j};
                        if (q.x < 0 || q.y < 0 || q.x >= kExtent.width || q.y >= kExtent.height) continue;
                        const double zp = scene.signals[Signal::InverseDepth].at(0, p.x, p.y),
                                     zq = scene.signals[Signal::InverseDepth].at(0, q.x, q.y);
                        if (zq == 0) continue;
                        const double depth = (zq - zp) / zp / 0.05;
                        double e = (i * i + j * j) / (sigma * sigma) +
                                   squared(scene.light, p, q) / (1.3 * 1.3 * variance) +
                                   squared(scene.signals[Signal::Normal], p, q) / (0.8 * 0.8) +
                                   squared(scene.albedo, p, q) / (0.25 * 0.25) + depth * depth;
                        const double w = std::exp(-0.5 * e);
                        weights += w;
                        for (int c = 0; c < 3; ++c) {
                            sum[c] += w * scene.light.at(c, q.x, q.y);
                            squares[c] += w * std::pow(double(scene.light.at(c, q.x, q.y)), 2);
                        }
                    }
                double risk = 0;
                for (int c = 0; c < 3; ++c) {
                    const double mean = sum[c] / weights, value = scene.light.at(c, p.x, p.y);
                    ASSERT_NEAR(bank.filtered[static_cast<size_t>(f)].at(c, p.x, p.y), mean, 1e-4);
                    const double slope = 1 / weights + (squares[c] / weights - mean * mean) / (1.3 * 1.3 * variance);
                    risk += (std::pow(mean - value, 2) + (2 * slope - 1) * variance) / 3;
                }
                ASSERT_NEAR(bank.error[static_cast<size_t>(f)].at(0, p.x, p.y), risk, 1e-3);
            }
    }
    setIsa(best);
}

// On a flat wall the widest filter errs least.
TEST(CrossBilateral, ChoosesWideFiltersWhereNothingIsLost) {
    Scene scene(2);
    Random random(5);
    scene.albedo.fill(0.5f);
    for (int64_t i = 0; i < kExtent.area(); ++i)
        for (int c = 0; c < 3; ++c) {
            scene.signals[Signal::Normal].plane(c).data[i] = c == 2;
            scene.signals[Signal::InverseDepth].data()[i] = 0.5f;
            scene.light.plane(c).data[i] = 1 + 0.3f * random.between(-1, 1);
        }
    SureBank bank;
    Image out;
    ASSERT_TRUE(chooseBySure(scene.signals, scene.albedo, {}, scene.light, bank, out, {}));
    double choice = 0, error = 0;
    for (int64_t i = 0; i < kExtent.area(); ++i) {
        choice += bank.choice.data()[i] / static_cast<double>(kExtent.area());
        error += std::pow(out.data()[i] - 1.0, 2) / static_cast<double>(kExtent.area());
    }
    EXPECT_GT(choice, 2);
    EXPECT_LT(std::sqrt(error), 0.25 * 0.3 / std::sqrt(3.0));
}

// Beside a sharp edge that only light has, narrower filters err less than they do far from it.
TEST(CrossBilateral, ChoosesNarrowFiltersBesideAnEdgeOfLight) {
    constexpr int kEdge = 35;
    Scene scene(3);
    Random random(6);
    scene.albedo.fill(0.5f);
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x)
            for (int c = 0; c < 3; ++c) {
                scene.signals[Signal::Normal].at(c, x, y) = c == 2;
                scene.signals[Signal::InverseDepth].at(0, x, y) = 0.5f;
                scene.light.at(c, x, y) = (x < kEdge ? 0.5f : 2.0f) + 0.3f * random.between(-1, 1);
            }
    SureBank bank;
    Image out;
    ASSERT_TRUE(chooseBySure(scene.signals, scene.albedo, {}, scene.light, bank, out, {}));
    const auto meanOver = [&](auto valueAt, int left, int right) {
        double sum = 0;
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = left; x < right; ++x) sum += valueAt(x, y);
        return sum / ((right - left) * kExtent.height);
    };
    const auto choice = [&](int x, int y) { return double(bank.choice.at(0, x, y)); };
    EXPECT_LT(meanOver(choice, kEdge - 2, kEdge + 2), meanOver(choice, 4, 16) - 0.5);
    const auto error = [&](int x, int y) { return std::pow(out.at(1, x, y) - (x < kEdge ? 0.5 : 2.0), 2); };
    EXPECT_LT(std::sqrt(meanOver(error, kEdge - 2, kEdge + 2)), 0.25) << "of a step of 1.5: it stays sharp";
}

}  // namespace
}  // namespace lumi::test

// The à-trous wavelets of Dammertz et al. 2010 against their definition written out plainly.
#include <gtest/gtest.h>

#include <cmath>

#include "base/isa.h"
#include "filter/edge_avoiding.h"
#include "support/random_planes.h"

namespace lumi::test {
namespace {

TEST(EdgeAvoiding, ALevelIsItsDefinition) {
    const Extent2 extent{51, 23};
    Signals signals;
    signals.reset(extent, SignalSet::all(), 1);
    Random random(5);
    Image in(extent, 3), out;
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            const Vec3 n = normalize(Vec3(random.between(-1, 1), random.between(-1, 1), 1));
            for (int c = 0; c < 3; ++c) {
                signals[Signal::Normal].at(c, x, y) = n[c];
                signals[Signal::Position].at(c, x, y) = random.between(0, 0.4f);
                in.at(c, x, y) = random.between(0, 2);
            }
            signals[Signal::InverseDepth].at(0, x, y) = x == 20 ? 0 : 0.5f;
        }
    const EdgeAvoidingSettings settings{.sigmaColour = 2, .sigmaNormal = 0.5f, .sigmaPosition = 0.15f};
    const double h[5] = {1.0 / 16, 1.0 / 4, 3.0 / 8, 1.0 / 4, 1.0 / 16};
    const auto compare = [&](int level) {
        ASSERT_TRUE(edgeAvoidingLevel(signals, settings, level, in, out, {}));
        const int step = 1 << level;
        for (int y = 0; y < extent.height; ++y)
            for (int x = 0; x < extent.width; ++x) {
                double weights = 0, sums[3] = {0, 0, 0};
                for (int j = -2; j <= 2; ++j)
                    for (int i = -2; i <= 2; ++i) {
                        const int qx = x + i * step, qy = y + j * step;
                        if (qx < 0 || qy < 0 || qx >= extent.width || qy >= extent.height) continue;
                        if ((i != 0 || j != 0) && (x == 20 || qx == 20)) continue;
                        double colour = 0, normal = 0, position = 0;
                        for (int c = 0; c < 3; ++c) {
                            colour += std::pow(double(in.at(c, x, y)) - in.at(c, qx, qy), 2);
                            normal += std::pow(
                                double(signals[Signal::Normal].at(c, x, y)) - signals[Signal::Normal].at(c, qx, qy), 2);
                            position += std::pow(
                                double(signals[Signal::Position].at(c, x, y)) - signals[Signal::Position].at(c, qx, qy),
                                2);
                        }
                        const double w = h[i + 2] * h[j + 2] * std::exp(-colour / std::pow(2.0 / step, 2)) *
                                         std::exp(-normal / std::pow(0.5 * step, 2)) *
                                         std::exp(-position * 0.25 / (0.15 * 0.15));
                        weights += w;
                        for (int c = 0; c < 3; ++c) sums[c] += w * in.at(c, qx, qy);
                    }
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(out.at(c, x, y), sums[c] / weights, 2e-5)
                        << isaName(activeIsa()) << ' ' << x << ' ' << y;
            }
    };
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
        if (isa > detectIsa()) continue;
        setIsa(isa);
        for (const int level : {0, 2}) compare(level);
    }
    setIsa(detectIsa());
}

}  // namespace
}  // namespace lumi::test

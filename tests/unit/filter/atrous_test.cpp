// The à-trous kernels against equations 1 to 5 of Schied et al. 2017 written out plainly, on random planes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/isa.h"
#include "filter/atrous.h"
#include "filter/edge_weights.h"
#include "support/random_planes.h"

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{83, 41};

/// Rec. 709 luminance of the planes' colour.
void fillLuminance(Illumination& planes) {
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x)
            planes.luminance.at(0, x, y) =
                0.2126f * planes.rgb.at(0, x, y) + 0.7152f * planes.rgb.at(1, x, y) + 0.0722f * planes.rgb.at(2, x, y);
}

/// Everything a level reads, at random: a bumpy surface with a stripe of sky.
struct Planes {
    Image inverseDepth{kExtent, 1}, slope{kExtent, 2}, normal{kExtent, 3};
    Illumination light[2];

    explicit Planes(uint32_t seed) {
        Random random(seed);
        for (int y = 0; y < kExtent.height; ++y)
            for (int x = 0; x < kExtent.width; ++x) {
                const bool sky = x > 60 && x < 66;
                Vec3 n = normalize(Vec3(0.15f * random.between(-1, 1), 0.15f * random.between(-1, 1), 1));
                if (sky) n = Vec3(0);
                for (int c = 0; c < 3; ++c) normal.at(c, x, y) = n[c];
                inverseDepth.at(0, x, y) =
                    sky ? 0 : 0.5f + 0.002f * static_cast<float>(x) + 0.001f * random.between(0, 1);
                slope.at(0, x, y) = sky ? 0 : 0.002f;
                slope.at(1, x, y) = sky ? 0 : 0.001f * random.between(-1, 1);
            }
        for (Illumination& planes : light) {
            planes.reset(kExtent);
            for (size_t i = 0; i < planes.rgb.size(); ++i) planes.rgb.data()[i] = random.between(0, 2);
            for (size_t i = 0; i < planes.sampleVariance.size(); ++i)
                planes.sampleVariance.data()[i] = random.between(0, 0.2f);
            fillLuminance(planes);
        }
    }
    SurfaceGuide guide() const {
        SurfaceGuide g;
        g.width = kExtent.width;
        g.height = kExtent.height;
        g.inverseDepth = inverseDepth.data();
        g.slopeX = slope.plane(0).data;
        g.slopeY = slope.plane(1).data;
        for (int c = 0; c < 3; ++c) g.normal[c] = normal.plane(c).data;
        return g;
    }
};

/// w(p, q) of eqs. 2 to 5, in double.
double weight(const Planes& planes, const Illumination& light, const AtrousSettings& settings, Pixel p, Pixel q) {
    const double zp = planes.inverseDepth.at(0, p.x, p.y), zq = planes.inverseDepth.at(0, q.x, q.y);
    const double rise =
        double(planes.slope.at(0, p.x, p.y)) * (p.x - q.x) + double(planes.slope.at(1, p.x, p.y)) * (p.y - q.y);
    const double numerator = settings.edges.planeDistance ? std::abs(zp - zq - rise) : std::abs(zp - zq);
    const double wz = std::exp(-numerator / (settings.edges.sigmaDepth * std::abs(rise) + 1e-3 * zp + 1e-30));
    double cosine = 0;
    for (int c = 0; c < 3; ++c) cosine += double(planes.normal.at(c, p.x, p.y)) * planes.normal.at(c, q.x, q.y);
    const double wn = std::pow(std::max(0.0, cosine), double(settings.edges.sigmaNormal));
    double variance = light.sampleVariance.at(0, p.x, p.y);
    if (settings.variancePrefilter) {
        variance = 0;
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i)
                variance += (2 - std::abs(i)) * (2 - std::abs(j)) / 16.0 *
                            light.sampleVariance.at(0, std::clamp(p.x + i, 0, kExtent.width - 1),
                                                    std::clamp(p.y + j, 0, kExtent.height - 1));
    }
    const double difference = std::abs(double(light.luminance.at(0, p.x, p.y)) - light.luminance.at(0, q.x, q.y));
    return wz * wn * std::exp(-difference / (settings.edges.sigmaLuminance * std::sqrt(variance + 1e-10)));
}

struct Filtered {
    double rgb[3] = {0, 0, 0}, variance = 0;
};

/// Eq. 1 and the variance below it.
Filtered filterPixel(const Planes& planes, const Illumination& light, const AtrousSettings& settings, int step,
                     Pixel p) {
    const double h[5] = {1.0 / 16, 1.0 / 4, 3.0 / 8, 1.0 / 4, 1.0 / 16};
    Filtered sum;
    double weights = 0;
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            const Pixel q{p.x + i * step, p.y + j * step};
            if (q.x < 0 || q.y < 0 || q.x >= kExtent.width || q.y >= kExtent.height) continue;
            const double hw = h[i + 2] * h[j + 2] * (i == 0 && j == 0 ? 1.0 : weight(planes, light, settings, p, q));
            weights += hw;
            for (int c = 0; c < 3; ++c) sum.rgb[c] += hw * light.rgb.at(c, q.x, q.y);
            sum.variance += hw * hw * light.sampleVariance.at(0, q.x, q.y);
        }
    for (double& c : sum.rgb) c /= weights;
    sum.variance /= weights * weights;
    return sum;
}

/// Variance of what `mean` and `centred` stand for, over 7x7 pixels around p.
double windowVariance(const Planes& planes, const AtrousSettings& geometry, const Image& mean, const Image& centred,
                      Pixel p) {
    double weights = 0, first = 0, second = 0;
    for (int j = -3; j <= 3; ++j)
        for (int i = -3; i <= 3; ++i) {
            const Pixel q{p.x + i, p.y + j};
            if (q.x < 0 || q.y < 0 || q.x >= kExtent.width || q.y >= kExtent.height) continue;
            const double w = i == 0 && j == 0 ? 1 : weight(planes, planes.light[0], geometry, p, q),
                         m = mean.at(0, q.x, q.y);
            weights += w;
            first += w * m;
            second += w * (centred.at(0, q.x, q.y) + m * m);
        }
    return second / weights - first * first / (weights * weights);
}

// A weight whose exponent is no number drops its tap, whatever the instruction set.
TEST(Atrous, ANormalThatIsNoNumberHarmsNoneButItsPixel) {
    Planes planes(3);
    for (int c = 0; c < 3; ++c) planes.normal.at(c, 30, 20) = std::numeric_limits<float>::quiet_NaN();
    planes.inverseDepth.at(0, 44, 11) = std::numeric_limits<float>::quiet_NaN();
    const Isa best = detectIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
        if (isa > best) continue;
        setIsa(isa);
        Illumination out[2];
        ASSERT_TRUE(atrousLevel(planes.guide(), AtrousSettings(), 2, {&planes.light[0], &planes.light[1]},
                                {&out[0], &out[1]}, {}));
        for (int component = 0; component < 2; ++component)
            for (size_t i = 0; i < out[component].rgb.size(); ++i)
                ASSERT_TRUE(std::isfinite(out[component].rgb.data()[i])) << isaName(isa) << ' ' << i;
    }
    setIsa(best);
}

TEST(Atrous, EachLevelIsEquation1OnEveryInstructionSet) {
    const Planes planes(1);
    const Isa best = detectIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
        if (isa > best) continue;
        setIsa(isa);
        for (const int step : {1, 2, 16, 64})
            for (const bool variant : {false, true}) {
                AtrousSettings settings;
                settings.edges = {variant ? 0.5f : 1.0f, variant ? 37.0f : 128.0f, variant ? 1.5f : 4.0f, variant};
                settings.variancePrefilter = !variant;
                Illumination out[2];
                ASSERT_TRUE(atrousLevel(planes.guide(), settings, step, {&planes.light[0], &planes.light[1]},
                                        {&out[0], &out[1]}, {}));
                for (int component = 0; component < 2; ++component)
                    for (int y = 0; y < kExtent.height; ++y)
                        for (int x = 0; x < kExtent.width; ++x) {
                            const Filtered expected =
                                filterPixel(planes, planes.light[component], settings, step, {x, y});
                            for (int c = 0; c < 3; ++c)
                                ASSERT_NEAR(out[component].rgb.at(c, x, y), expected.rgb[c], 3e-4) << x << ' ' << y;
                            ASSERT_NEAR(out[component].sampleVariance.at(0, x, y), expected.variance, 1e-4)
                                << x << ' ' << y;
                            ASSERT_NEAR(out[component].luminance.at(0, x, y),
                                        0.2126 * expected.rgb[0] + 0.7152 * expected.rgb[1] + 0.0722 * expected.rgb[2],
                                        3e-4);
                        }
            }
    }
    setIsa(best);
}

TEST(Atrous, EdgeWeightsAreEquations3To5) {
    const Planes planes(2);
    for (const bool variant : {false, true}) {
        AtrousSettings settings;
        settings.edges = {0.7f, 64, 2, variant};
        settings.variancePrefilter = variant;
        for (const Pixel p : {Pixel{0, 0}, Pixel{40, 20}, Pixel{81, 39}, Pixel{59, 7}}) {
            const EdgeWeights w = edgeWeights(planes.guide(), settings, planes.light[0], p, 1, 1);
            EXPECT_NEAR(w.product(), weight(planes, planes.light[0], settings, p, {p.x + 1, p.y + 1}), 1e-5);
        }
    }
}

TEST(Atrous, SkyTakesNothingAndGivesNothing) {
    Planes planes(3);
    for (int y = 0; y < kExtent.height; ++y) planes.light[0].rgb.at(0, 63, y) = 1e6f;
    fillLuminance(planes.light[0]);
    Illumination out;
    ASSERT_TRUE(atrousLevel(planes.guide(), {}, 2, {&planes.light[0]}, {&out}, {}));
    EXPECT_EQ(out.rgb.at(0, 63, 20), 1e6f);
    EXPECT_LT(out.rgb.at(0, 59, 20), 2.001f);
}

// Sec. 4.2: the bilateral 7x7 estimate, only where the history is short.
TEST(SpatialVariance, IsTheWeightedVarianceOfTheWindowOnEveryInstructionSet) {
    const Planes planes(4);
    Random random(9);
    Image length(kExtent, 1);
    struct Moments {
        Image mean{kExtent, 1}, centred{kExtent, 1}, variance{kExtent, 1};
    } moments[2];
    for (size_t i = 0; i < length.size(); ++i) {
        length.data()[i] = random.between(0, 1) < 0.3f ? 2.0f : 9.0f;
        for (Moments& m : moments) {
            m.mean.data()[i] = random.between(0, 1);
            m.centred.data()[i] = random.between(0, 0.1f);
        }
    }
    const Isa best = detectIsa();
    for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4})
        for (const bool variant : {false, true}) {
            if (isa > best) continue;
            setIsa(isa);
            AtrousSettings geometry;
            geometry.edges = {variant ? 0.5f : 1.0f, variant ? 37.0f : 128.0f, 1e30f, variant};
            std::vector<MomentPlanes> views;
            for (Moments& m : moments) {
                m.variance.fill(-1);
                views.push_back({m.mean.data(), m.centred.data(), m.variance.data()});
            }
            ASSERT_TRUE(estimateVarianceSpatially(planes.guide(), geometry.edges, length.data(), 4, views, {}));
            for (const Moments& m : moments)
                for (int y = 0; y < kExtent.height; ++y)
                    for (int x = 0; x < kExtent.width; ++x) {
                        const double expected = length.at(0, x, y) >= 4
                                                    ? m.centred.at(0, x, y)
                                                    : windowVariance(planes, geometry, m.mean, m.centred, {x, y});
                        ASSERT_NEAR(m.variance.at(0, x, y), expected, length.at(0, x, y) >= 4 ? 0 : 1e-4)
                            << x << ' ' << y;
                    }
        }
    setIsa(best);
}

}  // namespace
}  // namespace lumi::test

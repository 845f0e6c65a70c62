// The light tree: importance bounds what lights cause, the choice is what it says.
#include "trace/light_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "base/error.h"
#include "base/isa.h"
#include "math/hash.h"
#include "math/statistics.h"
#include "math/warp.h"

namespace lumi {
namespace {

float number(uint32_t a, uint32_t b) { return unitFloat(hashCombine(a, b)); }
Vec3 direction(uint32_t i) { return sampleSphere({number(11, i), number(12, i)}); }

/// Small one- and two-sided facets, points and spots all over a box, of intensities over three decades.
std::vector<LightBounds> scattered(uint32_t count) {
    std::vector<LightBounds> lights(count);
    for (uint32_t i = 0; i < count; ++i) {
        LightBounds& b = lights[i];
        const Vec3 at(10 * number(1, i), 3 * number(2, i), 10 * number(3, i));
        const float size = i % 4 == 3 ? 0 : 0.05f * number(4, i);
        b.box = {at - Vec3(size), at + Vec3(size)};
        b.axis = direction(i);
        b.bothSides = i % 4 == 1;
        b.cosSpread = i % 4 == 3 && i % 8 == 3 ? -1 : 1;
        b.cosReach = i % 8 == 7 ? 0.8f : 0;
        b.intensity = std::pow(10.0f, 3 * number(5, i) - 1);
    }
    return lights;
}

LightTreePoint pointAt(const Vec3& p, const Vec3& n, int facing) { return {p.x, p.y, p.z, n.x, n.y, n.z, facing}; }

/// What light `b`, taken as small, causes at a point: the importance without bounds.
double irradiance(const LightBounds& b, const Vec3& p, const Vec3& n, int facing) {
    const Vec3 to = b.box.centre() - p;
    const double d = glm::length(to);
    double leaving = -glm::dot(b.axis, to) / d;
    if (b.bothSides) leaving = std::abs(leaving);
    if (b.cosSpread <= -1) leaving = 1;
    else if (leaving <= b.cosReach) leaving = 0;
    double arriving = facing == 0 ? 1 : glm::dot(n, to) / d;
    if (facing == 2) arriving = std::abs(arriving);
    return b.intensity * leaving * std::max(arriving, 0.0) / (d * d);
}

TEST(LightTree, UniteContainsBoth) {
    const std::vector<LightBounds> lights = scattered(200);
    for (uint32_t i = 0; i + 1 < lights.size(); ++i) {
        LightBounds all = unite(lights[i], lights[i + 1]);
        if (i % 3 == 0 && i + 2 < lights.size()) all = unite(all, lights[i + 2]);
        for (uint32_t k = i; k < i + (i % 3 == 0 && i + 2 < lights.size() ? 3u : 2u); ++k) {
            const LightBounds& one = lights[k];
            EXPECT_EQ(glm::min(all.box.lower, one.box.lower), all.box.lower);
            EXPECT_EQ(glm::max(all.box.upper, one.box.upper), all.box.upper);
            EXPECT_LE(all.cosReach, one.cosReach);
            float cosine = glm::dot(all.axis, one.axis);
            if (all.bothSides) cosine = std::abs(cosine);
            const float spread = std::acos(std::clamp(one.cosSpread, -1.0f, 1.0f));
            const float angle =
                std::acos(std::clamp(cosine, -1.0f, 1.0f)) + (all.bothSides && one.cosSpread <= -1 ? 0 : spread);
            if (all.cosSpread > -1) {
                EXPECT_LE(angle, std::acos(all.cosSpread) + 2e-3f) << i << ' ' << k;
            }
        }
    }
}

TEST(LightTree, EveryLightThatCanReachAPointCanBeDrawn) {
    const std::vector<LightBounds> lights = scattered(700);
    LightTree tree;
    tree.build(lights);
    for (uint32_t trial = 0; trial < 60; ++trial) {
        const Vec3 p(12 * number(21, trial) - 1, 4 * number(22, trial) - 0.5f, 12 * number(23, trial) - 1);
        const Vec3 n = direction(900 + trial);
        const int facing = static_cast<int>(trial % 3);
        double sum = 0;
        for (uint32_t i = 0; i < lights.size(); ++i) {
            const float probability = tree.probability(pointAt(p, n, facing), 0, i);
            sum += probability;
            if (irradiance(lights[i], p, n, facing) > 1e-6) {
                EXPECT_GT(probability, 0) << i;
            }
        }
        EXPECT_LT(sum, 1 + 1e-4);
    }
}

TEST(LightTree, DrawsAsOftenAsItSays) {
    const std::vector<LightBounds> lights = scattered(60);
    LightTree tree;
    tree.build(lights);
    for (const float elsewhere : {0.0f, 3.0f, 1e6f})
        for (int facing = 0; facing < 3; ++facing) {
            const LightTreePoint point = pointAt(Vec3(4, 1.2f, 5), direction(77), facing);
            const int count = 200000;
            std::vector<double> observed(lights.size() + 2, 0), expected(observed.size());
            for (uint32_t k = 0; k < count; ++k) {
                const LightTreeChoice choice = tree.pick(point, elsewhere, {number(31, k), number(32, k)});
                const size_t drawn = choice.elsewhere ? lights.size() : choice.light;
                ++observed[choice.light == ~0u && !choice.elsewhere ? lights.size() + 1 : drawn];
                if (choice.light != ~0u) {
                    const float told = tree.probability(point, elsewhere, choice.light);
                    ASSERT_NEAR(choice.probability, told, 1e-4f * told);
                }
                if (k % 16 == 0 && choice.elsewhere) {
                    ASSERT_GE(choice.u, 0);
                    ASSERT_LE(choice.u, 1);
                }
            }
            double sum = 0;
            for (uint32_t i = 0; i < lights.size(); ++i)
                sum += tree.probability(point, elsewhere, i),
                    expected[i] = count * double(tree.probability(point, elsewhere, i));
            const double other = elsewhere > 0 ? 1 - tree.share(point, elsewhere) : 0.0;
            expected[lights.size()] = count * other;
            expected.back() = count * std::max(0.0, 1 - sum - other);
            EXPECT_GT(chiSquareTest(observed, expected), 1e-3) << elsewhere << ' ' << facing;
        }
}

/// A lit ceiling of small facets that face down, unequally bright, some of them dark.
std::vector<LightBounds> panel(uint32_t side) {
    std::vector<LightBounds> lights(side * side);
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const Vec3 at(static_cast<float>(i % side) * 0.1f, 3, static_cast<float>(i / side) * 0.1f);
        lights[i].box = {at - Vec3(0.05f, 0, 0.05f), at + Vec3(0.05f, 0, 0.05f)};
        lights[i].axis = Vec3(0, -1, 0);
        lights[i].intensity = i % 7 == 3 ? 0.0f : 0.2f + number(61, i);
    }
    return lights;
}

/// All lights of the panel, and none besides, reach a point below that looks up, as often as is told.
void expectDrawnAsTold(const LightTree& tree, std::span<const LightBounds> panel, const Vec3& below) {
    const LightTreePoint point = pointAt(below, Vec3(0, 1, 0), 1);
    const int count = 300000;
    std::vector<double> observed(panel.size(), 0), expected(panel.size());
    for (uint32_t k = 0; k < count; ++k) {
        const LightTreeChoice choice = tree.pick(point, 0, {number(71, k), number(72, k)});
        ASSERT_LT(choice.light, panel.size());
        ++observed[choice.light];
        const float told = tree.probability(point, 0, choice.light);
        ASSERT_NEAR(choice.probability, told, 1e-4f * told);
    }
    double sum = 0;
    for (uint32_t i = 0; i < panel.size(); ++i) {
        const float probability = tree.probability(point, 0, i);
        sum += probability;
        expected[i] = count * double(probability);
        EXPECT_EQ(probability > 0, panel[i].intensity > 0);
    }
    EXPECT_NEAR(sum, 1, 1e-4);
    EXPECT_GT(chiSquareTest(observed, expected), 1e-3) << below.y;
}

TEST(LightTree, FarGroupsAreDrawnByIntensityAndAsTheySay) {
    const std::vector<LightBounds> lights = panel(24);
    LightTree tree;
    tree.build(lights);
    for (const Vec3& p : {Vec3(1, 2.8f, 1), Vec3(0.5f, 1, 2), Vec3(-8, -20, 3)}) expectDrawnAsTold(tree, lights, p);
    // From far below, all are as one.
    const LightTreePoint far = pointAt(Vec3(1, -500, 1), Vec3(0, 1, 0), 1);
    double total = 0;
    for (const LightBounds& light : lights) total += light.intensity;
    for (uint32_t i = 0; i < lights.size(); i += 5)
        EXPECT_NEAR(tree.probability(far, 0, i), lights[i].intensity / total,
                    1e-3 * lights[i].intensity / total + 1e-9);
}

// Beside a sun, here below the horizon, double precision has no digits for a sum of faint lights that goes on from it.
TEST(LightTree, ASunLeavesFaintLightsTheirShare) {
    std::vector<LightBounds> lights = panel(24);
    for (LightBounds& light : lights) light.intensity *= 1e-5f;
    const std::vector<LightBounds> faint = lights;
    for (const float side : {-1.0f, 1.0f}) {
        const Vec3 at = Vec3(side, -0.3f, 0) * 1e6f;
        lights.resize(faint.size());
        lights.push_back({{at - Vec3(1e4f), at + Vec3(1e4f)}, {0, 0, 1}, -1, 0, false, 3e12f});
        LightTree tree;
        tree.build(lights);
        for (const Vec3& p : {Vec3(0.5f, 1, 2), Vec3(-8, -20, 3)}) expectDrawnAsTold(tree, faint, p);
    }
}

TEST(LightTree, ComesCloserToIrradianceThanIntensityAlone) {
    // The second moment of irradiance / probability over draws, against choosing by intensity; a light nearer than its
    // group is large stands out more than a bound of the group can tell, so nearness is limited.
    const std::vector<LightBounds> lights = scattered(2000);
    double total = 0;
    for (const LightBounds& b : lights) total += b.intensity;
    LightTree tree;
    tree.build(lights);
    for (uint32_t trial = 0; trial < 8; ++trial) {
        const Vec3 p(10 * number(41, trial), 3 * number(42, trial), 10 * number(43, trial)), n = direction(500 + trial);
        double byTree = 0, byIntensity = 0;
        for (uint32_t i = 0; i < lights.size(); ++i) {
            const double d2 = glm::dot(lights[i].box.centre() - p, lights[i].box.centre() - p);
            const double e = irradiance(lights[i], p, n, 1) * std::min(1.0, d2 / 0.25),
                         q = tree.probability(pointAt(p, n, 1), 0, i);
            if (e > 0 && q > 0) byTree += e * e / q;
            byIntensity += e * e / (lights[i].intensity / total);
        }
        EXPECT_LT(byTree, 0.6 * byIntensity) << trial;
    }
}

TEST(LightTree, StopsAndIsEmptyThen) {
    LightTree tree;
    tree.build(scattered(3));
    std::stop_source source;
    source.request_stop();
    EXPECT_THROW(tree.build(scattered(100000), source.get_token()), Error);
    EXPECT_TRUE(tree.empty());
    tree.build(scattered(40));
    double sum = 0;
    for (uint32_t i = 0; i < 40; ++i) sum += tree.probability(pointAt(Vec3(0), Vec3(0, 1, 0), 0), 0, i);
    EXPECT_NEAR(sum, 1, 1e-3);
}

TEST(LightTree, EdgeCases) {
    LightTree tree;
    tree.build({});
    EXPECT_TRUE(tree.empty());
    std::vector<LightBounds> lights = scattered(40);
    // All in one place; without intensity; where nothing is.
    for (LightBounds& b : lights) b.box = {Vec3(1), Vec3(1)}, b.cosSpread = -1;
    lights[3].intensity = 0;
    lights[5].box.lower.x = std::nanf("");
    tree.build(lights);
    const LightTreePoint point = pointAt(Vec3(1, 1, 2), Vec3(0, 0, -1), 1);
    double sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) sum += tree.probability(point, 0, i);
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_EQ(tree.probability(point, 0, 3), 0);
    EXPECT_EQ(tree.probability(point, 0, 5), 0);
    // At the very place of the lights everything stays finite.
    const LightTreeChoice choice = tree.pick(pointAt(Vec3(1), Vec3(0, 1, 0), 1), 1, {0.3f, 0.5f});
    EXPECT_TRUE(std::isfinite(choice.probability));
}

/// An uneven tree of many levels: each cut takes a few lights off.
TEST(LightTree, LightsInAGeometricRow) {
    std::vector<LightBounds> lights(200);
    for (uint32_t i = 0; i < lights.size(); ++i) {
        const float at = std::pow(1.4f, static_cast<float>(i) - 100);
        lights[i].box = {Vec3(at, 0, 0), Vec3(at, 0, 0)};
        lights[i].cosSpread = -1;
        lights[i].intensity = at * at;
    }
    LightTree tree;
    tree.build(lights);
    const LightTreePoint point = pointAt(Vec3(0, 1, 0), Vec3(0, 1, 0), 0);
    double sum = 0;
    for (uint32_t i = 0; i < lights.size(); ++i) sum += tree.probability(point, 0, i);
    EXPECT_NEAR(sum, 1, 1e-4);
    for (uint32_t k = 0; k < 2000; ++k) {
        const LightTreeChoice choice = tree.pick(point, 0, {number(61, k), number(62, k)});
        ASSERT_LT(choice.light, lights.size());
        EXPECT_NEAR(choice.probability / tree.probability(point, 0, choice.light), 1, 1e-4);
    }
}

TEST(LightTree, InstructionSetsAgree) {
    const std::vector<LightBounds> lights = scattered(500);
    LightTree tree;
    tree.build(lights);
    const LightTreePoint point = pointAt(Vec3(4, 1.2f, 5), direction(77), 1);
    const LightTreeKernels& fast = lightTreeKernels();
    std::vector<LightTreeChoice> choices;
    for (uint32_t k = 0; k < 200; ++k) choices.push_back(tree.pick(point, 1, {number(51, k), number(52, k)}));
    const Isa best = activeIsa();
    setIsa(Isa::Baseline);
    LightTree plain;
    plain.build(lights);
    for (uint32_t k = 0; k < 200; ++k) {
        const LightTreeChoice choice = plain.pick(point, 1, {number(51, k), number(52, k)});
        EXPECT_EQ(choice.light, choices[k].light);
        EXPECT_EQ(choice.probability, choices[k].probability);
    }
    setIsa(best);
    EXPECT_EQ(&lightTreeKernels(), &fast);
}

}  // namespace
}  // namespace lumi

// Stable ray tracing's parts against their definitions: Algorithm 1, eq. 1, strata, the filter, the averages.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "filter/scattered.h"
#include "math/hash.h"
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/analysis_kernels.h"
#include "reconstruct/stable/projection_kernels.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/shading.h"
#include "reconstruct/stable/stable_taps.h"
#include "reconstruct/stable/temporal_integration.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace subpixel;

std::vector<uint32_t> randomWords(Extent2 extent, uint32_t seed) {
    std::vector<uint32_t> words(static_cast<size_t>(extent.area()));
    for (size_t i = 0; i < words.size(); ++i) {
        const uint32_t occupancy = hashCombine(static_cast<uint32_t>(i), seed) & 0xFFFFu;
        words[i] = occupancy | (hashCombine(static_cast<uint32_t>(i), seed + 1) & occupancy) << 16;
    }
    return words;
}

// Section 4.1 in words: an empty sub-pixel takes the sample and its occlusion; an occluded sample gives way to an
// unoccluded one; nothing else is written.
TEST(StableAlgorithm1, KeepsTheTruthTable) {
    constexpr int kAt = 6;
    const uint32_t other = bit(3) | bit(9) | bit(9 + kCount), visibleBit = bit(kAt),
                   occludedBits = bit(kAt) | bit(kAt + kCount);
    struct Row {
        uint32_t before;
        bool isOccluded, stored;
        uint32_t after;
    };
    const Row rows[] = {{0, false, true, visibleBit},
                        {0, true, true, occludedBits},
                        {visibleBit, false, false, visibleBit},
                        {visibleBit, true, false, visibleBit},
                        {occludedBits, false, true, visibleBit},
                        {occludedBits, true, false, occludedBits}};
    for (const Row& row : rows) {
        uint32_t word = row.before | other;
        EXPECT_EQ(store(word, kAt, row.isOccluded), row.stored) << std::hex << row.before << ' ' << row.isOccluded;
        EXPECT_EQ(word, row.after | other) << std::hex << row.before << ' ' << row.isOccluded;
    }
}

TEST(StableAnalysis, Equation1) {
    const DensitySettings one{1, 1, 0.5f}, four{4, 0.5f, 0.5f}, coarse{0.5f, 1, 0.5f};
    EXPECT_EQ(sampleChange(0, one), 1);  // where the difference equals the tolerance it acts
    EXPECT_EQ(sampleChange(0.25f, one), 0);
    EXPECT_EQ(sampleChange(1.75f, one), 0);
    EXPECT_EQ(sampleChange(2, one), -1);
    EXPECT_EQ(sampleChange(2.25f, one), -2);  // rounded away from zero
    EXPECT_EQ(sampleChange(0, four), 4);
    EXPECT_EQ(sampleChange(3.5f, four), 1);
    EXPECT_EQ(sampleChange(3.75f, four), 0);
    EXPECT_EQ(sampleChange(8, four), -4);
    EXPECT_EQ(sampleChange(0, coarse), 1);  // the tolerance is at most the target
}

TEST(StableAnalysis, DensityOfRowsIsThatOfTheWindow) {
    for (const Extent2 extent : {Extent2{1, 1}, Extent2{1, 5}, Extent2{6, 1}, Extent2{2, 2}, Extent2{67, 9}}) {
        const std::vector<uint32_t> words = randomWords(extent, 5);
        std::vector<float> density(words.size());
        std::vector<PixelChange> changes;
        analyseSamples(words, extent, {3, 0.5f, 0}, 1, changes, density.data(), {});
        for (int y = 0; y < extent.height; ++y)
            for (int x = 0; x < extent.width; ++x) {
                const size_t p = static_cast<size_t>(y * extent.width + x);
                ASSERT_EQ(density[p], localDensity(words, extent, x, y))
                    << extent.width << 'x' << extent.height << ' ' << x << ' ' << y;
                const PixelChange expected = changePixel(words[p], sampleChange(density[p], {3, 0.5f, 0}),
                                                         pixelRandom(static_cast<int64_t>(p), 1));
                EXPECT_EQ(changes[p].added, expected.added);
                EXPECT_EQ(changes[p].removed, expected.removed);
            }
    }
}

// A full window of 2 x 2 pixels holds 64 sub-pixels: 16 samples a pixel.
TEST(StableAnalysis, AFullScreenHasSixteenSamplesAPixel) {
    const Extent2 extent{5, 4};
    const std::vector<uint32_t> full(20, 0xFFFFu), hidden(20, 0xFFFFFFFFu);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
            EXPECT_EQ(localDensity(full, extent, x, y), 16);
            EXPECT_EQ(localDensity(hidden, extent, x, y), 0);
        }
}

TEST(StableAnalysis, AddsToTheEmptiestStratumAndRemovesFromTheFullest) {
    std::set<uint32_t> drawn;
    for (uint32_t random = 0; random < 200; ++random) {
        const uint32_t word = kStratum[0] | bit(2) | bit(8) | bit(9);  // 4, 1, 2 and 0 samples
        const PixelChange more = changePixel(word, 1, random), less = changePixel(word, -1, random);
        EXPECT_EQ(std::popcount(more.added), 1);
        EXPECT_EQ(more.added & ~kStratum[3], 0u);
        EXPECT_EQ(std::popcount(less.removed), 1);
        EXPECT_EQ(less.removed & ~kStratum[0], 0u);
        drawn.insert(more.added);
        // Six more: 1 -> stratum 3, then 1, 3 in any order, and so on until all have three or four.
        const PixelChange many = changePixel(word, 6, random);
        const uint32_t after = word | many.added;
        for (const uint32_t stratum : kStratum) EXPECT_GE(std::popcount(after & stratum), 3);
        EXPECT_EQ(std::popcount(changePixel(word, -16, random).removed), 7);
        EXPECT_EQ(std::popcount(changePixel(word, 16, random).added), 9);
    }
    EXPECT_EQ(drawn.size(), 4u);  // any of the stratum's four
}

TEST(StableAnalysis, TiesAreDrawnEvenly) {
    int counts[kStrata] = {};
    constexpr int kDraws = 4000;
    for (uint32_t random = 0; random < kDraws; ++random)
        for (int s = 0; s < kStrata; ++s)
            counts[s] += (changePixel(0, 1, pixelRandom(random, 3)).added & kStratum[s]) != 0;
    for (const int count : counts) EXPECT_NEAR(count, kDraws / 4, 5 * std::sqrt(kDraws * 3 / 16.0));
}

// A free sub-pixel first; where there is none, an occluded sample gives way; visible ones never.
TEST(StableAnalysis, NewSamplesTakeFreeSubpixelsThenOccludedOnes) {
    const uint32_t others = kStratum[0] | kStratum[1] | kStratum[2];
    const uint32_t occludedStratum = kStratum[3] | kStratum[3] << kCount;
    for (uint32_t random = 0; random < 64; ++random) {
        const uint32_t oneFree = (others | occludedStratum) & ~(bit(15) | bit(15 + kCount));
        EXPECT_EQ(changePixel(oneFree, 1, random).added, bit(15));
        EXPECT_EQ(changePixel(others | occludedStratum, 1, random).added & ~kStratum[3], 0u);
        EXPECT_EQ(changePixel(0xFFFFu, 4, random).added, 0u);
        EXPECT_EQ(changePixel(0xFFFFFFFFu, -4, random).removed, 0u);
    }
}

TEST(StableAnalysis, NewSamplesLieInTheirSubpixelAtTheStratumsMiddle) {
    for (int sub = 0; sub < kCount; ++sub)
        for (uint32_t random = 0; random < 100; ++random) {
            const Vec2 wide = newSamplePlace(sub, 1, random), near = newSamplePlace(sub, 0, random);
            EXPECT_EQ(at(wide), sub);
            EXPECT_EQ(at(near), sub);
            const Vec2 middle(sub % 4 < 2 ? 0.25f : 0.75f, sub / 4 < 2 ? 0.25f : 0.75f);
            EXPECT_LT(glm::distance(near, middle), 0.01f);
        }
}

// Many at a time as one by one, on every instruction set: in front of the camera and behind it, off the screen, in the
// sky, and those that have no place at all.
TEST(StableReprojection, KernelsFindWhatIsFoundOneByOne) {
    constexpr uint32_t kCount = 1000;
    std::vector<SampleLocation> locations(kCount);
    std::vector<Vec3> inWorld(kCount);
    std::vector<uint8_t> flags(kCount);
    for (uint32_t i = 0; i < kCount; ++i) {
        const auto draw = [&](uint32_t k) { return 2 * unitFloat(hashCombine(i, k, 31)) - 1; };
        inWorld[i] = Vec3(3 * draw(0), 2 * draw(1), 4 * draw(2));
        const bool sky = i % 5 == 0;
        locations[i] = sky ? SampleLocation::ofSky(inWorld[i]) : SampleLocation{1, i, 0, 0};
        flags[i] = static_cast<uint8_t>((sky ? SampleSet::kSky : 0) | (i % 3 == 0 ? SampleSet::kOccluded : 0));
        if (i % 17 == 0) inWorld[i] = Vec3(NAN);
    }
    Camera camera;
    camera.eye = Vec3(0, 0, 3), camera.target = Vec3(0);
    for (const Projection projection : {Projection::Perspective, Projection::Orthographic}) {
        camera.projection = projection;
        const ScreenPlaces screen(poseCamera(camera, {75, 41}));
        std::vector<Vec2> places(kCount);
        std::vector<uint32_t> targets(kCount), rows(kCount);
        ProjectionRow row;
        screen.describe(row);
        row.inWorld = &inWorld[0].x, row.flags = flags.data(), row.count = kCount, row.nowhere = 41;
        row.places = &places[0].x, row.targets = targets.data(), row.rows = rows.data();
        const Isa best = activeIsa();
        for (const Isa isa : {Isa::Baseline, Isa::V3, Isa::V4}) {
            if (isa > best) continue;
            setIsa(isa);
            projectionKernels().project(row);
            int found = 0;
            for (uint32_t i = 0; i < kCount; ++i) {
                Vec2 place(0);
                float depth = 0;
                const bool there = screen.find(locations[i], inWorld[i], place, depth);
                ASSERT_EQ(rows[i], there ? static_cast<uint32_t>(place.y) : 41) << i;
                if (!there) continue;
                ++found;
                EXPECT_EQ(places[i], place);
                const auto sub = static_cast<uint32_t>(at(place - glm::floor(place)));
                EXPECT_EQ(targets[i], (static_cast<uint32_t>(place.x) * 16 + sub) | (i % 3 == 0 ? 1u << 31 : 0));
            }
            EXPECT_GT(found, 50);
        }
        setIsa(best);
    }
}

TEST(StableGathering, MovingAverageAndMean) {
    GatheringSettings settings;
    settings.indirectAlpha = 0.25f;
    Vec3 average(0);
    uint16_t paths = 0;
    double expected = 0;
    for (int n = 1; n <= 12; ++n) {
        addToAverage(average, paths, Vec3(static_cast<float>(n * n)), false, settings);
        expected += (n * n - expected) * std::max(0.25, 1.0 / n);
        EXPECT_NEAR(average.x, expected, 1e-4) << n;
    }
    // Still: from there on as many as the moving average is worth, and one more each.
    const double start = expected, startCount = 4;
    for (int n = 1; n <= 20; ++n) addToAverage(average, paths, Vec3(7), true, settings);
    EXPECT_NEAR(average.x, (start * startCount + 7 * 20) / (startCount + 20), 1e-4);
    EXPECT_EQ(paths, 24);
}

// Section 4.4 as a double loop over all samples and pixels.
TEST(ScatteredFilter, IsTheTruncatedGaussian) {
    const Extent2 extent{13, 37};
    std::vector<uint32_t> first;
    std::vector<Vec2> places;
    std::vector<Vec3> colours;
    std::vector<uint8_t> hidden;
    for (uint32_t p = 0; p < 13 * 37; ++p) {
        first.push_back(static_cast<uint32_t>(places.size()));
        for (uint32_t k = 0; k < pcgHash(p) % 4; ++k) {
            const uint32_t random = hashCombine(p, k, 9);
            places.push_back(Vec2(p % 13, p / 13) + Vec2(unitFloat(random), unitFloat(pcgHash(random))));
            colours.push_back(Vec3(unitFloat(pcgHash(random + 1)), 4 * unitFloat(pcgHash(random + 2)), 0.5f));
            hidden.push_back(pcgHash(random + 3) % 5 == 0);
        }
    }
    first.push_back(static_cast<uint32_t>(places.size()));
    colours[7] = Vec3(NAN, 0, 0);
    for (const auto& [toneMapped, sigma] : {std::pair(false, 0.5f), std::pair(true, 0.7f)}) {
        ScatteredSettings settings;
        settings.toneMapped = toneMapped, settings.sigma = sigma;
        Image out, weights;
        reconstructScattered({extent, first, places, colours, hidden}, settings, out, weights, {});
        for (int y = 0; y < extent.height; ++y)
            for (int x = 0; x < extent.width; ++x) {
                double weight = 0, toned = 0, sum[3] = {};
                for (size_t i = 0; i < places.size(); ++i) {
                    if (hidden[i] || i == 7 || std::abs(int(places[i].x) - x) > 1 || std::abs(int(places[i].y) - y) > 1)
                        continue;
                    const double dx = places[i].x - x - 0.5, dy = places[i].y - y - 0.5,
                                 w = std::exp(-(dx * dx + dy * dy) / (2.0 * sigma * sigma));
                    const double tone = toneMapped ? 1 + luminance(colours[i]) : 1;
                    weight += w, toned += w / tone;
                    EXPECT_NEAR(
                        scatteredWeight(settings, Vec2(static_cast<float>(dx), static_cast<float>(dy)), colours[i]),
                        w / tone, 1e-5);
                    for (int c = 0; c < 3; ++c) sum[c] += w * colours[i][c] / tone;
                }
                EXPECT_NEAR(weights.at(0, x, y), toned, 1e-4);
                if (weight == 0) continue;
                Vec3 mean(sum[0] / weight, sum[1] / weight, sum[2] / weight);
                if (toneMapped) mean /= 1 - luminance(mean);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(out.at(c, x, y), mean[c], 1e-4 * (1 + mean[c])) << x << ' ' << y;
            }
    }
}

// What is compressed before the filter comes out whole, however bright: a sun among lamps.
TEST(ScatteredFilter, KeepsRadianceOfAnyHeight) {
    const std::vector<uint32_t> first{0, 1};
    const std::vector<Vec2> places{{0.3f, 0.6f}};
    for (const float radiance : {1e-4f, 1.0f, 1e5f, 1e7f, 1e12f}) {
        const std::vector<Vec3> colours{Vec3(radiance, 0.5f * radiance, 0)};
        Image out, weights;
        EXPECT_EQ(reconstructScattered({{1, 1}, first, places, colours, {}}, {}, out, weights, {}), 0);
        EXPECT_NEAR(out.at(0, 0, 0) / radiance, 1, 1e-5) << radiance;
        EXPECT_NEAR(out.at(1, 0, 0) / radiance, 0.5, 1e-5) << radiance;
    }
}

TEST(ScatteredFilter, FillsWhatNoSampleIsNearAndCountsIt) {
    const Extent2 extent{9, 1};
    std::vector<uint32_t> first(10, 1);
    first[0] = 0;
    const std::vector<Vec2> places{{0.5f, 0.5f}};
    const std::vector<Vec3> colours{Vec3(3, 2, 1)};
    Image out, weights;
    EXPECT_EQ(reconstructScattered({extent, first, places, colours, {}}, {}, out, weights, {}), 7);
    for (int x = 0; x < 9; ++x) EXPECT_NEAR(out.at(0, x, 0), 3, 1e-5) << x;
    const std::vector<uint8_t> hidden{1};
    EXPECT_EQ(reconstructScattered({extent, first, places, colours, hidden}, {}, out, weights, {}), 9);
    for (int x = 0; x < 9; ++x) EXPECT_EQ(out.at(0, x, 0), 0);
}

TEST(StableTaps, SubpixelsAreDrawnAsPixels) {
    SampleSet samples;
    samples.extent = {8, 8};
    samples.words.assign(64, 0);
    samples.words[4 * 8 + 4] = bit(0) | bit(5) | bit(5 + kCount);
    Image out;
    drawSubpixels(samples, out);
    // The window is 2 x 2 pixels, from (3, 3): pixel (4, 4) begins in the middle.
    EXPECT_GT(out.at(2, 4, 4), 0.5f);
    EXPECT_LT(out.at(0, 4, 4), 0.5f);
    EXPECT_GT(out.at(0, 5, 5), 0.5f);
    EXPECT_LT(out.at(2, 5, 5), 0.5f);
    EXPECT_LT(out.at(0, 6, 6), 0.1f);
}

TEST(StableTemporal, MotionIsTheLongestOfAPixelsVisibleSamples) {
    const std::vector<uint32_t> first{0, 3, 3, 5};  // three samples, none, two
    const std::vector<Vec2> motions{{1, 0}, {-2, 2}, {9, 9}, {0, -1}, {0.5f, 0}};
    const std::vector<uint8_t> hidden{0, 0, 1, 0, 0};
    Image out({3, 1}, 2);
    longestMotions(first, motions, hidden, out);
    const float expected[3][2] = {{-2, 2}, {0, 0}, {0, -1}};
    for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 2; ++c) EXPECT_EQ(out.at(c, x, 0), expected[x][c]) << x << ' ' << c;
}

// What samples average is what the signals call indirect diffuse light, where two lobes overlap, too.
TEST(StableShading, AveragesWhatTheDiffuseLobeReflects) {
    test::TinyScene tiny;
    Material glossy;  // a diffuse base under a layer that reflects
    glossy.baseColor = {0.6f, 0.3f, 0.2f};
    glossy.roughness = 0.35f;
    Material wall = test::lambert(0.7f);
    tiny.add(test::floorMesh(8), glossy);
    tiny.add(rectangleMesh(8, 8, Facing::Z), wall, test::translation({0, 2, -2}));
    Light lamp;
    lamp.type = LightType::Sphere;
    lamp.radius = 0.3f;
    lamp.radiance = Vec3(30);
    tiny.addLight(lamp, test::translation({0, 3, 1}));
    const auto posed = tiny.pose();
    Tracer tracer;
    tracer.bind(posed);
    const Extent2 extent{64, 48};
    const auto pixels = static_cast<size_t>(extent.area());
    for (const bool roulette : {false, true}) {
        PathSettings path = test::plainPaths(4);
        path.roulette = roulette, path.rouletteDepth = 1;
        const FrameSampling sampling = test::frameOf(test::lookFrom({0, 1.5f, 4}, {0, 0.3f, 0}), extent, 1, path,
                                                     {Signal::Noisy, Signal::Albedo, Signal::IndirectDiffuse});
        std::vector<Vec3> direct(pixels, Vec3(0)), share(pixels, Vec3(0));
        SplitObserver split(direct, share);
        PathObserver* const extra[] = {&split};
        Signals signals;
        ASSERT_TRUE(tracer.sample(sampling, signals, {}, extra));
        double indirect = 0, bothLobes = 0;
        for (size_t i = 0; i < pixels; ++i)
            for (int c = 0; c < 3; ++c) {
                const auto of = [&](Signal signal) { return signals[signal].plane(c).data[i]; };
                const float expected = of(Signal::IndirectDiffuse) * of(Signal::Albedo);
                ASSERT_NEAR((of(Signal::Noisy) - direct[i][c]) * share[i][c], expected, 1e-4f * (1 + of(Signal::Noisy)))
                    << i << ' ' << c;
                indirect += expected;
                bothLobes += share[i][c] > 0.1f && share[i][c] < 0.9f;
            }
        EXPECT_GT(indirect, 100);
        EXPECT_GT(bothLobes, 300);
    }
}

}  // namespace
}  // namespace lumi

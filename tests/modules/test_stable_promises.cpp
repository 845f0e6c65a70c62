// What stable ray tracing promises of its samples in scenes where they could go wrong.
#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <set>

#include "base/parallel.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/stable.h"
#include "support/own_rays_player.h"

namespace lumi::test {
namespace {

int countVisible(const SampleSet& samples) {
    int count = 0;
    for (const uint32_t word : samples.words) count += std::popcount(subpixel::visible(word));
    return count;
}

/// Calls what with the index of each visible sample.
template <class What>
void forVisible(const SampleSet& samples, What what) {
    for (size_t p = 0; p < samples.words.size(); ++p) {
        uint32_t i = samples.first[p];
        for (uint32_t bits = subpixel::occupied(samples.words[p]); bits; bits &= bits - 1, ++i)
            if (subpixel::visible(samples.words[p]) & (bits & (~bits + 1))) what(i);
    }
}

// All of a lamp's body is one primitive: what the camera passes on the way round must not stay visible from behind,
// black.
TEST(StablePromises, NoSampleOfALampIsBlack) {
    const Extent2 extent{64, 48};
    Player player(extent);
    StableModule module;
    module.resize(extent);
    const auto posed = sceneOf(1);
    const auto orbit = [](float turn) {
        return lookFrom(Vec3(1.5f * std::sin(turn), 1.3f, 1.5f * std::cos(turn) - 0.5f), Vec3(0, 1.3f, -0.5f));
    };
    for (FrameNumber frame = 0; frame < 30; ++frame) {
        const float turn = 0.08f * static_cast<float>(frame);
        ASSERT_EQ(player.run(module, frame, posed, orbit(turn), orbit(turn - 0.08f), {.camera = true}),
                  RunResult::Completed);
        int onLamp = 0;
        forVisible(module.samples(), [&](uint32_t i) {
            if (module.samples().locations[i].isSky() || module.samples().locations[i].instance != 3) return;
            ++onLamp;
            EXPECT_GT(module.samples().direct[i].x, 10) << "frame " << frame;
        });
        EXPECT_GT(onLamp, 20);
    }
}

// Each sample draws once whether a sheet stops its rays: while nothing moves, verifying again finds the same.
TEST(StablePromises, BlendedSurfacesKeepTheirDraws) {
    const Extent2 extent{64, 48};
    Player player(extent);
    StableModule module;
    module.resize(extent);
    const auto posed = sceneOf(1);
    std::vector<uint32_t> words;
    int onSheet = 0;
    for (FrameNumber frame = 0; frame < 16; ++frame) {
        ASSERT_EQ(player.run(module, frame, posed, view(), view(), {.camera = true}), RunResult::Completed);
        if (frame == 10) words = module.samples().words;
    }
    int changed = 0;
    for (size_t p = 0; p < words.size(); ++p) changed += words[p] != module.samples().words[p];
    EXPECT_LT(changed, 10);
    forVisible(module.samples(), [&](uint32_t i) { onSheet += module.samples().locations[i].instance == 1; });
    EXPECT_GT(onSheet, 30);
}

// That of scenes/text-plane.json comes nearer by half a percent a frame at most; at 3% samples spread faster than the
// default tolerance has them replaced.
TEST(StablePromises, DensityStaysWhileTheCameraComesNearer) {
    const Extent2 extent{96, 64};
    for (const float step : {0.01f, 0.03f}) {
        for (const float density : {1.0f, 2.0f}) {
            Player player(extent);
            StableModule module;
            module.resize(extent);
            setParameter([&](ParameterVisitor& v) { module.describe(v); }, "density", density);
            const auto posed = sceneOf(1);
            const auto nearer = [&](FrameNumber frame) {
                return lookFrom(Vec3(0, 1, 0) + Vec3(0, 0.6f, 3.5f) * std::pow(1 - step, static_cast<float>(frame)),
                                Vec3(0, 0.4f, -1));
            };
            for (FrameNumber frame = 0; frame < 40; ++frame) {
                ASSERT_EQ(player.run(module, frame, posed, nearer(frame), nearer(frame - 1), {.camera = true}),
                          RunResult::Completed);
                if (frame >= 10) {
                    ASSERT_NEAR(countVisible(module.samples()) / (96.0 * 64 * density), 1, step < 0.02f ? 0.15 : 0.2)
                        << step << " frame " << frame;
                }
            }
        }
    }
}

// Blocks of pixels side by side, and batches that are handed on in the middle of a row.
TEST(StablePromises, WideImagesAreTheSameOnAnyNumberOfThreads) {
    const Extent2 extent{400, 20};
    for (const char* batches : {"dense", "per-pixel"}) {
        std::string first;
        for (const int threads : {1, 8}) {
            setThreadCount(threads);
            Player player(extent);
            StableModule module;
            module.resize(extent);
            setParameter([&](ParameterVisitor& v) { module.describe(v); }, "density", 4.0f);
            setParameter([&](ParameterVisitor& v) { module.describe(v); }, "batches", batches);
            const auto posed = sceneOf(1);
            std::string all;
            for (FrameNumber frame = 0; frame < 3; ++frame) {
                const auto nearer = [](FrameNumber f) {
                    return lookFrom(Vec3(0.02f * static_cast<float>(f), 1.6f, 3.5f), Vec3(0, 0.6f, 0));
                };
                ASSERT_EQ(player.run(module, frame, posed, nearer(frame), nearer(frame - 1), {.camera = true}),
                          RunResult::Completed);
                all += player.digest(module) + '\n';
            }
            if (first.empty()) first = all;
            EXPECT_EQ(all, first) << batches;
        }
    }
    setThreadCount(0);
}

// All samples of a dense screen land in a few pixels as the camera jumps back: 16 at most stay in each, and the
// analysis thins them out at once.
TEST(StablePromises, APileOfSamplesLeavesSixteenAPixel) {
    const Extent2 extent{64, 48};
    Tracer tracer;
    const auto posed = sceneOf(1);
    tracer.bind(posed);
    Player player(extent);
    StableModule module;
    module.resize(extent);
    setParameter([&](ParameterVisitor& v) { module.describe(v); }, "density", 8.0f);
    ASSERT_EQ(player.run(module, 0, posed, view(), view(), {}), RunResult::Completed);
    SampleSet dense = module.samples();
    ASSERT_GT(dense.size(), 7u * 64 * 48);
    for (size_t i = 0; i < dense.size(); i += 3) dense.flags[i] |= SampleSet::kOccluded;
    const CameraPose far = poseCamera(lookFrom(Vec3(0, 30, 80), Vec3(0, 0.6f, 0)), extent);
    const Signals signals;
    const TapSet wanted;
    StageTimer timer;
    FrameSampling sampling;
    ReprojectedSamples piled;
    ASSERT_TRUE(reprojectSamples({1,
                                  signals,
                                  *posed,
                                  far,
                                  poseCamera(view(), extent),
                                  {.camera = true},
                                  wanted,
                                  tracer,
                                  sampling,
                                  timer,
                                  {},
                                  {}},
                                 dense, piled));
    std::map<size_t, int> landed;  // what the words cannot tell: how many came
    const ScreenPlaces screen(far);
    for (const SampleLocation& location : dense.locations) {
        Vec2 place;
        float depth = 0;
        if (location.isNew() || !screen.find(location, placeInWorld(tracer, location), place, depth)) continue;
        ++landed[static_cast<size_t>(place.y) * 64 + static_cast<size_t>(place.x)];
    }
    // Of those that land in one sub-pixel the first that is not occluded stays, or else the first (Algorithm 1).
    const auto isOccluded = [&](uint32_t i) { return (piled.targets[i] & ReprojectedSamples::kOccluded) != 0; };
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> stays;  // row, and sub-pixel of it
    int overtaken = 0;
    for (uint32_t i = 0; i < dense.size(); ++i) {
        if (piled.rows[i] >= 48) continue;
        const auto [at, isNew] =
            stays.try_emplace({piled.rows[i], piled.targets[i] & ~ReprojectedSamples::kOccluded}, i);
        if (isNew || !isOccluded(at->second) || isOccluded(i)) continue;
        at->second = i;
        ++overtaken;
    }
    EXPECT_GT(overtaken, 0);
    std::vector<uint32_t> expected, found;
    for (const auto& [place, sample] : stays) expected.push_back(sample);
    for (size_t pixel = 0; pixel < piled.words.size(); ++pixel)
        for (int k = 0; k < std::popcount(subpixel::occupied(piled.words[pixel])); ++k)
            found.push_back(piled.sources[piled.first[pixel] + static_cast<uint32_t>(k)]);
    EXPECT_EQ(found, expected);
    int most = 0;
    for (const auto& [pixel, count] : landed) {
        most = std::max(most, count);
        EXPECT_LE(std::popcount(subpixel::occupied(piled.words[pixel])), count);
    }
    EXPECT_GT(most, 100);
    setParameter([&](ParameterVisitor& v) { module.describe(v); }, "density", 1.0f);
    const Camera back = lookFrom(Vec3(0, 30, 80), Vec3(0, 0.6f, 0));
    for (FrameNumber frame = 1; frame < 4; ++frame)
        ASSERT_EQ(player.run(module, frame, posed, back, frame == 1 ? view() : back, {.camera = true}),
                  RunResult::Completed);
    uint32_t crowd = 0;
    for (size_t p = 0; p < module.samples().words.size(); ++p)
        crowd = std::max(crowd, module.samples().first[p + 1] - module.samples().first[p]);
    EXPECT_LE(crowd, 8u);
}

// Where light has changed shortly before everything stands still, none of then stays in the mean.
TEST(StablePromises, AStoppedLightLeavesNothingBehind) {
    const Extent2 extent{48, 32};
    Player player(extent);
    StableModule module;
    module.resize(extent);
    const auto bright = sceneOf(1, 2000), dim = sceneOf(1, 0);
    for (FrameNumber frame = 0; frame < 8; ++frame)
        ASSERT_EQ(
            player.run(module, frame, frame < 7 ? bright : dim, view(), view(), {.camera = true, .lights = frame == 7}),
            RunResult::Completed);
    for (FrameNumber frame = 8; frame < 12; ++frame)
        ASSERT_EQ(player.run(module, frame, dim, view(), view(), {}), RunResult::Completed);
    forVisible(module.samples(), [&](uint32_t i) {
        EXPECT_LT(maxComponent(module.samples().radiance(i)), 0.2f);  // the sky's 0.1 and its bounces
        EXPECT_LE(module.samples().notes[i].indirectCount, 4);
    });
}

}  // namespace
}  // namespace lumi::test

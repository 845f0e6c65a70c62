// Stable ray tracing over frames: density, sticking to what deforms, convergence, and what vanishes, shrinks or is not
// there.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "reconstruct/stable/stable.h"
#include "reconstruct/stable/verification.h"
#include "reconstruct/supersampling/supersampling.h"
#include "support/stable_rig.h"

namespace lumi::test {
namespace {

/// Share of pixels without a visible sample in their 3 x 3.
double lonelyShare(const SampleSet& samples) {
    const Extent2 extent = samples.extent;
    int64_t lonely = 0;
    for (int y = 0; y < extent.height; ++y)
        for (int x = 0; x < extent.width; ++x) {
            uint32_t visible = 0;
            for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, extent.height - 1); ++ny)
                for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, extent.width - 1); ++nx)
                    visible |= subpixel::visible(samples.words[static_cast<size_t>(ny * extent.width + nx)]);
            lonely += visible == 0;
        }
    return static_cast<double>(lonely) / static_cast<double>(extent.area());
}

double meanVisible(const SampleSet& samples) {
    int64_t sum = 0;
    for (const uint32_t word : samples.words) sum += std::popcount(subpixel::visible(word));
    return static_cast<double>(sum) / static_cast<double>(samples.extent.area());
}

TEST(Stable, KeepsItsDensityWhileTheCameraMoves) {
    const Extent2 extent{120, 80};
    const auto posed = balls().pose();
    for (const float density : {1.0f, 2.0f, 4.0f}) {
        Rig rig(extent);
        StableModule module;
        module.resize(extent);
        set(module, "density", density);
        for (FrameNumber frame = 0; frame < 12; ++frame) {
            rig.run(module, frame, posed, view(0.04f * static_cast<float>(frame)), {.camera = true});
            const SampleSet& samples = module.samples();
            ASSERT_EQ(samples.size(), samples.first.back());
            for (size_t p = 0; p < samples.words.size(); ++p) {
                const uint32_t count = samples.first[p + 1] - samples.first[p];
                ASSERT_EQ(count, static_cast<uint32_t>(std::popcount(subpixel::occupied(samples.words[p]))));
                ASSERT_LE(count, 16u);
                for (uint32_t i = samples.first[p]; i < samples.first[p + 1]; ++i) {
                    ASSERT_EQ(static_cast<size_t>(samples.places[i].y) * 120 + static_cast<size_t>(samples.places[i].x),
                              p);
                    if (!samples.locations[i].isNew()) {
                        ASSERT_EQ(samples.inWorld[i], placeInWorld(rig.tracer, samples.locations[i]));
                    }
                }
            }
        }
        EXPECT_NEAR(meanVisible(module.samples()), density, 0.15 * density);
        EXPECT_LT(lonelyShare(module.samples()), 0.02);
    }
}

/// The balls at rest, in linear colours.
class StillView {
public:
    StillView(Extent2 extent, int depth) : rig_(extent), posed_(balls().pose()) {
        rig_.path = plainPaths(depth);
        module.resize(extent);
        set(module, "tone-mapped", false);
    }
    Image run(FrameNumber frame) { return rig_.run(module, frame, posed_, view(), {}); }

    StableModule module;

private:
    Rig rig_;
    std::shared_ptr<const PosedScene> posed_;
};

// The samples of a still view stay, and their light converges to the mean over all paths of just these samples.
TEST(Stable, AStillViewConvergesLikeTheMeanOfItsSamples) {
    StillView still({24, 16}, 2);
    const auto squares = [](const Image& a, const Image& b) {
        double sum = 0;
        for (size_t i = 0; i < a.size(); ++i) sum += sqr(a.data()[i] - b.data()[i]);
        return sum;
    };
    Image at16, at64, at;
    constexpr FrameNumber kFrames = 1500;
    std::vector<uint32_t> words;
    for (FrameNumber frame = 0; frame < kFrames; ++frame) {
        at = still.run(frame);
        if (frame == 8) words = still.module.samples().words;
        if (frame == 16) at16 = at;
        if (frame == 64) at64 = at;
    }
    EXPECT_EQ(still.module.samples().words, words);
    EXPECT_GT(still.module.convergence().samples,
              static_cast<uint64_t>(kFrames - 8));               // since the last sample was added
    const double ratio = squares(at16, at) / squares(at64, at);  // 4, less what `at` itself errs
    EXPECT_GT(ratio, 3);
    EXPECT_LT(ratio, 5.5);
}

// Switched off and on in a still view, the mean begins with the two latest frames, and light of before a change is not
// in it.
TEST(Stable, ConvergenceCanBeSwitched) {
    StillView still({24, 16}, 2);
    for (FrameNumber frame = 0; frame < 40; ++frame) still.run(frame);
    EXPECT_GT(still.module.convergence().samples, 20u);
    set(still.module, "converge", false);
    for (FrameNumber frame = 40; frame < 50; ++frame) still.run(frame);
    EXPECT_EQ(still.module.convergence().samples, 0u);
    set(still.module, "converge", true);
    still.run(50);
    EXPECT_EQ(still.module.convergence().samples, 2u);
    uint16_t least = 0xFFFF;
    const SampleSet& samples = still.module.samples();
    for (size_t i = 0; i < samples.size(); ++i)
        if (!(samples.flags[i] & SampleSet::kOccluded)) least = std::min(least, samples.notes[i].directCount);
    EXPECT_EQ(least, 2);
    set(still.module, "epsilon", 2e-4f);  // verdicts are found anew
    still.run(51);
    EXPECT_EQ(still.module.convergence().samples, 1u);
    still.run(52);
    EXPECT_EQ(still.module.convergence().samples, 2u);
}

// The same over 256 frames, with the slope printed.
TEST(Stable, TheErrorOfAStillViewFallsLikeOneOverN) {
    StillView still({48, 36}, 3);
    constexpr FrameNumber kAll = 4096, kFirst = 8, kLast = 256;
    std::map<FrameNumber, Image> means;    // by frames
    std::map<FrameNumber, double> shares;  // mean of 1/n over the samples: some were there a few frames before others
    for (FrameNumber frame = 1; frame <= kAll; ++frame) {
        const Image at = still.run(frame - 1);
        if (!std::has_single_bit(static_cast<uint64_t>(frame))) continue;
        means[frame] = at;
        for (const SampleNote& note : still.module.samples().notes) shares[frame] += 1.0 / note.directCount;
    }
    // A mean of n paths is part of that of all N, so that their squared distance is the variance times 1/n - 1/N.
    double sumX = 0, sumY = 0, sumXX = 0, sumXY = 0, count = 0;
    for (FrameNumber n = kFirst; n <= kLast; n *= 2) {
        double squares = 0;
        for (size_t i = 0; i < means[n].size(); ++i)
            squares += sqr(static_cast<double>(means[n].data()[i]) - means[kAll].data()[i]);
        const double samples = static_cast<double>(still.module.samples().size()), paths = samples / shares[n];
        const double error = squares / static_cast<double>(means[n].size()) / (1 - shares[kAll] / shares[n]);
        const double x = std::log(paths), y = std::log(error);
        sumX += x, sumY += y, sumXX += x * x, sumXY += x * y, ++count;
        std::printf("%4d frames, %.1f paths: mean squared error %.4g, times paths %.4g\n", static_cast<int>(n), paths,
                    error, error * paths);
    }
    const double slope = (count * sumXY - sumX * sumY) / (count * sumXX - sumX * sumX);
    std::printf("slope over %d to %d frames: %.3f\n", static_cast<int>(kFirst), static_cast<int>(kLast), slope);
    EXPECT_NEAR(slope, -1, 0.05);
}

TEST(Stable, SamplesStayOnWhatDeforms) {
    const Extent2 extent{96, 54};
    MessageLog log;
    const std::shared_ptr<const Scene> scene = loadScene(LUMISCOPE_SOURCE_DIR "/scenes/parade.json", log);
    const Camera camera = cameraAt(*scene, 0, 0);
    const auto before = poseScene(scene, {1, 1, 1});
    const auto after = poseScene(scene, {1.1f, 1.1f, 1}, before.get());
    Rig rig(extent);
    StableModule module;
    module.resize(extent);
    rig.run(module, 0, before, camera, {});
    const SampleSet old = module.samples();
    rig.run(module, 1, after, camera, {.objects = true});
    const SampleSet& now = module.samples();
    const CameraPose pose = poseCamera(camera, extent);
    std::set<std::array<uint32_t, 4>> known;
    for (const SampleLocation& l : old.locations)
        known.insert({l.instance, l.primitive, std::bit_cast<uint32_t>(l.u), std::bit_cast<uint32_t>(l.v)});
    int deforming = 0, moved = 0;
    for (size_t i = 0; i < now.size(); ++i) {
        const SampleLocation& l = now.locations[i];
        if (now.notes[i].age == 0 || l.isNew() || l.isSky() || !after->instances[l.instance].deformed) continue;
        ++deforming;
        EXPECT_TRUE(known.count({l.instance, l.primitive, std::bit_cast<uint32_t>(l.u), std::bit_cast<uint32_t>(l.v)}));
        // Where the vertices of now put it, found without the tracer.
        const auto& mesh = *scene->instances[l.instance].mesh;
        const auto place = [&](const PosedScene& posed) {
            const UVec3 t = mesh.triangles[l.primitive];
            const auto& p = posed.instances[l.instance].deformed->positions;
            return Vec2(pose.project(transformPoint(posed.instances[l.instance].worldFromObject,
                                                    p[t.x] * (1 - l.u - l.v) + p[t.y] * l.u + p[t.z] * l.v)));
        };
        EXPECT_LT(glm::distance(now.places[i], place(*after)), 0.01f);
        EXPECT_EQ(now.inWorld[i], placeInWorld(rig.tracer, l));
        moved += glm::distance(place(*after), place(*before)) > 0.05f;
    }
    EXPECT_GT(deforming, 20);
    EXPECT_GT(moved, 5);
}

TEST(Stable, WhatVanishesOrShrinksToNothingLeavesNoSample) {
    const Extent2 extent{60, 40};
    Rig rig(extent);
    StableModule module;
    module.resize(extent);
    TinyScene without;
    without.add(floorMesh(), lambert(0.5f));
    without.scene.environment.constant = Vec3(0.2f);
    rig.run(module, 0, balls().pose(), view(), {});
    rig.run(module, 1, balls(0).pose(), view(), {.objects = true});
    rig.run(module, 2, balls(0).pose(), view(), {.objects = true});
    for (const SampleLocation& l : module.samples().locations)
        if (!l.isNew() && !l.isSky()) {
            EXPECT_TRUE(l.instance == 0 || l.instance > 5) << l.instance;
        }
    rig.run(module, 3, without.pose(), view(), {.objects = true});
    EXPECT_NEAR(meanVisible(module.samples()), 1, 0.3);
    for (const SampleLocation& l : module.samples().locations)
        if (!l.isNew() && !l.isSky()) {
            EXPECT_EQ(l.instance, 0u);
        }
    rig.run(module, 4, balls().pose(), view(), {.objects = true});
    rig.run(module, 5, balls().pose(), view(), {.objects = true});
    int onBalls = 0;
    for (const SampleLocation& l : module.samples().locations)
        onBalls += !l.isNew() && !l.isSky() && l.instance >= 1 && l.instance <= 5;
    EXPECT_GT(onBalls, 50);  // what appears in front occludes all samples of its pixels, and takes one of each
}

// Light of before an edit does not come back with what was hidden during it.
TEST(Stable, HiddenSamplesForgetLightThatIsNoMore) {
    const Extent2 extent{60, 40};
    for (const Changes& edit : {Changes{.lights = true}, Changes{.materials = true}, Changes{.sampling = true}}) {
        Rig rig(extent);
        StableModule module;
        module.resize(extent);
        const auto posed = balls().pose();
        const auto hiddenWithLight = [&] {
            const SampleSet& samples = module.samples();
            int count = 0;
            for (size_t p = 0; p < samples.words.size(); ++p) {
                uint32_t i = samples.first[p];
                for (uint32_t bits = subpixel::occupied(samples.words[p]); bits; bits &= bits - 1, ++i)
                    count += !(subpixel::visible(samples.words[p]) & bits & (~bits + 1)) &&
                             samples.notes[i].indirectCount > 0;
            }
            return count;
        };
        FrameNumber frame = 0;
        for (; frame < 6; ++frame)
            rig.run(module, frame, posed, view(0.05f * static_cast<float>(frame)), {.camera = true});
        EXPECT_GT(hiddenWithLight(), 5);
        rig.run(module, frame, posed, view(0.05f * static_cast<float>(frame)), edit);
        EXPECT_EQ(hiddenWithLight(), 0);
    }
}

TEST(Stable, SkyHasSamplesThatTurnWithTheCamera) {
    const Extent2 extent{60, 40};
    Rig rig(extent);
    StableModule module;
    module.resize(extent);
    TinyScene nothing;
    nothing.scene.environment.constant = Vec3(0.25f, 0.5f, 0.75f);
    const auto posed = nothing.pose();
    Image image;
    for (FrameNumber frame = 0; frame < 4; ++frame)
        image = rig.run(module, frame, posed, lookFrom(Vec3(0), Vec3(0.01f * static_cast<float>(frame), 0, -1)),
                        {.camera = true});
    int old = 0;
    for (const SampleNote& note : module.samples().notes) old += note.age == 3;
    EXPECT_GT(old, 1700);
    for (size_t p = 0; p < 2400; ++p) ASSERT_NEAR(image.plane(2).data[p], 0.75f, 1e-5f);
}

TEST(Stable, ATeleportStartsAnew) {
    const Extent2 extent{60, 40};
    Rig rig(extent), other(extent);
    StableModule module, fresh;
    module.resize(extent), fresh.resize(extent);
    const auto posed = balls().pose();
    rig.run(module, 0, posed, view(), {});
    rig.run(module, 1, posed, view(0.1f), {.camera = true});
    const Image a = rig.run(module, 2, posed, view(2), {.cut = true}),
                b = other.run(fresh, 2, posed, view(2), {.cut = true});
    EXPECT_EQ(a, b);
}

TEST(Stable, AnOrthographicCameraWorks) {
    const Extent2 extent{60, 40};
    Rig rig(extent);
    StableModule module;
    module.resize(extent);
    Camera camera = view();
    camera.projection = Projection::Orthographic;
    camera.yMag = 1.5f;
    int kept = 0;
    for (FrameNumber frame = 0; frame < 4; ++frame) {
        camera.eye.x += 0.02f, camera.target.x += 0.02f;
        rig.run(module, frame, balls().pose(), camera, {.camera = true});
    }
    for (const SampleNote& note : module.samples().notes) kept += note.age == 3;
    EXPECT_GT(kept, 1500);
}

// The balancing changes which rays are traced together, and nothing else.
TEST(Stable, BatchesMakeNoDifferenceButInIdleLanes) {
    const Extent2 extent{60, 40};
    Rig a(extent), b(extent);
    StableModule dense, perPixel;
    dense.resize(extent), perPixel.resize(extent);
    set(perPixel, "batches", std::string("per-pixel"));
    const auto posed = balls().pose();
    for (FrameNumber frame = 0; frame < 6; ++frame) {
        const Camera camera = view(0.05f * static_cast<float>(frame));
        ASSERT_EQ(a.run(dense, frame, posed, camera, {.camera = true}),
                  b.run(perPixel, frame, posed, camera, {.camera = true}));
        EXPECT_EQ(dense.verification().rays, dense.verification().lanes);
        EXPECT_EQ(dense.verification().rays, perPixel.verification().rays);
    }
    EXPECT_GT(perPixel.verification().lanes, perPixel.verification().rays * 5 / 4);
}

TEST(Supersampling, IsTheMeanOfItsRays) {
    const Extent2 extent{30, 20};
    Rig rig(extent);
    const auto posed = balls().pose();
    const Camera camera = view();
    for (const int spp : {1, 3, 6}) {
        SupersamplingModule module;
        module.resize(extent);
        set(module, "spp", spp);
        set(module, "filter", std::string("box"));
        set(module, "tone-mapped", false);
        const Image image = rig.run(module, 2, posed, camera, {.cut = true});
        for (int y = 0; y < 20; y += 3)
            for (int x = 0; x < 30; x += 3) {
                std::vector<PathStart> starts;
                std::set<int> columns, rows;
                for (int s = 0; s < spp; ++s) {
                    const Vec2 within = SupersamplingModule::placeInPixel(s, spp, Vec2(0));
                    columns.insert(static_cast<int>(within.x * static_cast<float>(spp)));
                    rows.insert(static_cast<int>(within.y * static_cast<float>(spp)));
                    starts.push_back(cameraStart(poseCamera(camera, extent), Vec2(x, y) + within, Vec2(0.5f), 0));
                    starts.back().key = {static_cast<uint32_t>(x), static_cast<uint32_t>(y),
                                         static_cast<uint32_t>(2 * spp + s)};
                    starts.back().slot = static_cast<uint32_t>(s);
                }
                EXPECT_EQ(columns.size() + rows.size(), static_cast<size_t>(2 * spp));  // rooks
                std::vector<Vec3> radiance(starts.size());
                ASSERT_TRUE(rig.tracer.tracePaths(starts, rig.path, 0, radiance, {}));
                Vec3 mean(0);
                for (const Vec3& r : radiance) mean += r / static_cast<float>(spp);
                for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.at(c, x, y), mean[c], 1e-5f * (1 + mean[c])) << spp;
            }
    }
}

}  // namespace
}  // namespace lumi::test

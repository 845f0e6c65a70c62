// What modules promise that place their own rays, where the catalogue's suite, which makes up signals, does not reach them.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <thread>

#include "base/parallel.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/stable.h"
#include "support/module_harness.h"
#include "support/transport_scene.h"
#include "trace/first_hit_judge.h"

namespace lumi::test {
namespace {

/// A frame of a sequence: where the camera stands, and the size of the ball (-1: there is none).
struct Moment {
    float shift = 0, ball = 1;
    bool operator==(const Moment&) const = default;
};

/// A floor, a ball, a sheet that half of all rays pass, a lamp that is a sphere, and a dim sky.
std::shared_ptr<const PosedScene> sceneOf(float ball, float lamp = 20) {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(Vec3(0.6f, 0.5f, 0.4f)));
    Material gauze = lambert(0.7f);
    gauze.alphaMode = AlphaMode::Blend, gauze.alpha = 0.5f;
    tiny.add(boxMesh(Vec3(0.8f, 0.8f, 0.02f)), gauze, translation(Vec3(-0.8f, 0.5f, 1)));
    if (ball >= 0) tiny.add(sphereMesh(0.4f, 24, 12), lambert(0.6f), translation(Vec3(0.5f, 0.4f, 0)) * scaling(Vec3(ball)));
    Light light;
    light.type = LightType::Sphere, light.radius = 0.25f, light.radiance = Vec3(lamp);
    tiny.addLight(light, translation(Vec3(0, 1.3f, -0.5f)));
    tiny.scene.environment.constant = Vec3(0.1f);
    return tiny.pose();
}

Camera view(float shift = 0) { return lookFrom(Vec3(shift, 1.2f, 3.5f), Vec3(0.6f * shift, 0.6f, 0)); }

/// Runs frames of sequences.
class Player {
public:
    explicit Player(Extent2 extent) : extent_(extent) {}

    RunResult run(Module& module, FrameNumber frame, const std::shared_ptr<const PosedScene>& posed, const Camera& camera, const Camera& before,
                  Changes changes, std::stop_token stop = {}) {
        tracer_.bind(posed);
        changes.cut |= frame == 0;
        const CameraPose pose = poseCamera(camera, extent_);
        FrameSampling sampling = frameOf(camera, extent_, 1, plainPaths(2), {});
        sampling.frame = static_cast<uint32_t>(frame);
        TapSet wanted;
        for (const Tap& tap : module.taps()) wanted.insert(tap.name);
        StageTimer timer;
        return module.run({frame, signals_, *posed, pose, changes.cut ? pose : poseCamera(before, extent_), changes, wanted, tracer_, sampling, timer, std::move(stop), {}},
                          image);
    }
    RunResult run(Module& module, FrameNumber frame, const Moment& now, const Moment& before, std::stop_token stop = {}) {
        auto& posed = scenes_[now.ball];
        if (!posed) posed = sceneOf(now.ball);
        return run(module, frame, posed, view(now.shift), view(before.shift), {.camera = now.shift != before.shift, .objects = now.ball != before.ball},
                   std::move(stop));
    }
    std::string digest(const Module& module) const { return digestOf(image, module); }

    Image image;

private:
    Extent2 extent_;
    Signals signals_;
    Tracer tracer_;
    std::map<float, std::shared_ptr<const PosedScene>> scenes_;
};

class OwnRays : public testing::TestWithParam<const char*> {
protected:
    static constexpr Extent2 kExtent{70, 45};
    /// Moving, still, shrunk to nothing, gone, back again.
    static std::vector<Moment> sequence() { return {{0, 1}, {0.05f, 1}, {0.12f, 1}, {0.12f, 1}, {0.12f, 0}, {0.2f, 0}, {0.2f, -1}, {0.2f, 1}, {0.25f, 1}}; }
    static std::unique_ptr<Module> make() {
        auto module = findModule(GetParam()).make();
        module->resize(kExtent);
        if (hasTemporal(*module)) setParameter([&](ParameterVisitor& v) { module->describe(v); }, "temporal", true);
        return module;
    }
    static bool hasTemporal(Module& module) {
        for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { module.describe(v); }))
            if (info.id == "temporal") return true;
        return false;
    }
};

TEST_P(OwnRays, MovingSequencesAreTheSameOnAnyNumberOfThreads) {
    std::vector<std::string> digests;
    for (const int threads : {1, 2, 8}) {
        setThreadCount(threads);
        Player player(kExtent);
        const auto module = make();
        std::string all;
        Moment before;
        for (size_t i = 0; i < sequence().size(); before = sequence()[i++]) {
            ASSERT_EQ(player.run(*module, static_cast<FrameNumber>(i), sequence()[i], before), RunResult::Completed);
            EXPECT_EQ(countNonFinite(player.image), 0);
            all += player.digest(*module) + '\n';
        }
        digests.push_back(all);
    }
    setThreadCount(0);
    EXPECT_EQ(digests[0], digests[1]);
    EXPECT_EQ(digests[0], digests[2]);
}

TEST_P(OwnRays, ARunStoppedAnywhereChangesNothing) {
    Player player(kExtent);
    const auto straight = make(), stopped = make();
    int stops = 0;
    Moment before;
    for (size_t i = 0; i < sequence().size(); before = sequence()[i++]) {
        const auto frame = static_cast<FrameNumber>(i);
        ASSERT_EQ(player.run(*straight, frame, sequence()[i], before), RunResult::Completed);
        const std::string expected = player.digest(*straight);
        // At any moment of the run, with another camera and without the ball.
        for (const int microseconds : {0, 300, 1000, 2500, 6000}) {
            std::stop_source source;
            std::jthread stopper([&] {
                std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
                source.request_stop();
            });
            if (player.run(*stopped, frame, {sequence()[i].shift + 0.3f, -1}, before, source.get_token()) == RunResult::Stopped) ++stops;
        }
        ASSERT_EQ(player.run(*stopped, frame, sequence()[i], before), RunResult::Completed);
        EXPECT_EQ(player.digest(*stopped), expected) << "frame " << i;
    }
    EXPECT_GT(stops, 0);
}

TEST_P(OwnRays, TheSameFrameAgainForgetsTheFirst) {
    Player player(kExtent);
    const auto straight = make(), replaced = make();
    Moment before;
    for (size_t i = 0; i < sequence().size(); before = sequence()[i++]) {
        const auto frame = static_cast<FrameNumber>(i);
        ASSERT_EQ(player.run(*straight, frame, sequence()[i], before), RunResult::Completed);
        const std::string expected = player.digest(*straight);
        ASSERT_EQ(player.run(*replaced, frame, {sequence()[i].shift - 0.2f, 0.5f}, before), RunResult::Completed);
        ASSERT_EQ(player.run(*replaced, frame, sequence()[i], before), RunResult::Completed);
        EXPECT_EQ(player.digest(*replaced), expected) << "frame " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, OwnRays, testing::Values("stable", "supersampling", "martin2002"), [](const auto& suite) { return std::string(suite.param); });

/// Lets every path go on from what its ray has met, but those of one slot in three.
class LenientJudge : public FirstHitJudge {
public:
    void nameRays(std::span<const PathStart> starts, std::span<uint32_t> ids) const override {
        for (size_t i = 0; i < starts.size(); ++i) ids[i] = firstRayId(starts[i].key, 0);
    }
    void judge(std::span<const PathStart> starts, std::span<Hit> hits, std::span<uint8_t> goesOn) override {
        for (size_t i = 0; i < starts.size(); ++i) {
            goesOn[i] = starts[i].slot % 3 != 0;
            met += hits[i].valid();
        }
    }
    int met = 0;
};

// A judge that changes nothing leaves paths as they are; those that it ends are black.
TEST(FirstHitJudge, ChangesOnlyWhatItDecides) {
    const Extent2 extent{40, 30};
    Tracer tracer;
    tracer.bind(sceneOf(1));
    std::vector<PathStart> starts;
    for (uint32_t p = 0; p < 1000; ++p) {
        starts.push_back(cameraStart(poseCamera(view(), extent), Vec2(p % 40, p / 40) + 0.3f, Vec2(0.5f), 0));
        starts.back().key = {p, 7, 3}, starts.back().slot = p;
    }
    std::vector<Vec3> plain(starts.size()), judged(starts.size(), Vec3(std::nanf("")));
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(2), 0, plain, {}));
    const uint64_t rays = tracer.counts().cameraRays;
    LenientJudge judge;
    PathObserver* const observers[] = {&judge};
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(2), 0, judged, observers));
    EXPECT_EQ(tracer.counts().cameraRays, 2 * rays);
    EXPECT_GT(judge.met, 500);
    for (uint32_t p = 0; p < 1000; ++p) EXPECT_EQ(judged[p], p % 3 != 0 ? plain[p] : Vec3(0)) << p;
}

/// Puts one hit in the place of all others.
class OneHitJudge : public FirstHitJudge {
public:
    explicit OneHitJudge(const Hit& hit) : hit_(hit) {}
    void nameRays(std::span<const PathStart>, std::span<uint32_t> ids) const override { std::fill(ids.begin(), ids.end(), 1u); }
    void judge(std::span<const PathStart>, std::span<Hit> hits, std::span<uint8_t>) override { std::fill(hits.begin(), hits.end(), hit_); }

private:
    Hit hit_;
};

// Paths go on from what the judge puts there, as if it was known before; of rays that do not fly none is counted.
TEST(FirstHitJudge, PathsGoOnFromWhatItPutsThere) {
    const Extent2 extent{40, 30};
    Tracer tracer;
    tracer.bind(sceneOf(1));
    const PathStart middle = cameraStart(poseCamera(view(), extent), Vec2(20, 20), Vec2(0.5f), 0);
    Hit hit;
    tracer.closestHits({&middle.ray, 1}, {&hit, 1});
    ASSERT_TRUE(hit.valid());
    std::vector<PathStart> starts(300, middle);
    for (uint32_t i = 0; i < starts.size(); ++i) {
        starts[i].key = {i, 2, 1}, starts[i].slot = i;
        if (i % 2 == 0) starts[i].ray.tmin = 1, starts[i].ray.tmax = 0;
    }
    std::vector<Vec3> judged(starts.size()), known(starts.size());
    OneHitJudge judge(hit);
    PathObserver* const observers[] = {&judge};
    tracer.resetCounts();
    ASSERT_TRUE(tracer.tracePaths(starts, plainPaths(2), 0, judged, observers));
    EXPECT_EQ(tracer.counts().cameraRays, starts.size() / 2);
    ASSERT_TRUE(tracer.continuePaths(starts, std::vector<Hit>(starts.size(), hit), plainPaths(2), 0, known, {}));
    EXPECT_EQ(judged, known);
    EXPECT_GT(std::count_if(judged.begin(), judged.end(), [](const Vec3& light) { return !isBlack(light); }), 100);
}

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

// All of a lamp's body is one primitive: what the camera passes on the way round must not stay visible from behind, black.
TEST(StablePromises, NoSampleOfALampIsBlack) {
    const Extent2 extent{64, 48};
    Player player(extent);
    StableModule module;
    module.resize(extent);
    const auto posed = sceneOf(1);
    const auto orbit = [](float turn) { return lookFrom(Vec3(1.5f * std::sin(turn), 1.3f, 1.5f * std::cos(turn) - 0.5f), Vec3(0, 1.3f, -0.5f)); };
    for (FrameNumber frame = 0; frame < 30; ++frame) {
        const float turn = 0.08f * static_cast<float>(frame);
        ASSERT_EQ(player.run(module, frame, posed, orbit(turn), orbit(turn - 0.08f), {.camera = true}), RunResult::Completed);
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

// That of scenes/text-plane.json comes nearer by half a percent a frame at most; at 3% samples spread faster than the default
// tolerance has them replaced, which costs 18% of the density.
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
                return lookFrom(Vec3(0, 1, 0) + Vec3(0, 0.6f, 3.5f) * std::pow(1 - step, static_cast<float>(frame)), Vec3(0, 0.4f, -1));
            };
            for (FrameNumber frame = 0; frame < 40; ++frame) {
                ASSERT_EQ(player.run(module, frame, posed, nearer(frame), nearer(frame - 1), {.camera = true}), RunResult::Completed);
                if (frame >= 10) {
                    ASSERT_NEAR(countVisible(module.samples()) / (96.0 * 64 * density), 1, step < 0.02f ? 0.15 : 0.2) << step << " frame " << frame;
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
                const auto nearer = [](FrameNumber f) { return lookFrom(Vec3(0.02f * static_cast<float>(f), 1.6f, 3.5f), Vec3(0, 0.6f, 0)); };
                ASSERT_EQ(player.run(module, frame, posed, nearer(frame), nearer(frame - 1), {.camera = true}), RunResult::Completed);
                all += player.digest(module) + '\n';
            }
            if (first.empty()) first = all;
            EXPECT_EQ(all, first) << batches;
        }
    }
    setThreadCount(0);
}

// All samples of a dense screen land in a few pixels as the camera jumps back: 16 at most stay in each, and the analysis thins
// them out at once.
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
    ASSERT_TRUE(reprojectSamples({1, signals, *posed, far, poseCamera(view(), extent), {.camera = true}, wanted, tracer, sampling, timer, {}, {}}, dense, piled));
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
        const auto [at, isNew] = stays.try_emplace({piled.rows[i], piled.targets[i] & ~ReprojectedSamples::kOccluded}, i);
        if (isNew || !isOccluded(at->second) || isOccluded(i)) continue;
        at->second = i;
        ++overtaken;
    }
    EXPECT_GT(overtaken, 0);
    std::vector<uint32_t> expected, found;
    for (const auto& [place, sample] : stays) expected.push_back(sample);
    for (size_t pixel = 0; pixel < piled.words.size(); ++pixel)
        for (int k = 0; k < std::popcount(subpixel::occupied(piled.words[pixel])); ++k) found.push_back(piled.sources[piled.first[pixel] + static_cast<uint32_t>(k)]);
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
        ASSERT_EQ(player.run(module, frame, posed, back, frame == 1 ? view() : back, {.camera = true}), RunResult::Completed);
    uint32_t crowd = 0;
    for (size_t p = 0; p < module.samples().words.size(); ++p) crowd = std::max(crowd, module.samples().first[p + 1] - module.samples().first[p]);
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
        ASSERT_EQ(player.run(module, frame, frame < 7 ? bright : dim, view(), view(), {.camera = true, .lights = frame == 7}), RunResult::Completed);
    for (FrameNumber frame = 8; frame < 12; ++frame)
        ASSERT_EQ(player.run(module, frame, dim, view(), view(), {}), RunResult::Completed);
    forVisible(module.samples(), [&](uint32_t i) {
        EXPECT_LT(maxComponent(module.samples().radiance(i)), 0.2f);  // the sky's 0.1 and its bounces
        EXPECT_LE(module.samples().notes[i].indirectCount, 4);
    });
}

}  // namespace
}  // namespace lumi::test

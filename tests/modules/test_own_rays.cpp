// What modules promise that place their own rays, where the catalogue's suite, which makes up signals, does not reach
// them.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "base/parallel.h"
#include "support/own_rays_player.h"
#include "trace/first_hit_judge.h"

namespace lumi::test {
namespace {

class OwnRays : public testing::TestWithParam<const char*> {
protected:
    static constexpr Extent2 kExtent{70, 45};
    /// Moving, still, shrunk to nothing, gone, back again.
    static std::vector<Moment> sequence() {
        return {{0, 1}, {0.05f, 1}, {0.12f, 1}, {0.12f, 1}, {0.12f, 0}, {0.2f, 0}, {0.2f, -1}, {0.2f, 1}, {0.25f, 1}};
    }
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
            // The first is stopped before it begins: on a busy machine no other thread may get its turn in time.
            if (microseconds == 0) source.request_stop();
            std::jthread stopper([&] {
                std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
                source.request_stop();
            });
            if (player.run(*stopped, frame, {sequence()[i].shift + 0.3f, -1}, before, source.get_token()) ==
                RunResult::Stopped)
                ++stops;
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

INSTANTIATE_TEST_SUITE_P(All, OwnRays, testing::Values("stable", "supersampling", "martin2002"),
                         [](const auto& suite) { return std::string(suite.param); });

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
    void nameRays(std::span<const PathStart>, std::span<uint32_t> ids) const override {
        std::fill(ids.begin(), ids.end(), 1u);
    }
    void judge(std::span<const PathStart>, std::span<Hit> hits, std::span<uint8_t>) override {
        std::fill(hits.begin(), hits.end(), hit_);
    }

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

}  // namespace
}  // namespace lumi::test

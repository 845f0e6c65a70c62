// Building a scene is stopped before it begins, within Embree's builds and between instances; what many instances take.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "support/expect_error.h"
#include "support/memory_limit.h"
#include "support/transport_scene.h"
#include "trace/embree_scene.h"

namespace lumi {
namespace {

using namespace test;

/// Three balls of 130,000 triangles: two of them one mesh.
std::shared_ptr<const PosedScene> manyTriangles() {
    TinyScene tiny;
    const auto ball = std::make_shared<const Mesh>(sphereMesh(1, 360, 180));
    const int grey = tiny.addMaterial(lambert(0.5f));
    tiny.add(ball, grey);
    tiny.add(ball, grey, translation(Vec3(3, 0, 0)));
    tiny.add(sphereMesh(1, 360, 181), lambert(0.5f), translation(Vec3(16, 0, 0)));
    return tiny.pose();
}

std::shared_ptr<const PosedScene> oneFloor() {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    return tiny.pose();
}

bool meets(Tracer& tracer, const Vec3& from, const Vec3& direction) {
    const Ray ray{from, 0, direction, kInfinity, 0};
    Hit hit;
    tracer.closestHits({&ray, 1}, {&hit, 1});
    return hit.valid();
}

/// Stops on the n-th call of the progress; returns how often it was called.
int bindUntil(EmbreeScene& embree, const PosedScene& posed, int last) {
    std::stop_source source;
    std::atomic<int> calls{0};
    expectError(ErrorKind::Interrupted,
                [&] {
                    embree.bind(posed, source.get_token(), [&](double) {
                        if (++calls >= last) source.request_stop();
                    });
                },
                {"interrupted"});
    return calls;
}

TEST(BindStop, EndsBuildsEarlyAndLeavesNothing) {
    const auto large = manyTriangles(), small = oneFloor();
    std::atomic<int> whole{0};
    std::atomic<double> furthest{0};
    size_t builtBytes = 0;
    {
        EmbreeScene embree;
        embree.bind(*large, {}, [&](double part) {
            ++whole;
            if (part > furthest) furthest = part;
        });
        builtBytes = embree.byteCount();
    }
    ASSERT_GT(whole, 8) << "Embree tells of its builds";
    EXPECT_GT(furthest, 0.5);
    EXPECT_LE(furthest, 1.0);

    EmbreeScene embree;
    bindUntil(embree, *large, 1);
    const size_t empty = embree.byteCount();
    EXPECT_LT(empty, builtBytes / 20);
    for (int round = 0; round < 6; ++round) {
        // Threads that were within a build at the time may look once more each.
        EXPECT_LT(bindUntil(embree, *large, 1 + round), whole / 2 + 1) << round;
        EXPECT_EQ(embree.byteCount(), empty) << "an empty scene, as often as it is stopped";
    }
    EXPECT_TRUE(embree.bind(*large));
    // Builds differ a little in how their threads cut memory into blocks.
    EXPECT_NEAR(double(embree.byteCount()), double(builtBytes), 0.2 * double(builtBytes));
    EXPECT_NEAR(embree.bounds().upper.x, 17, 1e-3f);
    EXPECT_TRUE(embree.bind(*small));
    EXPECT_FALSE(embree.bind(*small)) << "kept";
}

TEST(BindStop, BeforeItBeginsTheSceneStays) {
    Tracer tracer;
    tracer.bind(oneFloor());
    std::stop_source source;
    source.request_stop();
    expectError(ErrorKind::Interrupted, [&] { tracer.bind(manyTriangles(), source.get_token()); }, {"interrupted"});
    EXPECT_TRUE(meets(tracer, Vec3(-8, 1, 0), Vec3(0, -1, 0))) << "the floor";
    tracer.bind(manyTriangles());
    EXPECT_TRUE(meets(tracer, Vec3(16, 5, 0), Vec3(0, -1, 0)));
    EXPECT_FALSE(meets(tracer, Vec3(-8, 5, 0), Vec3(0, -1, 0)));
}

TEST(BindStop, WheneverItComesTheTracerGoesOn) {
    const auto large = manyTriangles();
    const Vec3 above(16, 5, 0), down(0, -1, 0);
    Tracer tracer;
    int stopped = 0;
    for (int round = 0; round < 12; ++round) {
        std::stop_source source;
        std::jthread later([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(2 * round));
            source.request_stop();
        });
        tracer.bind(oneFloor());
        bool bound = true;
        try {
            tracer.bind(large, source.get_token());
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
            bound = false, ++stopped;
        }
        later.join();
        EXPECT_EQ(meets(tracer, above, down), bound)
            << "the floor, an empty scene, or the balls, which alone are met here";
        tracer.bind(large);
        EXPECT_TRUE(meets(tracer, above, down));
    }
    EXPECT_GT(stopped, 0);
}

TEST(BindStop, PosesAreStoppedToo) {
    std::stop_source source;
    source.request_stop();
    const auto scene = manyTriangles()->scene;
    expectError(ErrorKind::Interrupted, [&] { poseScene(scene, {}, nullptr, source.get_token()); }, {"interrupted"});
    expectError(ErrorKind::Interrupted,
                [&] {
                    poseScene(scene, {1, 2, 1}, nullptr, source.get_token());
                },
                {"interrupted"});
}

TEST(ManyLights, CountAgainstTheMemoryLimit) {
    TinyScene tiny;
    Material glow = lambert(0.5f);
    glow.emission = Vec3(1);
    tiny.add(rectangleMesh(9, 9, Facing::Y, 700, 700), glow);
    const auto posed = tiny.pose();
    Tracer tracer;
    {
        const MemoryLimit limit(uint64_t(300) << 20);
        expectError(ErrorKind::Resources, [&] { tracer.bind(posed); }, {"980000 triangles that shine"});
    }
    EXPECT_FALSE(meets(tracer, Vec3(1, 5, 1), Vec3(0, -1, 0))) << "an empty scene";
    tracer.bind(posed);
    EXPECT_TRUE(meets(tracer, Vec3(1, 5, 1), Vec3(0, -1, 0)));
}

TEST(ManyInstances, TakeFewBytesEach) {
    constexpr int kCount = 40000;
    TinyScene tiny;
    const auto box = std::make_shared<const Mesh>(boxMesh(Vec3(1)));
    const int grey = tiny.addMaterial(lambert(0.5f));
    for (int i = 0; i < kCount; ++i) tiny.add(box, grey, translation(Vec3(float(i % 200) * 2, 0, float(i / 200) * 2)));
    const auto posed = tiny.pose();
    for (const PosedInstance& instance : posed->instances) ASSERT_EQ(instance.motion, nullptr);
    EXPECT_LE(posed->byteCount() / kCount, 100u);
    Tracer tracer;
    tracer.bind(posed);
    // Embree's own part is about two thirds of it; what shading reads is SceneTables' records.
    EXPECT_LE(tracer.byteCount() / kCount, 800u);
    EXPECT_TRUE(meets(tracer, Vec3(398, 5, 398), Vec3(0, -1, 0)));
    // One that moves has what the others have not.
    tiny.scene.nodes[7].matrix = translation(Vec3(0, 9, 0));
    const auto moved = poseScene(std::make_shared<const Scene>(tiny.scene), {0, 0, 0}, posed.get());
    EXPECT_FALSE(moved->instances[7].moves()) << "a cut";
    const auto later = poseScene(moved->scene, {1, 1, 0}, posed.get());
    EXPECT_TRUE(later->instances[7].moves());
    EXPECT_EQ(later->instances[7].worldFromObjectPrevious(), posed->instances[7].worldFromObject);
    EXPECT_EQ(later->instances[8].motion, nullptr);
}

}  // namespace
}  // namespace lumi

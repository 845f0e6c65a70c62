// The Tracer's other ways in: given rays, given points, hits, occlusion, observers.
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "base/error.h"
#include "base/memory.h"
#include "math/hash.h"
#include "math/warp.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

TinyScene litFloor() {
    TinyScene tiny;
    tiny.add(floorMesh(), lambert(0.5f));
    tiny.add(boxMesh(Vec3(1)), lambert(0.5f), translation(Vec3(2, 0.5f, 0)));
    Light lamp;
    lamp.type = LightType::Sphere;
    lamp.radius = 0.3f;
    lamp.radiance = Vec3(4);
    tiny.addLight(lamp, translation(Vec3(0, 2, 0)));
    return tiny;
}

TEST(Tracer, HitsAreNamedAndFoundAgain) {
    Tracer tracer;
    tracer.bind(litFloor().pose());
    const Ray rays[] = {{Vec3(0.3f, 1, 0.2f), 0, Vec3(0, -1, 0), kInfinity, 0},
                        {Vec3(2, 3, 0), 0, Vec3(0, -1, 0), kInfinity, 0},
                        {Vec3(0.1f, 1, 0), 0, Vec3(0, 1, 0), kInfinity, 0},
                        {Vec3(0, 1, 0), 0, glm::normalize(Vec3(-1, 0.1f, 0)), kInfinity, 0}};
    Hit hits[4];
    tracer.closestHits(rays, hits);
    EXPECT_EQ(hits[0].point.instance, 0u);
    EXPECT_NEAR(hits[0].distance, 1, 1e-5);
    EXPECT_LT(glm::distance(tracer.position(hits[0].point), Vec3(0.3f, 0, 0.2f)), 1e-5f);
    EXPECT_EQ(hits[1].point.instance, 1u);
    EXPECT_LT(glm::distance(tracer.normal(hits[1].point), Vec3(0, 1, 0)), 1e-5f);
    // The lamp's body is an exact sphere, named by where it was hit.
    EXPECT_EQ(hits[2].point.instance, 2u);
    EXPECT_NEAR(hits[2].distance, 1 - std::sqrt(0.09f - 0.01f), 1e-4);
    EXPECT_LT(glm::distance(tracer.position(hits[2].point), rays[2].origin + rays[2].direction * hits[2].distance),
              1e-4f);
    EXPECT_FALSE(hits[3].valid());
}

TEST(Tracer, OcclusionTellsTheNearestBlocker) {
    Tracer tracer;
    tracer.bind(litFloor().pose());
    const Ray rays[] = {{Vec3(2, 3, 0), 0, Vec3(0, -1, 0), 10, 0}, {Vec3(2, 3, 0), 0, Vec3(0, -1, 0), 1.5f, 0}};
    uint8_t blocked[2];
    SurfacePoint blockers[2];
    tracer.occluded(rays, blocked);
    EXPECT_EQ(blocked[0], 1);
    EXPECT_EQ(blocked[1], 0);
    tracer.occluded(rays, blocked, blockers);
    EXPECT_EQ(blocked[0], 1);
    EXPECT_EQ(blockers[0].instance, 1u);
    EXPECT_FALSE(blockers[1].valid());
}

TEST(Tracer, ShadingAPointIsTracingAPathToIt) {
    Tracer tracer;
    tracer.bind(litFloor().pose());
    const Vec3 eye(0.5f, 1, 0.7f), target(0.2f, 0, 0.1f);
    const Ray ray{eye, 0, glm::normalize(target - eye), kInfinity, 0};
    Hit hit;
    tracer.closestHits({&ray, 1}, {&hit, 1});
    const int count = 64;
    std::vector<SurfacePoint> points(count, hit.point);
    std::vector<Vec3> wo(count, -ray.direction), shaded(count), traced(count);
    std::vector<RandomKey> keys(count);
    std::vector<PathStart> starts(count);
    for (uint32_t i = 0; i < count; ++i) {
        keys[i] = {3, 4, i};
        starts[i].ray = ray, starts[i].key = keys[i], starts[i].slot = i;
    }
    points[5] = SurfacePoint();
    const PathSettings path = plainPaths(3);
    ASSERT_TRUE(tracer.shade(points, wo, keys, path, 9, shaded, {}));
    ASSERT_TRUE(tracer.tracePaths(starts, path, 9, traced, {}));
    EXPECT_EQ(shaded[5], Vec3(0));
    for (size_t i = 0; i < count; ++i) {
        if (i != 5) {
            EXPECT_LT(glm::distance(shaded[i], traced[i]), 1e-4f + 1e-3f * traced[i].y);
        }
    }
}

/// Adds up a path's radiance from its vertices, as the documentation of PathVertex says.
class Summing : public PathObserver {
public:
    explicit Summing(size_t slots) : sums(slots, Vec3(0)), totals(slots, Vec3(0)), depths(slots, 0), last(slots, -1) {}
    ObserverNeeds needs() const override {
        ObserverNeeds needs;
        needs.blocker = true;
        return needs;
    }
    void bounce(const BounceBatch& batch) override {
        for (size_t i = 0; i < batch.slots.size(); ++i) {
            const PathVertex& v = batch.vertices[i];
            const uint32_t slot = batch.slots[i];
            {
                std::lock_guard lock(mutex);
                Vec3& next = expected.try_emplace({slot, batch.samples[i]}, Vec3(1)).first->second;
                worst = std::max(worst, maxComponent(glm::abs(next - v.throughput)));
                next = v.throughput * v.weight;
                if (v.lightSampled && !v.lightVisible && v.blocker.valid()) ++blocked;
            }
            sums[slot] += v.throughput * (v.emitted + v.directDiffuse + v.directSpecular);
            depths[slot] = std::max(depths[slot], batch.depth + 1);
        }
    }
    void finished(std::span<const uint32_t> slots, std::span<const uint32_t> samples,
                  std::span<const Vec3> radiance) override {
        for (size_t i = 0; i < slots.size(); ++i) {
            inOrder &= static_cast<int64_t>(samples[i]) > last[slots[i]];
            last[slots[i]] = samples[i];
            totals[slots[i]] += radiance[i];
        }
    }
    std::vector<Vec3> sums, totals;
    std::vector<int> depths;
    std::vector<int64_t> last;
    std::map<std::pair<uint32_t, uint32_t>, Vec3> expected;  ///< throughput on arrival, by slot and sample
    std::mutex mutex;
    float worst = 0;
    int blocked = 0;
    bool inOrder = true;
};

TEST(Tracer, ObserversCanAddUpThePath) {
    Tracer tracer;
    tracer.bind(litFloor().pose());
    // Three samples a slot, adjacent; more than one batch, and slots across its border.
    std::vector<PathStart> starts;
    const CameraPose camera = poseCamera(lookFrom(Vec3(1, 2, 5), Vec3(0.5f, 0.5f, 0)), {20, 10});
    for (uint32_t slot = 0; slot < 200; ++slot)
        for (uint32_t s = 0; s < 3; ++s) {
            PathStart start = cameraStart(camera, Vec2(slot % 20 + 0.5f, slot / 20 + 0.5f), Vec2(0.5f), 0);
            start.key = {slot, 0, s};
            start.slot = slot;
            starts.push_back(start);
        }
    Summing observer(200);
    PathObserver* observers[] = {&observer};
    std::vector<Vec3> radiance(starts.size()), alone(starts.size());
    PathSettings path;
    path.maxDepth = 4;
    ASSERT_TRUE(tracer.tracePaths(starts, path, 1, radiance, observers));
    ASSERT_TRUE(tracer.tracePaths(starts, path, 1, alone, {}));
    EXPECT_TRUE(observer.inOrder);
    EXPECT_LT(observer.worst, 1e-6f);
    EXPECT_GT(observer.blocked, 0);
    for (size_t i = 0; i < starts.size(); ++i) EXPECT_EQ(radiance[i], alone[i]) << "watching changes nothing";
    for (size_t slot = 0; slot < 200; ++slot) {
        const Vec3 sum = radiance[3 * slot] + radiance[3 * slot + 1] + radiance[3 * slot + 2];
        EXPECT_LT(glm::distance(observer.sums[slot], sum), 1e-5f * (1 + sum.y));
        EXPECT_LT(glm::distance(observer.totals[slot], sum), 1e-6f * (1 + sum.y));
        EXPECT_LE(observer.depths[slot], 5);
    }
}

TEST(Tracer, CountsItsRays) {
    Tracer tracer;
    tracer.bind(litFloor().pose());
    Signals signals;
    ASSERT_TRUE(
        tracer.sample(frameOf(lookFrom(Vec3(0, 3, 5), Vec3(0)), {20, 10}, 2, plainPaths(2), {Signal::Noisy}), signals));
    const TraceCounts counts = tracer.counts();
    EXPECT_EQ(counts.cameraRays, 400u);
    EXPECT_GT(counts.bounceRays, 300u);
    EXPECT_GT(counts.shadowRays, 300u);
    EXPECT_EQ(counts.nonFinite, 0u);
    tracer.resetCounts();
    EXPECT_EQ(tracer.counts().total(), 0u);
    EXPECT_GT(tracer.byteCount(), 0u);
}

TEST(Tracer, BindsAgainAfterEdits) {
    TinyScene tiny = litFloor();
    const auto first = tiny.pose();
    Tracer tracer;
    tracer.bind(first);
    Signals before, after;
    const FrameSampling sampling =
        frameOf(lookFrom(Vec3(0, 3, 5), Vec3(0)), {16, 12}, 4, plainPaths(2), {Signal::Noisy});
    ASSERT_TRUE(tracer.sample(sampling, before));
    // Twice the lamp: twice the light, and back again the same bytes.
    TinyScene brighter = tiny;
    brighter.scene.lights[0].power = 2;
    tracer.bind(brighter.pose());
    ASSERT_TRUE(tracer.sample(sampling, after));
    for (size_t i = 0; i < after[Signal::Noisy].size(); ++i)
        EXPECT_NEAR(after[Signal::Noisy].data()[i], 2 * before[Signal::Noisy].data()[i],
                    1e-4f * (1 + after[Signal::Noisy].data()[i]));
    tracer.bind(tiny.pose());
    ASSERT_TRUE(tracer.sample(sampling, after));
    EXPECT_TRUE(before[Signal::Noisy] == after[Signal::Noisy]);
    // A moved box, a removed floor.
    tiny.scene.nodes[1].matrix = translation(Vec3(0, 0.5f, 0));
    tracer.bind(tiny.pose());
    const Ray down{Vec3(0, 1.5f, 0), 0, Vec3(0, -1, 0), kInfinity, 0};
    Hit hit;
    tracer.closestHits({&down, 1}, {&hit, 1});
    EXPECT_NEAR(hit.distance, 0.5f, 1e-5);
    tiny.scene.instances.erase(tiny.scene.instances.begin() + 1);
    tracer.bind(tiny.pose());
    tracer.closestHits({&down, 1}, {&hit, 1});
    EXPECT_NEAR(hit.distance, 1.5f, 1e-5);
}

TEST(Tracer, RefusesWhatPassesTheMemoryLimitAndGoesOn) {
    TinyScene tiny;
    tiny.add(sphereMesh(1, 512, 256), lambert(0.5f));
    const auto large = tiny.pose();
    Tracer tracer;
    tracer.bind(litFloor().pose());
    const uint64_t limit = memoryLimit();
    setMemoryLimit(residentBytes() + (1 << 20));
    EXPECT_THROW(tracer.bind(large), Error);
    setMemoryLimit(limit);
    const Ray down{Vec3(0.2f, 5, 0.1f), 0, Vec3(0, -1, 0), kInfinity, 0};
    Hit hit;
    tracer.closestHits({&down, 1}, {&hit, 1});
    EXPECT_FALSE(hit.valid());
    tracer.bind(large);
    tracer.closestHits({&down, 1}, {&hit, 1});
    EXPECT_NEAR(hit.distance, 4, 0.1);
}

TEST(CameraRays, GoWhereTheCameraProjects) {
    for (const auto projection : {Projection::Perspective, Projection::Orthographic}) {
        Camera camera = lookFrom(Vec3(1, 2, 5), Vec3(0.2f, 0.4f, 0));
        camera.projection = projection;
        camera.yMag = 2;
        for (const float aperture : {0.0f, 0.1f}) {
            camera.aperture = aperture;
            camera.focus = 4;
            const CameraPose pose = poseCamera(camera, {64, 48});
            for (const Vec2 pixel : {Vec2(0.5f, 0.5f), Vec2(31.7f, 20.1f), Vec2(63, 47)}) {
                const PathStart start = cameraStart(pose, pixel, Vec2(0.3f, 0.8f), 0);
                // On the plane in focus every lens point sees the pixel's point.
                const float cosine = glm::dot(start.ray.direction, pose.forward());
                const Vec3 projected = pose.project(start.ray.origin + start.ray.direction * (4 / cosine));
                EXPECT_NEAR(projected.x, pixel.x, 1e-3);
                EXPECT_NEAR(projected.y, pixel.y, 1e-3);
                EXPECT_NEAR(projected.z, 4, 1e-4);
                EXPECT_NEAR(glm::length(start.ray.direction), 1, 1e-6);
            }
        }
    }
}

TEST(CameraRays, FrameJitterIsCentredAndLoops) {
    for (const uint32_t seed : {0u, 1u, 2u, 77u}) {
        Vec2 sum(0);
        for (uint64_t i = 0; i < 16; ++i) {
            const Vec2 j = frameJitter(i, seed);
            EXPECT_LE(std::abs(j.x), 0.5f);
            EXPECT_LE(std::abs(j.y), 0.5f);
            EXPECT_EQ(j, frameJitter(i + 16, seed));
            sum += j;
        }
        EXPECT_LT(std::abs(sum.x) / 16, 0.05f) << seed;
        EXPECT_LT(std::abs(sum.y) / 16, 0.05f) << seed;
    }
}

TEST(CameraRays, SeedsReplicateTheFrameJitter) {
    // The same frame of a thousand seeds: its offset is uniform, so that a mean over seeds has none.
    Vec2 sum(0), squares(0);
    for (uint32_t seed = 1; seed <= 1000; ++seed) {
        const Vec2 j = frameJitter(3, seed);
        sum += j, squares += j * j;
    }
    EXPECT_EQ(frameJitter(0, 0), Vec2(0, 1.0f / 3 - 0.5f));
    for (int c = 0; c < 2; ++c) {
        EXPECT_LT(std::abs(sum[c]) / 1000, 4 * std::sqrt(1 / 12.0f / 1000));
        EXPECT_NEAR(squares[c] / 1000, 1 / 12.0f, 0.01f);
    }
}

TEST(PathSettings, DescribesEveryMember) {
    PathSettings settings;
    const auto describe = [&](ParameterVisitor& v) { settings.describe(v); };
    const auto list = listParameters(describe);
    EXPECT_EQ(list.size(), 16u);
    setParameter(describe, "path.strategy", std::string("bsdf"));
    setParameter(describe, "path.max-depth", 3);
    setParameter(describe, "sampler.kind", std::string("halton"));
    EXPECT_EQ(settings.strategy, DirectStrategy::Bsdf);
    EXPECT_EQ(settings.maxDepth, 3);
    EXPECT_EQ(settings.sampler, SamplerKind::Halton);
    for (const ParameterInfo& info : list) EXPECT_EQ(info.redo, Redo::Samples) << info.id;
}

// Plain surfaces are shaded many at a time, varnished ones one by one, and diffuse ones alone by kernels of their own.
TEST(Tracer, AlbedoIsTheSurfacesWhateverItsPathsMayDo) {
    Material varnished = metal(0.6f, 0.3f);
    varnished.metallic = 0.3f;
    const Material plain = varnished;
    varnished.clearcoat = 1e-5f;
    for (const Material& material : {plain, varnished, lambert(0.6f)}) {
        TinyScene tiny;
        tiny.scene.environment.constant = Vec3(1);
        tiny.add(floorMesh(), material);
        Tracer tracer;
        tracer.bind(tiny.pose());
        const auto albedos = [&](int mostDiffuse, int mostSpecular) {
            PathSettings path = plainPaths(4);
            path.maxDiffuseDepth = mostDiffuse, path.maxSpecularDepth = mostSpecular;
            Signals signals;
            EXPECT_TRUE(tracer.sample(
                frameOf(lookFrom(Vec3(0, 2, 2), Vec3(0)), {8, 8}, 1, path, {Signal::Albedo, Signal::SpecularAlbedo}),
                signals));
            return std::pair(signals[Signal::Albedo].at(0, 4, 4), signals[Signal::SpecularAlbedo].at(0, 4, 4));
        };
        const auto whole = albedos(64, 64);
        EXPECT_GT(whole.first, 0.3f);
        for (const auto& [diffuse, specular] : {std::pair(0, 64), std::pair(64, 0), std::pair(0, 0)})
            EXPECT_EQ(albedos(diffuse, specular), whole) << diffuse << ' ' << specular << ' ' << material.clearcoat;
    }
}

TEST(Tracer, UnlitSurfacesShowTheirColourTimesThatOfTheirVertices) {
    Mesh sheet = rectangleMesh(2, 2, Facing::Z);
    for (const Vec3& p : sheet.positions) sheet.colours.emplace_back(p.x > 0 ? 1.0f : 0.0f, 0.5f, 2.0f, 1.0f);
    for (const bool unlit : {true, false}) {
        TinyScene tiny;
        Material material = lambert(0);
        material.emission = Vec3(0.2f, 0.4f, 0.6f);
        material.unlit = unlit;
        tiny.add(sheet, material);
        Tracer tracer;
        tracer.bind(tiny.pose());
        PathStart start;
        start.ray.origin = Vec3(0.5f, 0.1f, 3);
        start.ray.direction = Vec3(0, 0, -1);
        Vec3 radiance;
        tracer.tracePaths({&start, 1}, plainPaths(1), 0, {&radiance, 1}, {});
        const Vec3 expected = material.emission * (unlit ? Vec3(0.75f, 0.5f, 2) : Vec3(1));
        EXPECT_LT(glm::distance(radiance, expected), 1e-5f) << unlit;
    }
}

}  // namespace
}  // namespace lumi

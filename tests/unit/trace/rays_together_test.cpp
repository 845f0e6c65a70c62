// Rays go to Embree in packets and streams by the size of the scene: each finds what it finds alone.
#include <gtest/gtest.h>

#include "math/hash.h"
#include "math/warp.h"
#include "support/transport_scene.h"

namespace lumi {
namespace {

using namespace test;

float number(uint32_t a, uint32_t b) { return unitFloat(hashCombine(a, b)); }

/// Triangles here and there in a cube.
Mesh soup(uint32_t count, float size, uint32_t seed) {
    Mesh mesh;
    for (uint32_t i = 0; i < count; ++i) {
        const auto place = [&](uint32_t k) {
            const uint32_t at = 16 * i + 4 * k;
            return Vec3(number(seed, at), number(seed, at + 1), number(seed, at + 2));
        };
        const Vec3 corner = place(0) * 4.0f - Vec3(2);
        for (uint32_t k = 1; k <= 3; ++k) mesh.positions.push_back(corner + place(k) * size);
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh;
}

/// What stands still; instances of one mesh, one of them mirrored; one that moves while the shutter is open; gauze that
/// half of the rays pass; sheets without backs; a lamp.
TinyScene crowd(uint32_t triangles) {
    TinyScene tiny;
    const float size = triangles < 1000 ? 0.7f : 0.15f;
    Material oneSided = lambert(0.5f), gauze = lambert(0.5f);
    oneSided.doubleSided = false;
    gauze.alphaMode = AlphaMode::Blend, gauze.alpha = 0.5f;
    tiny.add(soup(triangles, size, 1), lambert(0.5f));
    const auto shared = std::make_shared<const Mesh>(soup(triangles / 2, size, 2));
    const int both = tiny.addMaterial(lambert(0.5f)), front = tiny.addMaterial(oneSided);
    tiny.add(shared, both, translation(Vec3(0.3f, 0, 0)));
    tiny.add(shared, front, translation(Vec3(0, 0.2f, 0)) * scaling(Vec3(-0.8f, 1, 1.1f)));
    tiny.add(soup(triangles / 4, size, 3), gauze);
    const int moving = tiny.add(soup(triangles / 4, size, 4), lambert(0.5f));
    const int node = tiny.scene.instances[static_cast<size_t>(moving)].node;
    tiny.scene.nodes[static_cast<size_t>(node)].hasMatrix = false;
    Animation animation;
    animation.duration = 1, animation.loop = false;
    AnimationChannel channel;
    channel.node = node, channel.property = AnimatedProperty::Translation, channel.components = 3;
    channel.times = {0, 1}, channel.values = {0, 0, 0, 1.5f, 0.5f, 0};
    animation.channels.push_back(channel);
    tiny.scene.animations.push_back(animation);
    Light lamp;
    lamp.type = LightType::Sphere, lamp.radius = 0.5f;
    tiny.addLight(lamp, translation(Vec3(0.5f, 0.5f, 0.5f)));
    return tiny;
}

struct Rays {
    std::vector<Ray> rays;
    std::vector<uint32_t> ids;
};

/// From anywhere to anywhere at any time of the shutter; a third of them short, every other one as of a camera.
Rays anywhere(uint32_t count) {
    Rays all;
    for (uint32_t i = 0; i < count; ++i) {
        Ray ray;
        ray.origin = Vec3(number(i, 0), number(i, 1), number(i, 2)) * 5.0f - Vec3(2.5f);
        ray.direction = sampleSphere({number(i, 3), number(i, 4)});
        if (i % 3 == 0) ray.tmax = number(i, 5);
        ray.time = number(i, 6);
        ray.fromCamera = i % 2 == 0;
        all.rays.push_back(ray);
        all.ids.push_back(pcgHash(i));
    }
    return all;
}

}  // namespace

class RaysTogether : public testing::TestWithParam<uint32_t> {};

TEST_P(RaysTogether, FindWhatTheyFindAlone) {
    TinyScene tiny = crowd(GetParam());
    Tracer tracer;
    tracer.bind(tiny.pose({0, 1, 0}));
    const uint32_t count = 3001;
    const Rays all = anywhere(count);
    std::vector<Hit> stray(count), coherent(count);
    tracer.closestHits(all.rays, stray, {}, false, all.ids);
    tracer.closestHits(all.rays, coherent, {}, true, all.ids);
    std::vector<size_t> met(tiny.scene.instances.size() + 1, 0);
    for (size_t i = 0; i < count; ++i) {
        Hit alone;
        tracer.closestHits({&all.rays[i], 1}, {&alone, 1}, {}, false, {&all.ids[i], 1});
        ++met[alone.valid() ? alone.point.instance : tiny.scene.instances.size()];
        for (const Hit& hit : {stray[i], coherent[i]}) {
            ASSERT_EQ(hit.point.instance, alone.point.instance) << i;
            if (!alone.valid()) continue;
            EXPECT_EQ(hit.point.primitive, alone.point.primitive) << i;
            EXPECT_NEAR(hit.distance, alone.distance, 1e-5f * alone.distance) << i;
        }
    }
    for (const size_t often : met) EXPECT_GT(often, count / 200);
}

/// Any hit is a hit: shadow rays of opaque scenes are blocked where the nearest hit is.
TEST_P(RaysTogether, AreBlockedByWhatTheyFind) {
    TinyScene tiny = crowd(GetParam());
    for (Material& material : tiny.scene.materials) material.alphaMode = AlphaMode::Opaque;
    Tracer tracer;
    tracer.bind(tiny.pose({0, 1, 0}));
    const uint32_t count = 3001;
    const Rays all = anywhere(count);
    std::vector<Hit> hits(count);
    std::vector<uint8_t> blocked(count);
    tracer.closestHits(all.rays, hits);
    tracer.occluded(all.rays, blocked);
    size_t passed = 0;
    for (size_t i = 0; i < count; ++i) {
        EXPECT_EQ(blocked[i], hits[i].valid()) << i;
        uint8_t alone = 2;
        tracer.occluded({&all.rays[i], 1}, {&alone, 1});
        EXPECT_EQ(alone, blocked[i]) << i;
        passed += blocked[i] ? 0 : 1;
    }
    EXPECT_GT(passed, count / 50);
    EXPECT_LT(passed, count * 9 / 10);
}

/// In small scenes rays go in packets that are sorted, in large ones one by one or all together.
INSTANTIATE_TEST_SUITE_P(Triangles, RaysTogether, testing::Values(200u, 8000u));

}  // namespace lumi

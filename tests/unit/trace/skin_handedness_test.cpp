// What a skin's joints mirror is what a node that mirrors would make of it: fronts, emission, glass, normal maps.
#include <gtest/gtest.h>

#include <array>

#include "support/texel_picture.h"
#include "support/transport_scene.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

using namespace test;

/// Hangs a mesh on one joint.
Mesh onOneJoint(Mesh mesh) {
    const size_t count = mesh.positions.size();
    mesh.skin.first.clear();
    for (uint32_t v = 0; v <= count; ++v) mesh.skin.first.push_back(v);
    mesh.skin.joint.assign(count, 0), mesh.skin.weight.assign(count, 1);
    return mesh;
}

/// Returns the joint's node. What is skinned ignores its own.
int addSkinned(TinyScene& tiny, Mesh mesh, const Material& material, const Mat4& joint) {
    const int instance = tiny.add(onOneJoint(std::move(mesh)), material, translation(Vec3(50, 0, 0)));
    const int node = tiny.addNode(joint);
    tiny.scene.instances[static_cast<size_t>(instance)].skin = static_cast<int>(tiny.scene.skins.size());
    tiny.scene.skins.push_back({{node}, {Mat4(1)}});
    return node;
}

Material singleSided(const Material& from) {
    Material m = from;
    m.doubleSided = false;
    return m;
}

Hit hitAlong(Tracer& tracer, const Ray& ray) {
    Hit hit;
    tracer.closestHits({&ray, 1}, {&hit, 1});
    return hit;
}

const Mat4 kMirrors[] = {scaling(Vec3(-1, 1, 1)), scaling(Vec3(1, -1, 1)), scaling(Vec3(-1)), scaling(Vec3(-1, -1, 1)),
                         Mat4(1)};

TEST(SkinHandedness, TheCameraMeetsTheFrontOfAMirroredCube) {
    for (const Mat4& mirror : kMirrors) {
        TinyScene tiny;
        addSkinned(tiny, boxMesh(Vec3(1)), singleSided(lambert(1)), mirror);
        tiny.scene.environment.constant = Vec3(1);
        Tracer tracer;
        tracer.bind(tiny.pose());
        const Hit hit = hitAlong(tracer, {Vec3(0.1f, 0.2f, 5), 0, Vec3(0, 0, -1), kInfinity, 0, true});
        ASSERT_TRUE(hit.valid());
        EXPECT_NEAR(hit.distance, 4.5f, 1e-5f);
        EXPECT_LT(glm::distance(tracer.normal(hit.point), Vec3(0, 0, 1)), 1e-5f);
        // Furnace: a convex white body under a white sky.
        const FrameSampling frame = frameOf(lookFrom(Vec3(0, 0, 5), Vec3(0), 5), {8, 8}, 16,
                                            plainPaths(2, DirectStrategy::Bsdf), {Signal::Noisy, Signal::Depth});
        Signals signals;
        ASSERT_TRUE(tracer.sample(frame, signals));
        EXPECT_NEAR(signals[Signal::Depth].at(0, 4, 4), 4.5f, 0.01f);
        EXPECT_NEAR(signals[Signal::Noisy].at(1, 4, 4), 1, 1e-3f);
    }
}

/// Radiance downwards on a floor of emission 2 at its front, and upwards.
std::array<double, 2> shineOf(TinyScene& tiny) {
    Tracer tracer;
    tracer.bind(tiny.pose());
    return {radianceAlong(tracer, Vec3(0.1f, 1, 0.2f), Vec3(0, -1, 0), 1, plainPaths(1)).mean,
            radianceAlong(tracer, Vec3(0.1f, -1, 0.2f), Vec3(0, 1, 0), 1, plainPaths(1)).mean};
}

TEST(SkinHandedness, EmissiveFacesShineFromTheirFront) {
    Material glow = singleSided(lambert(0));
    glow.emission = Vec3(2);
    for (const Mat4& mirror : kMirrors) {
        TinyScene skinned, placed;
        addSkinned(skinned, floorMesh(1), glow, mirror);
        placed.add(floorMesh(1), glow, mirror);
        const bool faceDown = mirror[1].y < 0;
        const std::array<double, 2> expected{faceDown ? 0.0 : 2.0, faceDown ? 2.0 : 0.0};
        EXPECT_EQ(shineOf(placed), expected);
        EXPECT_EQ(shineOf(skinned), expected);
    }
}

// By samples of the light alone: what they think of its front.
TEST(SkinHandedness, LightSamplesKnowTheFront) {
    Material glow = singleSided(lambert(0));
    glow.emission = Vec3(2);
    const auto litBelow = [&](bool isSkinned, const Mat4& joint) {
        TinyScene tiny;
        tiny.add(floorMesh(4), lambert(1));
        if (isSkinned) addSkinned(tiny, floorMesh(1), glow, joint);
        else tiny.add(floorMesh(1), glow, joint);
        Tracer tracer;
        tracer.bind(tiny.pose());
        return radianceAlong(tracer, Vec3(1.5f, 0.5f, 0), Vec3(-0.5f, -0.5f, 0), 512,
                             plainPaths(1, DirectStrategy::Light))
            .mean;
    };
    const Mat4 above = translation(Vec3(0, 1, 0));
    for (const Mat4& mirror : kMirrors) {
        const double placed = litBelow(false, above * mirror), skinned = litBelow(true, above * mirror);
        EXPECT_EQ(placed > 0, mirror[1].y < 0);
        EXPECT_NEAR(skinned, placed, 1e-3 * placed);
    }
}

TEST(SkinHandedness, LightGoesIntoMirroredGlassAndOut) {
    // Straight through a slab with reflections back and forth: R + (1-R)^2 A / (1 - R A), sky 1 on all sides.
    Material slab;
    slab.roughness = 0, slab.ior = 1.5f, slab.transmission = 1, slab.thickness = 1;
    slab.attenuationColor = Vec3(0.25f), slab.attenuationDistance = 0.5f;
    const double r = 0.04, a = std::pow(0.25, 2.0);
    const double expected = r + (1 - r) * (1 - r) * a / (1 - r * a);
    for (const Mat4& mirror : kMirrors) {
        TinyScene tiny;
        addSkinned(tiny, boxMesh(Vec3(4, 1, 4)), slab, mirror);
        tiny.scene.environment.constant = Vec3(1);
        Tracer tracer;
        tracer.bind(tiny.pose());
        const Estimate e = radianceAlong(tracer, Vec3(0.2f, 3, 0.1f), Vec3(0, -1, 0), 20000, plainPaths(32));
        EXPECT_NEAR(e.mean, expected, 4.5 * e.standardError + 1e-3 * expected);
    }
}

/// Of a normal map of one texel. It leans so little that the camera, which looks straight on, sees it unbent.
const Vec3 kCodes(165, 150, 240);

/// That map as kernels shade by it, or as only the general way does.
Texture levelMap(bool forKernels) {
    if (!forKernels) return texelPicture({1, 1}, {kCodes / 255.0f});
    auto image = std::make_shared<TextureImage>();
    image->levels.push_back({{1, 1}, {165, 150, 240, 255}, {}});
    Texture texture;
    texture.image = image;
    return texture;
}

/// A square that faces +Z, tangents along `angle`, of that handedness.
Mesh tangentSquare(float angle, float hand) {
    Mesh mesh = rectangleMesh(1, 1, Facing::Z);
    mesh.tangents.assign(mesh.positions.size(), Vec4(std::cos(angle), std::sin(angle), 0, hand));
    return mesh;
}

/// Shading normal of the only instance where `m` takes the point (0.1, 0.2) of a square, seen from its front.
Vec3 shownNormal(TinyScene& tiny, const Mat4& m) {
    const Vec3 there = transformPoint(m, Vec3(0.1f, 0.2f, 0)), front = glm::normalize(normalMatrix(m) * Vec3(0, 0, 1));
    Camera camera = lookFrom(there + 3.0f * front, there, 1);
    Tracer tracer;
    tracer.bind(tiny.pose());
    Signals signals;
    EXPECT_TRUE(tracer.sample(frameOf(camera, {1, 1}, 1, plainPaths(1), {Signal::Normal}), signals));
    const Image& normal = signals[Signal::Normal];
    return {normal.at(0, 0, 0), normal.at(1, 0, 0), normal.at(2, 0, 0)};
}

TEST(SkinHandedness, NormalMapsLeanAsOnANode) {
    const Mat4 turn = glm::mat4_cast(glm::angleAxis(0.7f, glm::normalize(Vec3(1, 2, 0.5f))));
    const Mat4 places[] = {turn, turn * scaling(Vec3(-1, 1, 1)), turn * scaling(Vec3(0.5f, 1.8f, 1.2f)),
                           turn * scaling(Vec3(0.5f, 1.8f, 1.2f)) * turn,
                           scaling(Vec3(1.3f, -0.6f, 0.8f)) * turn * scaling(Vec3(1.6f, 0.7f, 1))};
    for (const bool forKernels : {true, false})
        for (const bool doubleSided : {true, false})
            for (const float hand : {1.0f, -1.0f})
                for (const Mat4& m : places) {
                    Material material = lambert(0.5f);
                    material.doubleSided = doubleSided;
                    material.normalTexture = levelMap(forKernels);
                    TinyScene skinned, placed;
                    addSkinned(skinned, tangentSquare(1, hand), material, m);
                    placed.add(tangentSquare(1, hand), material, m);
                    // By hand: unit tangent and bitangent as `m` takes them, and its normal.
                    const Vec3 t(std::cos(1.0f), std::sin(1.0f), 0);
                    const Vec3 texel = kCodes * (2 / 255.0f) - Vec3(1);
                    const Vec3 bitangent = hand * glm::cross(Vec3(0, 0, 1), t);
                    const Vec3 expected = glm::normalize(glm::normalize(Mat3(m) * t) * texel.x +
                                                         glm::normalize(Mat3(m) * bitangent) * texel.y +
                                                         glm::normalize(normalMatrix(m) * Vec3(0, 0, 1)) * texel.z);
                    EXPECT_LT(glm::distance(shownNormal(placed, m), expected), 5e-4f) << forKernels << hand;
                    EXPECT_LT(glm::distance(shownNormal(skinned, m), expected), 5e-4f) << forKernels << hand;
                }
}

/// A floor on a joint whose scale goes from 1 to `last` in a second, evenly.
TinyScene floorThroughZero(const Vec3& last) {
    TinyScene tiny;
    Mesh floor = floorMesh(1);
    floor.normals.clear();
    const int joint = addSkinned(tiny, floor, singleSided(lambert(0.5f)), Mat4(1));
    tiny.scene.nodes[static_cast<size_t>(joint)].hasMatrix = false;
    AnimationChannel scale;
    scale.node = joint, scale.property = AnimatedProperty::Scale;
    scale.times = {0, 1};
    scale.values = {1, 1, 1, last.x, last.y, last.z};
    tiny.scene.animations.push_back({{scale}, 1, false});
    return tiny;
}

/// Does the camera see the floor's front from above, and nothing from below?
void expectFaceUp(Tracer& tracer, float time) {
    const Hit above = hitAlong(tracer, {Vec3(0.01f, 9, 0.02f), 0, Vec3(0, -1, 0), kInfinity, time, true});
    const Hit below = hitAlong(tracer, {Vec3(0.01f, -9, 0.02f), 0, Vec3(0, 1, 0), kInfinity, time, true});
    ASSERT_TRUE(above.valid()) << time;
    EXPECT_GT(tracer.normal(above.point).y, 0.99f) << time;
    EXPECT_FALSE(below.valid()) << time;
}

// Scaled along x alone it keeps its face up: to -3 the joint begins to mirror at a quarter of the time.
TEST(SkinHandedness, AScaleGoesThroughZeroWhileTheShutterIsOpen) {
    TinyScene tiny = floorThroughZero(Vec3(-3, 1, 1));
    Tracer tracer;
    tracer.bind(tiny.pose({0, 1, 0}));
    for (const float time : {0.0f, 0.1f, 0.2f, 0.3f, 0.45f, 0.6f, 1.0f}) expectFaceUp(tracer, time);
}

TEST(SkinHandedness, AScaleGoesThroughZeroBetweenFrames) {
    TinyScene tiny = floorThroughZero(Vec3(-3, 1, 1));
    const auto scene = tiny.pose()->scene;
    Tracer tracer;
    std::shared_ptr<const PosedScene> before;
    for (const float time : {0.0f, 0.2f, 0.3f, 0.9f, 0.1f, 0.6f}) {
        before = poseScene(scene, {time, time, before ? before->time : time}, before.get());
        tracer.bind(before);
        expectFaceUp(tracer, 0);
    }
}

}  // namespace
}  // namespace lumi

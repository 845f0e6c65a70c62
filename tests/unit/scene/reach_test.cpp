// Whatever carries things out of reach, at loading or in some frame, is an Error that names them; never a frame.
#include "scene/reach.h"

#include <gtest/gtest.h>

#include <functional>

#include "scene/posed_scene.h"
#include "support/expect_error.h"

namespace lumi {
namespace {
using test::expectError;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

std::shared_ptr<Mesh> triangle() {
    auto mesh = std::make_shared<Mesh>();
    mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh->triangles = {{0, 1, 2}};
    return mesh;
}

/// One triangle at one node.
Scene oneThing() {
    Scene scene;
    scene.path = "far.gltf";
    scene.nodes.resize(1);
    scene.materials.resize(1);
    Instance instance;
    instance.name = "thing";
    instance.mesh = triangle();
    instance.node = 0;
    scene.instances = {instance};
    return scene;
}

void expectRefused(const std::function<void(Scene&)>& edit, const std::string& found, ShutterTimes times = {}) {
    Scene scene = oneThing();
    poseScene(std::make_shared<const Scene>(scene), times);
    edit(scene);
    expectError(ErrorKind::BadInput, [&] { poseScene(std::make_shared<const Scene>(scene), times); },
                {"far.gltf", "\"thing\"", "too far or too large", "-1e+09 to 1e+09", "found " + found});
}

AnimationChannel scalingTo(float scale) {
    AnimationChannel channel;
    channel.node = 0;
    channel.property = AnimatedProperty::Scale;
    channel.times = {0, 1};
    channel.values = {1, 1, 1, scale, scale, scale};
    return channel;
}

TEST(Reach, EndsAtABillion) {
    EXPECT_TRUE(isInReach(Vec3(1e9f, -1e9f, 0)));
    EXPECT_FALSE(isInReach(Vec3(0, 1.001e9f, 0)));
    EXPECT_FALSE(isInReach(kNan));
    EXPECT_FALSE(isInReach(-kInfinity));
    Mat4 far(1);
    far[3].y = -2e9f;
    EXPECT_TRUE(isInReach(Mat4(1)));
    EXPECT_FALSE(isInReach(far));
    const std::vector<Vec3> points{Vec3(1), Vec3(0, kNan, 0), Vec3(1e30f)};
    EXPECT_EQ(firstOutOfReach(points), 1u);
    EXPECT_EQ(firstOutOfReach({points.data(), 1}), 1u);
    EXPECT_EQ(outOfReachText(points[1]), "nan");
}

TEST(Reach, MeshesOutsideAreRefused) {
    const std::shared_ptr<Mesh> mesh = triangle();
    checkMesh(*mesh, "m");
    for (const auto& [bad, found] : {std::pair(1e19f, "1e+19"), {kNan, "nan"}, {-kInfinity, "-inf"}}) {
        mesh->positions[1].z = bad;
        expectError(ErrorKind::BadInput, [&] { checkMesh(*mesh, "m"); }, {"m:", "vertex 1", "-1e+09 to 1e+09", found});
    }
}

TEST(Reach, PlacesAndScalesOutsideAreRefused) {
    expectRefused([](Scene& s) { s.nodes[0].local.translation.x = 3e9f; }, "3e+09");
    expectRefused([](Scene& s) { s.nodes[0].local.scale = Vec3(1e20f); }, "1e+20");
    expectRefused([](Scene& s) { s.nodes[0].local.scale = Vec3(kInfinity); }, "");
    // Each of the two in reach, both together not.
    expectRefused(
        [](Scene& s) {
            auto large = triangle();
            for (Vec3& p : large->positions) p *= 1e6f;
            s.instances[0].mesh = large;
            s.nodes[0].local.scale = Vec3(1e6f);
        },
        "1e+12");
}

TEST(Reach, AnimationIsFollowedFrameByFrame) {
    const auto grow = [](Scene& s) { s.animations = {{{scalingTo(1e20f)}, 1, false}}; };
    Scene scene = oneThing();
    grow(scene);
    const auto shared = std::make_shared<const Scene>(scene);
    EXPECT_NO_THROW(poseScene(shared, {}));
    EXPECT_NO_THROW(poseScene(shared, {0, 0, 0.5f})) << "what has left is no frame";
    expectRefused(grow, "5e+19", {0.5f, 0.5f, 0.5f});
    expectRefused(grow, "5e+19", {0, 0.5f, 0});  // while the shutter is open
}

TEST(Reach, SkinsAndMorphsAreFollowedVertexByVertex) {
    const auto skinned = [](float scale) {
        return [scale](Scene& s) {
            auto mesh = triangle();
            mesh->skin.first = {0, 1, 2, 3};
            mesh->skin.joint = {0, 0, 0};
            mesh->skin.weight = {1, 1, 1};
            Mat4 bind(scale);
            bind[3].w = 1;
            s.skins = {{{0}, {bind}}};
            s.instances[0].mesh = mesh, s.instances[0].skin = 0;
        };
    };
    expectRefused(skinned(1e19f), "1e+19");
    expectRefused(skinned(kNan), "nan");
    const auto morphed = [](float delta) {
        return [delta](Scene& s) {
            auto mesh = triangle();
            mesh->morphTargets.resize(1);
            mesh->morphTargets[0].positions = {Vec3(0), Vec3(0, delta, 0), Vec3(0)};
            s.instances[0].mesh = mesh;
            s.nodes[0].morphWeights = {10};
        };
    };
    expectRefused(morphed(3e38f), "inf");
    expectRefused(morphed(5e8f), "5e+09");
}

TEST(Reach, NormalsOfHugeJointsStayUnit) {
    Scene scene = oneThing();
    auto mesh = triangle();
    mesh->positions.assign(3, Vec3(0));
    mesh->normals.assign(3, Vec3(0, 0, 1));
    mesh->skin.first = {0, 1, 2, 3};
    mesh->skin.joint = {0, 0, 0};
    mesh->skin.weight = {1, 1, 1};
    scene.skins = {{{0}, {Mat4(3e38f)}}};
    scene.skins[0].inverseBind[0][3].w = 1;
    scene.instances[0].mesh = mesh, scene.instances[0].skin = 0;
    const auto posed = poseScene(std::make_shared<const Scene>(scene), {});
    for (const Vec3& n : posed->instances[0].deformed->normals) EXPECT_NEAR(glm::length(n), 1, 1e-6f);
}

TEST(Reach, LightsAreFollowed) {
    Scene scene = oneThing();
    Light light;
    light.name = "lamp", light.node = 1;
    scene.nodes.resize(2);
    scene.lights = {light};
    poseScene(std::make_shared<const Scene>(scene), {});
    scene.nodes[1].local.translation.y = 1e30f;
    expectError(ErrorKind::BadInput, [&] { poseScene(std::make_shared<const Scene>(scene), {}); },
                {"far.gltf", "light \"lamp\"", "1e+30"});
}

TEST(Reach, CamerasAreToo) {
    Camera camera;
    const Extent2 extent{64, 36};
    requireReach(poseCamera(camera, extent), "a.gltf");
    for (const float far : {1e30f, kNan, -kInfinity}) {
        camera.eye = {0, far, 0};
        expectError(ErrorKind::BadInput, [&] { requireReach(poseCamera(camera, extent), "a.gltf"); },
                    {"a.gltf", "the camera"});
    }
    camera.eye = {0, 0, 5};
    camera.projection = Projection::Orthographic;
    camera.yMag = 3e38f;
    expectError(ErrorKind::BadInput, [&] { requireReach(poseCamera(camera, extent), "a.gltf"); },
                {"the camera", "inf"});
}

}  // namespace
}  // namespace lumi

#include "scene/camera.h"

#include <gtest/gtest.h>

#include "scene/light.h"
#include "scene/material.h"
#include "scene/scene.h"
#include "support/expect_error.h"

namespace lumi {
namespace {

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-4f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(Camera, ProjectsToContinuousPixels) {
    Camera camera;
    camera.eye = {0, 0, 2};
    camera.fovYDeg = 90;
    const CameraPose pose = poseCamera(camera, {200, 100});
    expectNear(pose.project({0, 0, 0}), {100, 50, 2});
    expectNear(pose.project({2, 0, 0}), {150, 50, 2});  // 45 degrees is half the height away
    expectNear(pose.project({0, 2, 0}), {100, 0, 2});   // the top edge
    EXPECT_LT(pose.project({0, 0, 3}).z, 0);
    EXPECT_NEAR(pose.pixelSize() * 100, 2, 1e-6f);
    expectNear(pose.forward(), {0, 0, -1});
    expectNear(pose.position(), {0, 0, 2});
}

TEST(Camera, OrthographicDoesNotForeshorten) {
    Camera camera;
    camera.projection = Projection::Orthographic;
    camera.yMag = 4;
    camera.eye = {0, 0, 10};
    const CameraPose pose = poseCamera(camera, {100, 100});
    expectNear(pose.project({4, -4, 0}), {100, 100, 10});
    expectNear(pose.project({4, -4, 5}), {100, 100, 5});
}

TEST(Camera, InverseIsExactEnough) {
    Camera camera;
    camera.eye = {100, 50, -30};
    camera.target = {3, 2, 1};
    camera.up = {0.1f, 1, 0.2f};
    const CameraPose pose = poseCamera(camera, {64, 64});
    const Mat4 product = pose.cameraFromWorld * pose.worldFromCamera;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], c == r ? 1 : 0, 2e-5f);
}

TEST(Camera, KeyedCamerasPassThroughTheirKeys) {
    Scene scene;
    SceneCamera camera;
    camera.keys = {
        {0, {0, 0, 0}, {0, 0, -1}, 40, 1}, {1, {1, 0, 0}, {1, 0, -1}, 50, 2}, {2, {2, 3, 0}, {2, 3, -1}, 60, 3}};
    scene.cameras = {camera};
    expectNear(cameraAt(scene, 0, 0).eye, {0, 0, 0});
    expectNear(cameraAt(scene, 0, 1).eye, {1, 0, 0});
    EXPECT_FLOAT_EQ(cameraAt(scene, 0, 1).fovYDeg, 50);
    EXPECT_FLOAT_EQ(cameraAt(scene, 0, 2).focus, 3);
    expectNear(cameraAt(scene, 0, 99).eye, {2, 3, 0});
    // Catmull-Rom on y = 0, 0, 3: the tangents are 1.5 and 3, so half-way 1.5 + (1.5 - 3) / 8.
    EXPECT_NEAR(cameraAt(scene, 0, 1.5f).eye.y, 1.5f - 1.5f / 8, 1e-5f);
    EXPECT_FLOAT_EQ(scene.duration(), 2);
    EXPECT_TRUE(scene.isAnimated());
}

TEST(Camera, NodeCamerasIgnoreTheNodesScale) {
    Scene scene;
    Node node;
    node.local.translation = {1, 2, 3};
    node.local.rotation = glm::angleAxis(radians(90), Vec3(0, 1, 0));
    node.local.scale = Vec3(5);
    scene.nodes = {node};
    SceneCamera camera;
    camera.node = 0;
    camera.camera.eye = {0, 0, 0};
    camera.camera.target = {0, 0, -7};
    scene.cameras = {camera};
    const Camera posed = cameraAt(scene, 0, 0);
    expectNear(posed.eye, {1, 2, 3});
    expectNear(posed.target, {1 - 7, 2, 3});
    expectNear(posed.up, {0, 1, 0});
}

TEST(Parameters, CameraLightAndMaterialCanBeSetByName) {
    Camera camera;
    const Describe describeCamera = [&](ParameterVisitor& v) { camera.describe(v); };
    setParameter(describeCamera, "look-at", Vec3(1, 2, 3));
    setParameter(describeCamera, "projection", std::string("orthographic"));
    EXPECT_EQ(camera.target, Vec3(1, 2, 3));
    EXPECT_EQ(camera.projection, Projection::Orthographic);
    EXPECT_EQ(setParameter(describeCamera, "fov-y-deg", 30.0f), Redo::Samples);
    test::expectError(ErrorKind::Usage, [&] { setParameter(describeCamera, "fov-y-deg", 200.0f); }, {"fov-y-deg"});

    Material material;
    const Describe describeMaterial = [&](ParameterVisitor& v) { material.describe(v); };
    EXPECT_FLOAT_EQ(std::get<float>(getParameter(describeMaterial, "attenuation-distance")), 1e6f);
    EXPECT_EQ(material.attenuationDistance, kInfinity) << "reading changes nothing";
    setParameter(describeMaterial, "attenuation-distance", 0.5f);
    EXPECT_EQ(material.attenuationDistance, 0.5f);
    setParameter(describeMaterial, "attenuation-distance", 1e6f);
    EXPECT_EQ(material.attenuationDistance, kInfinity);
    for (const char* id : {"base-color", "metallic", "roughness", "emission", "alpha", "ior", "specular",
                           "specular-color", "transmission", "thickness", "attenuation-color", "normal-scale"})
        EXPECT_NO_THROW(getParameter(describeMaterial, id)) << id;
}

TEST(Parameters, LightsShowWhatTheirTypeHas) {
    const auto active = [](LightType type) {
        Light light;
        light.type = type;
        std::vector<std::string> ids;
        for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { light.describe(v); }))
            if (info.active) ids.push_back(info.id);
        return ids;
    };
    using Ids = std::vector<std::string>;
    EXPECT_EQ(active(LightType::Point), (Ids{"power", "intensity", "range"}));
    EXPECT_EQ(active(LightType::Spot), (Ids{"power", "intensity", "range", "inner-cone-deg", "outer-cone-deg"}));
    EXPECT_EQ(active(LightType::Directional), (Ids{"power", "irradiance", "angle-deg"}));
    EXPECT_EQ(active(LightType::Rectangle), (Ids{"power", "radiance", "width", "height"}));
    EXPECT_EQ(active(LightType::Sphere), (Ids{"power", "radiance", "radius"}));
}

}  // namespace
}  // namespace lumi

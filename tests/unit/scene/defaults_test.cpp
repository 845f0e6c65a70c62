#include "scene/defaults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/pose_bounds.h"
#include "scene/procedural/primitives.h"
#include "scene/sky.h"
#include "support/expect_error.h"

namespace lumi::test {
namespace {

/// One mesh at a place.
Scene sceneOf(Mesh mesh, const Vec3& at = Vec3(0)) {
    Scene scene;
    scene.path = "made.obj";
    scene.materials.emplace_back();
    scene.nodes.emplace_back();
    scene.nodes[0].local.translation = at;
    scene.instances.push_back({"it", std::make_shared<const Mesh>(std::move(mesh)), 0, -1, -1, -1});
    return scene;
}

/// A box seen from within: its walls face the middle.
Mesh roomMesh(const Vec3& size) {
    Mesh mesh = boxMesh(size);
    for (UVec3& t : mesh.triangles) std::swap(t.y, t.z);
    for (Vec3& n : mesh.normals) n = -n;
    return mesh;
}

TEST(DefaultCamera, StandsInsideRooms) {
    // Along the longer horizontal axis, at the centre.
    const Camera alongX = defaultCamera(sceneOf(roomMesh({8, 3, 4}), {1, 2, 3}));
    EXPECT_EQ(alongX.name, "default");
    EXPECT_EQ(alongX.fovYDeg, 45);
    EXPECT_LT(glm::distance(alongX.eye, Vec3(1, 2, 3)), 1e-5f);
    EXPECT_GT(std::abs(glm::normalize(alongX.target - alongX.eye).x), 0.9999f);
    const Camera alongZ = defaultCamera(sceneOf(roomMesh({4, 30, 8})));
    EXPECT_GT(std::abs(glm::normalize(alongZ.target - alongZ.eye).z), 0.9999f);
}

TEST(DefaultCamera, StandsAtTheOpenEndOfARoom) {
    // A Cornell box: five walls of a near-cube, open towards +z or, turned, towards -x.
    Mesh box = roomMesh({2, 2, 1.98f});
    std::erase_if(box.triangles, [&](const UVec3& t) {
        return box.positions[t.x].z > 0.9f && box.positions[t.y].z > 0.9f && box.positions[t.z].z > 0.9f;
    });
    const Camera camera = defaultCamera(sceneOf(box, {5, 0, 0}));
    EXPECT_LT(glm::distance(camera.eye, Vec3(5, 0, 0.98f * 0.99f)), 1e-4f);
    EXPECT_LT(glm::normalize(camera.target - camera.eye).z, -0.9999f);
    for (Vec3& p : box.positions) p = {-p.z, p.y, p.x};
    for (Vec3& n : box.normals) n = {-n.z, n.y, n.x};
    const Camera turned = defaultCamera(sceneOf(box));
    EXPECT_LT(turned.eye.x, -0.9f);
    EXPECT_GT(glm::normalize(turned.target - turned.eye).x, 0.9999f);
}

TEST(DefaultCamera, FramesScenesWhoseMiddleIsANook) {
    // A closet behind the middle of a long shelf: closed around the centre, but nothing to stand in.
    Scene scene = sceneOf(roomMesh(Vec3(2)));
    Mesh shelf = boxMesh({40, 2, 0.1f});
    for (Vec3& p : shelf.positions) p.z += 1.5f;
    scene.instances.push_back({"shelf", std::make_shared<const Mesh>(shelf), -1, -1, -1, -1});
    EXPECT_EQ(enclosure(scene, scene.restBounds().centre()), 1);
    EXPECT_GT(glm::distance(defaultCamera(scene).eye, Vec3(0)), 20);
}

TEST(DefaultCamera, FramesWhatIsNotARoom) {
    // A floor seen from its own centre encloses nothing; every corner must be in a square image, and fill most of it.
    for (const Vec3& at : {Vec3(0), Vec3(100, -20, 7)}) {
        const Scene scene = sceneOf(rectangleMesh(4, 2, Facing::Y), at);
        const Camera camera = defaultCamera(scene);
        EXPECT_LT(glm::distance(camera.target, at), 1e-4f);
        const CameraPose pose = poseCamera(camera, {100, 100});
        float widest = 0;
        for (const Vec3& p : scene.instances[0].mesh->positions) {
            const Vec3 pixel = pose.project(p + at);
            EXPECT_GT(pixel.z, 0);
            widest = std::max({widest, std::abs(pixel.x - 50), std::abs(pixel.y - 50)});
        }
        EXPECT_LT(widest, 50);
        EXPECT_GT(widest, 35);
    }
}

/// Gives the first node keys at equal times.
void animate(Scene& scene, AnimatedProperty property, int components, std::vector<float> values, float duration) {
    AnimationChannel channel;
    channel.node = 0;
    channel.property = property;
    channel.components = components;
    const size_t keys = values.size() / static_cast<size_t>(components);
    for (size_t i = 0; i < keys; ++i)
        channel.times.push_back(duration * static_cast<float>(i) / static_cast<float>(keys - 1));
    channel.values = std::move(values);
    scene.animations.push_back({{channel}, duration, true});
}

/// Over its animation: the largest distance of any vertex from the picture's middle, of 50 there are.
float widestOverTime(const Scene& scene, float duration) {
    const CameraPose camera = poseCamera(defaultCamera(scene), {100, 100});
    float widest = 0;
    for (int i = 0; i <= 97; ++i) {
        const NodePose pose = poseNodes(scene, duration * static_cast<float>(i) / 97);
        for (const Vec3& p : scene.instances[0].mesh->positions) {
            const Vec3 pixel = camera.project(transformPoint(pose.worldFromNode[0], p));
            EXPECT_GT(pixel.z, 0);
            widest = std::max({widest, std::abs(pixel.x - 50), std::abs(pixel.y - 50)});
        }
    }
    return widest;
}

TEST(DefaultCamera, FramesWhatMovesAllTheTime) {
    Scene goes = sceneOf(rectangleMesh(2, 2, Facing::Z));
    animate(goes, AnimatedProperty::Translation, 3, {0, 0, 0, 3, 0, 0, 0, -2, 0}, 2);
    Scene turns = sceneOf(rectangleMesh(4, 0.2f, Facing::Z));
    animate(turns, AnimatedProperty::Rotation, 4, {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, -1}, 3);
    // The long animation's moments all find the short one, which is a sixteenth of it, where it began.
    Scene twice = sceneOf(rectangleMesh(2, 2, Facing::Z));
    animate(twice, AnimatedProperty::Translation, 3, {0, 0, 0, 3, 0, 0, 0, 0, 0}, 0.25f);
    animate(twice, AnimatedProperty::Scale, 3, {1, 1, 1, 1, 1, 1}, 4);
    const std::pair<const Scene*, float> all[] = {{&goes, 2.0f}, {&turns, 3.0f}, {&twice, 0.25f}};
    for (const auto& [scene, duration] : all) {
        EXPECT_LT(widestOverTime(*scene, duration), 50);
        EXPECT_GT(widestOverTime(*scene, duration), 35);
    }
}

TEST(DefaultCamera, LosesWhatGoesFarRatherThanMakingAllASpeck) {
    Scene scene = sceneOf(rectangleMesh(2, 2, Facing::Z));
    const Mesh floor = rectangleMesh(4, 4, Facing::Y);
    scene.instances.push_back({"floor", std::make_shared<const Mesh>(floor), -1, -1, -1, -1});
    const Camera still = defaultCamera(scene);
    animate(scene, AnimatedProperty::Translation, 3, {0, 0, 0, 5000, 0, 0}, 1);
    EXPECT_EQ(defaultCamera(scene).eye, still.eye);
    // Nothing to be seen at first: what comes is the measure.
    Scene grows = sceneOf(rectangleMesh(2, 2, Facing::Z));
    animate(grows, AnimatedProperty::Scale, 3, {0, 0, 0, 0, 0, 0, 1, 1, 1}, 1);
    EXPECT_GT(boundsOverTime(grows).radius(), 0.1f);
    EXPECT_LT(glm::distance(defaultCamera(grows).eye, Vec3(0)), 10);
}

TEST(DefaultCamera, StopsWithTheLoad) {
    Scene scene = sceneOf(boxMesh(Vec3(1)));
    std::stop_source source;
    source.request_stop();
    MessageLog log;
    expectError(ErrorKind::Interrupted, [&] { addDefaults(scene, log, true, source.get_token()); },
                {"made.obj", "stopped"});
    EXPECT_TRUE(scene.cameras.empty());
}

TEST(DefaultCamera, EnclosureCountsDirections) {
    EXPECT_EQ(enclosure(sceneOf(roomMesh(Vec3(2))), Vec3(0)), 1);
    EXPECT_LT(enclosure(sceneOf(boxMesh(Vec3(2))), Vec3(5, 0, 0)), 0.3f);
    EXPECT_EQ(enclosure(Scene(), Vec3(0)), 0);
    // A wide floor below covers half of all directions.
    EXPECT_NEAR(enclosure(sceneOf(rectangleMesh(1000, 1000, Facing::Y)), Vec3(0, 1, 0)), 0.5f, 0.05f);
}

TEST(DefaultCamera, ClosedObjectsAreNoRooms) {
    Scene object = sceneOf(boxMesh({2, 1, 1}));
    EXPECT_EQ(enclosure(object, Vec3(0)), 0);
    EXPECT_GT(glm::distance(defaultCamera(object).eye, Vec3(0)), 2);
    object.nodes[0].local.scale = {-1, 1, 1};
    EXPECT_EQ(enclosure(object, Vec3(0)), 0) << "mirroring does not turn an object inside out";
    Scene skinned = object;
    Mesh mesh = *object.instances[0].mesh;
    for (uint32_t v = 0; v <= mesh.positions.size(); ++v) mesh.skin.first.push_back(v);
    mesh.skin.joint.assign(mesh.positions.size(), 0), mesh.skin.weight.assign(mesh.positions.size(), 1);
    skinned.instances[0].mesh = std::make_shared<const Mesh>(mesh), skinned.instances[0].skin = 0;
    skinned.skins = {{{0}, {Mat4(1)}}};
    EXPECT_EQ(enclosure(skinned, Vec3(0)), 0) << "nor by its joints";
    // A crate in the middle of a room: the centre lies inside the crate, whose inside is met first.
    object.instances.push_back({"room", std::make_shared<const Mesh>(roomMesh(Vec3(20))), -1, -1, -1, -1});
    EXPECT_EQ(enclosure(object, Vec3(0)), 0);
    EXPECT_EQ(enclosure(object, Vec3(0, 5, 0)), 1);
}

TEST(DefaultCamera, EmptyScenesGetOneToo) {
    const Camera camera = defaultCamera(Scene());
    EXPECT_NE(camera.eye, camera.target);
}

TEST(Defaults, DarkScenesGetTheSkyAndAWarning) {
    MessageLog log;
    Scene dark = sceneOf(boxMesh(Vec3(1)));
    addDefaults(dark, log, true);
    EXPECT_TRUE(dark.environment.visible());
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_EQ(log.warnings()[0], "made.obj: no light and no emission; lit by the built-in sky unless another is set");

    Scene glowing = sceneOf(boxMesh(Vec3(1)));
    glowing.materials[0].emission = Vec3(1);
    addDefaults(glowing, log, true);
    EXPECT_FALSE(glowing.environment.visible());

    // What only paints glowing parts is told apart.
    Scene dial = sceneOf(boxMesh(Vec3(1)));
    dial.materials[0].emission = Vec3(1);
    auto picture = std::make_shared<TextureImage>();
    picture->levels.push_back({{1, 1}, {255, 0, 0, 255}, {}});
    dial.materials[0].emissionTexture.image = picture;
    addDefaults(dial, log, true);
    EXPECT_TRUE(dial.environment.visible());
    ASSERT_EQ(log.warnings().size(), 2u);
    EXPECT_NE(log.warnings()[1].find("textures of strength 1 or less"), std::string::npos) << log.warnings()[1];

    // An unlit card lights nothing beside it; alone it needs no light.
    Scene card = sceneOf(boxMesh(Vec3(1)));
    card.materials[0].emission = Vec3(1), card.materials[0].unlit = true;
    addDefaults(card, log, true);
    EXPECT_FALSE(card.environment.visible());
    card.materials.emplace_back();
    card.instances.push_back({"wall", std::make_shared<const Mesh>(boxMesh(Vec3(2))), -1, -1, 1, -1});
    addDefaults(card, log, true);
    EXPECT_TRUE(card.environment.visible());

    // Emission that nothing wears does not count; our own files are dark when they say so.
    Scene unused = sceneOf(boxMesh(Vec3(1)));
    unused.materials.emplace_back();
    unused.materials[1].emission = Vec3(1);
    EXPECT_FALSE(hasLight(unused));
    addDefaults(unused, log, false);
    EXPECT_FALSE(unused.environment.visible());
}

double meanLuminance(const Image& sky) {
    double sum = 0, weights = 0;
    for (int y = 0; y < sky.height(); ++y) {
        const double weight = std::sin(3.14159265358979 * (y + 0.5) / sky.height());
        for (int x = 0; x < sky.width(); ++x) {
            sum += weight * luminance({sky.at(0, x, y), sky.at(1, x, y), sky.at(2, x, y)});
            weights += weight;
        }
    }
    return sum / weights;
}

TEST(DefaultSky, HasMeanRadianceOne) {
    EXPECT_NEAR(meanLuminance(makeDefaultSky()), 1, 1e-3);
    Sky bright;
    bright.radiance = 7;
    bright.sunShare = 0;
    EXPECT_NEAR(meanLuminance(bright.build()), 7, 7e-3);
}

TEST(DefaultSky, TheSunStandsWhereItIsPut) {
    Sky sky;
    sky.sunElevationDeg = 30;
    sky.sunAzimuthDeg = 90;  // from +Z towards +X
    sky.sunShare = 0.9f;
    const Image image = sky.build();
    Vec3 brightest(0);
    float most = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.at(0, x, y) > most) {
                most = image.at(0, x, y);
                // Image centre is -Z, u grows towards +X, row 0 is up.
                const float phi = 2 * kPi * (static_cast<float>(x) + 0.5f) / static_cast<float>(image.width()) - kPi;
                const float theta = kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height());
                brightest = {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
            }
    EXPECT_GT(glm::dot(brightest, Vec3(std::cos(radians(30)), 0.5f, 0)), 0.999f);
}

TEST(Defaults, PaintedGlowIsNoLight) {
    Scene scene = sceneOf(boxMesh(Vec3(1)));
    Material& material = scene.materials[0];
    material.emission = Vec3(1);
    EXPECT_TRUE(hasLight(scene));
    auto image = std::make_shared<TextureImage>();
    image->levels.push_back({{1, 1}, {255, 255, 255, 255}, {}});
    material.emissionTexture.image = image;
    EXPECT_FALSE(hasLight(scene)) << "a texture of strength 1 paints glowing parts";
    material.emission = Vec3(4);
    EXPECT_TRUE(hasLight(scene)) << "strength above 1 is meant to light";
}

}  // namespace
}  // namespace lumi::test

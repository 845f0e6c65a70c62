#include "scene_file_support.h"

#include <cmath>
#include <set>
#include <string>

#include "base/files.h"
#include "scene/node_pose.h"
#include "support/temporary_folder.h"

// What a scene file that is right becomes.
namespace lumi::test {
namespace {

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LE(glm::distance(a, b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

Vec3 originOf(const Scene& scene, int node, float time) {
    return transformPoint(worldFromNodeAt(scene, node, time), Vec3(0));
}

TEST(SceneFile, MinimalFileIsAnEmptyScene) {
    const Scene scene = parseScene(R"({"version": 1})");
    EXPECT_TRUE(scene.instances.empty());
    EXPECT_TRUE(scene.cameras.empty());
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.path, "s.json");
    EXPECT_EQ(scene.contentDigest.size(), 16u);
    EXPECT_EQ(parseScene("\xef\xbb\xbf{\"version\": 1}").instances.size(), 0u);
}

TEST(SceneFile, EveryValueArrives) {
    const Scene scene = parseScene(R"({
      "version": 1, "title": "All",
      "materials": {
        "m": {"base-color": [0.1, 0.2, 0.3], "metallic": 1, "roughness": 0.25, "emission": 2, "ior": 1.33,
              "alpha-mode": "mask", "alpha-cutoff": 0.25, "alpha": 0.5, "transmission": 1, "thickness": 0.5,
              "attenuation-distance": 2, "double-sided": false}},
      "environment": {"constant": [1, 2, 3], "scale": 2, "rotate-deg": 30},
      "cameras": {
        "near": {"eye": [0, 1, 2], "look-at": [0, 1, 0], "fov-y-deg": 30, "aperture": 0.1},
        "flat": {"eye": [0, 0, 9], "projection": "orthographic", "y-mag": 3, "focus": 4}},
      "render": {"size": [320, 200], "fps": 24, "exposure": -1.5, "module": "none",
                 "set": {"path.max-depth": 4, "path.clamp": true, "view.0.tone": "linear", "x": [1, 2, 3]}}
    })");
    EXPECT_EQ(scene.title, "All");
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.name, "m");
    EXPECT_EQ(m.baseColor, Vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.emission, Vec3(2));
    EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(m.alphaCutoff, 0.25f);
    EXPECT_EQ(m.alpha, 0.5f);
    EXPECT_EQ(m.ior, 1.33f);
    EXPECT_EQ(m.thickness, 0.5f);
    EXPECT_EQ(m.attenuationDistance, 2);
    EXPECT_FALSE(m.doubleSided);
    EXPECT_EQ(scene.environment.constant, Vec3(1, 2, 3));
    EXPECT_EQ(scene.environment.scale, 2);
    EXPECT_EQ(scene.environment.rotateDeg, 30);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].camera.name, "near");
    EXPECT_EQ(scene.cameras[0].camera.focus, 2) << "a camera without a focus is sharp where it looks";
    EXPECT_EQ(scene.cameras[1].camera.focus, 4);
    EXPECT_EQ(scene.cameras[1].camera.projection, Projection::Orthographic);
    EXPECT_EQ(scene.render.size, (Extent2{320, 200}));
    EXPECT_EQ(scene.render.fps, 24);
    EXPECT_EQ(scene.render.exposureEv, -1.5f);
    EXPECT_EQ(scene.render.module, "none");
    const std::vector<std::pair<std::string, std::string>> set{
        {"path.max-depth", "4"}, {"path.clamp", "true"}, {"view.0.tone", "linear"}, {"x", "1,2,3"}};
    EXPECT_EQ(scene.render.set, set);
}

TEST(SceneFile, InstancesShareMeshesWhateverTheyWear) {
    const Scene scene = parseScene(R"({"version": 1, "assets": {"ball": {"sphere": {"radius": 2}}},
      "materials": {"red": {}, "blue": {}},
      "instances": [{"asset": "ball"}, {"asset": "ball", "material": "red"}, {"asset": "ball", "material": "blue"},
                    {"name": "last", "asset": "ball", "materials": {"surface": "blue"}}]})");
    ASSERT_EQ(scene.instances.size(), 4u);
    std::set<const Mesh*> meshes;
    for (const Instance& instance : scene.instances) meshes.insert(instance.mesh.get());
    EXPECT_EQ(meshes.size(), 1u);
    const auto wears = [&](size_t i) {
        const Instance& instance = scene.instances[i];
        return scene
            .materials[instance.material >= 0 ? static_cast<size_t>(instance.material) : instance.mesh->material]
            .name;
    };
    EXPECT_EQ(scene.instances[0].name, "ball");
    EXPECT_EQ(scene.instances[1].name, "ball-2");
    EXPECT_EQ(scene.instances[3].name, "last");
    EXPECT_EQ(wears(0), "ball/surface");
    EXPECT_EQ(wears(1), "red");
    EXPECT_EQ(wears(2), "blue");
    EXPECT_EQ(wears(3), "blue");
}

TEST(SceneFile, ParentsMayFollowTheirChildren) {
    const Scene scene = parseScene(R"({"version": 1, "assets": {"ball": {"sphere": {}}}, "instances": [
      {"name": "child", "asset": "ball", "parent": "group", "translate": [1, 0, 0]},
      {"name": "group", "translate": [0, 5, 0], "rotate-deg": [0, 90, 0], "scale": 2}]})");
    ASSERT_EQ(scene.instances.size(), 1u);
    for (size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_LT(scene.nodes[i].parent, static_cast<int>(i));
    expectNear(originOf(scene, scene.instances[0].node, 0), {0, 5, -2});
}

TEST(SceneFile, RotationsAreAboutFixedAxesInOrder) {
    const Scene scene = parseScene(R"({"version": 1, "instances": [{"rotate-deg": [90, 90, 0]}]})");
    // Y goes to Z by the turn about X, then to X by the turn about Y.
    expectNear(scene.nodes[0].local.rotation * Vec3(0, 1, 0), {1, 0, 0});
}

TEST(SceneFile, KeysAnimate) {
    const auto keyed = [](const std::string& how) {
        return parseScene(R"({"version": 1, "instances": [{"keys": [{"time": 0, "translate": [0, 0, 0]},
            {"time": 1, "translate": [1, 0, 0]}, {"time": 3, "translate": [0, 0, 0]}])" +
                          how + "}]}");
    };
    const Scene linear = keyed("");
    EXPECT_EQ(linear.duration(), 3);
    expectNear(originOf(linear, 0, 0.5f), {0.5f, 0, 0});
    expectNear(originOf(linear, 0, 2), {0.5f, 0, 0});
    expectNear(originOf(linear, 0, 3.5f), {0.5f, 0, 0});
    expectNear(originOf(keyed(", \"loop\": false"), 0, 3.5f), {0, 0, 0});
    expectNear(originOf(keyed(", \"interpolation\": \"step\""), 0, 0.9f), {0, 0, 0});
    const Scene smooth = keyed(", \"interpolation\": \"catmull-rom\"");
    expectNear(originOf(smooth, 0, 1), {1, 0, 0});
    EXPECT_GT(originOf(smooth, 0, 0.5f).x, 0.5f);
}

TEST(SceneFile, KeysTouchOnlyWhatTheyMention) {
    const Scene scene = parseScene(R"({"version": 1, "instances": [{"translate": [0, 7, 0], "keys": [
      {"time": 0, "rotate-deg": [0, 0, 0]}, {"time": 1, "rotate-deg": [0, 360, 0]}]}]})");
    const auto forward = [&](float time) { return transformVector(worldFromNodeAt(scene, 0, time), Vec3(0, 0, 1)); };
    expectNear(originOf(scene, 0, 0.3f), {0, 7, 0});
    // A whole turn goes all the way round: a quarter of the time is a quarter turn.
    expectNear(forward(0.25f), {1, 0, 0});
    expectNear(forward(0.5f), {0, 0, -1});
    expectNear(forward(0.75f), {-1, 0, 0});
}

TEST(SceneFile, LightsStandTurnAndFollow) {
    const Scene scene = parseScene(R"({"version": 1, "instances": [{"name": "cart", "translate": [10, 0, 0]}],
      "lights": {
        "panel": {"rectangle": {"size": [2, 3]}, "radiance": [5, 6, 7], "power": 2, "translate": [0, 3, 0],
                  "look-at": [0, 0, 0], "keys": [{"time": 0, "translate": [0, 3, 0]}, {"time": 1, "translate": [3, 0, 0]}]},
        "sun": {"directional": {"angle-deg": 0.53}, "irradiance": 3, "direction": [-1, 0, 0]},
        "bulb": {"sphere": {"radius": 0.1}, "radiance": 4, "parent": "cart", "translate": [0, 1, 0]},
        "round": {"disk": {"radius": 0.5}},
        "dot": {"point": {}, "intensity": [1, 2, 3]},
        "torch": {"spot": {"inner-cone-deg": 10, "outer-cone-deg": 20}, "intensity": 9}}})");
    ASSERT_EQ(scene.lights.size(), 6u);
    const Light& panel = scene.lights[0];
    EXPECT_EQ(panel.type, LightType::Rectangle);
    EXPECT_EQ(panel.size, Vec2(2, 3));
    EXPECT_EQ(panel.radiance, Vec3(5, 6, 7));
    EXPECT_EQ(panel.power, 2);
    const auto axis = [&](const Light& light, float time) {
        return transformVector(worldFromNodeAt(scene, light.node, time), Vec3(0, 0, -1));
    };
    expectNear(axis(panel, 0), {0, -1, 0});
    expectNear(axis(panel, 0.99999f), {-1, 0, 0}, 1e-3f);
    expectNear(axis(scene.lights[1], 0), {-1, 0, 0});
    EXPECT_EQ(scene.lights[1].irradiance, Vec3(3));
    expectNear(originOf(scene, scene.lights[2].node, 0), {10, 1, 0});
    EXPECT_EQ(scene.lights[5].outerConeDeg, 20);

    // Lights with extent have a body on their node, others have none.
    ASSERT_EQ(scene.instances.size(), 3u);
    for (const Instance& instance : scene.instances) {
        ASSERT_GE(instance.light, 0);
        EXPECT_EQ(instance.node, scene.lights[static_cast<size_t>(instance.light)].node);
        EXPECT_EQ(scene.materials[static_cast<size_t>(instance.material)].baseColor, Vec3(0));
    }
}

TEST(SceneFile, CameraPaths) {
    const Scene scene = parseScene(R"({"version": 1, "cameras": {"c": {"eye": [0, 1, 5], "look-at": [0, 1, 0],
      "interpolation": "linear", "keys": [{"time": 0}, {"time": 2, "eye": [4, 1, 5]}, {"time": 4, "fov-y-deg": 60}]}}})");
    EXPECT_EQ(scene.duration(), 4);
    expectNear(cameraAt(scene, 0, 1).eye, {2, 1, 5});
    expectNear(cameraAt(scene, 0, 3).eye, {4, 1, 5});
    EXPECT_NEAR(cameraAt(scene, 0, 3).fovYDeg, 52.5f, 1e-4f);
    expectNear(cameraAt(scene, 0, 3).target, {0, 1, 0});
}

TEST(SceneFile, TexturesFromGenerators) {
    const Scene scene = parseScene(R"({"version": 1, "materials": {"m": {"base-color-texture":
      {"checker": {"squares": 2, "first": 1, "second": 0}, "scale": [3, 4], "offset": [0.5, 0], "rotate-deg": 90,
       "wrap": "clamp", "filter": "nearest", "uv-set": 1}}}})");
    const Texture& texture = scene.materials[0].baseColorTexture;
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture.scale, Vec2(3, 4));
    EXPECT_EQ(texture.offset, Vec2(0.5f, 0));
    EXPECT_NEAR(texture.rotation, 0.5f * kPi, 1e-6f);
    EXPECT_EQ(texture.wrapU, Wrap::ClampToEdge);
    EXPECT_EQ(texture.filter, TextureFilter::Nearest);
    EXPECT_EQ(texture.uvSet, 1);
    EXPECT_GT(texture.image->levels.size(), 3u) << "the pyramid is built";
    EXPECT_EQ(texture.image->levels[0].bytes[0], 255);
}

TEST(SceneFile, TexturesWithoutMipMapsKeepTheirDetail) {
    const Scene scene = parseScene(R"({"version": 1, "materials": {
      "sharp": {"base-color-texture": {"checker": {"squares": 8, "first": 1, "second": 0}, "mipmaps": false}},
      "soft": {"base-color-texture": {"checker": {"squares": 8, "first": 1, "second": 0}}}}})");
    const Texture &sharp = scene.materials[0].baseColorTexture, &soft = scene.materials[1].baseColorTexture;
    EXPECT_EQ(sharp.image->levels.size(), 1u);
    const Vec2 white(1.0f / 32);
    EXPECT_NEAR(sharp.sample(white, 1).x, 1, 1e-3f);
    EXPECT_NEAR(soft.sample(white, 1).x, 0.5f, 0.02f);
}

TEST(SceneFile, EqualGeneratedTexturesAreMadeOnce) {
    const Scene scene = parseScene(R"({"version": 1, "materials": {
      "a": {"base-color-texture": {"checker": {"squares": 2}, "scale": 2}}, "b": {"base-color-texture": {"checker": {"squares": 2}}},
      "c": {"base-color-texture": {"checker": {"squares": 3}}}}})");
    const auto image = [&](size_t i) { return scene.materials[i].baseColorTexture.image; };
    EXPECT_EQ(image(0), image(1));
    EXPECT_NE(image(0), image(2));
    EXPECT_EQ(scene.materials[0].baseColorTexture.scale, Vec2(2));
    EXPECT_EQ(scene.materials[1].baseColorTexture.scale, Vec2(1));
}

TEST(SceneFile, LightsShareTheImageThatTheyShow) {
    const Scene scene =
        parseScene(R"({"version": 1, "materials": {"a": {"base-color-texture": {"checker": {}}}}, "lights": {
      "l": {"rectangle": {"size": [1, 1]}, "radiance": [1, 1, 1], "radiance-texture": {"checker": {}}},
      "m": {"disk": {"radius": 1}, "radiance": [1, 1, 1], "radiance-texture": {"checker": {}, "scale": 2}}}})");
    EXPECT_EQ(scene.lights[0].radianceTexture.image, scene.lights[1].radianceTexture.image);
    EXPECT_EQ(scene.lights[0].radianceTexture.image, scene.materials[0].baseColorTexture.image);
    EXPECT_EQ(scene.lights[1].radianceTexture.scale, Vec2(2));
}

constexpr const char* kCube = R"(v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 4 3 2
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
)";

TEST(SceneFile, ObjAssetsAndSubdivisionCages) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "cube.obj", std::string_view(kCube));
    const Scene scene = parseScene(R"({"version": 1,
      "assets": {"cube": {"obj": "cube.obj"}, "round": {"obj": "cube.obj", "subdivision": "catmull-clark", "rate": 4}},
      "materials": {"red": {}}, "instances": [{"asset": "cube", "material": "red"}, {"asset": "round"}]})",
                                   folder.path());
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[0].mesh->triangles.size(), 12u);
    const Mesh& round = *scene.instances[1].mesh;
    EXPECT_EQ(round.triangles.size(), 6u * 4 * 4 * 2);
    for (const Vec3& p : round.positions) EXPECT_LT(glm::length(p), 1) << "the limit surface lies inside its cage";
    EXPECT_EQ(refusal(R"({"version": 1, "assets": {"a": {"obj": "cube.obj", "rate": 65}}})", folder.path()),
              "s.json:1:60: \"rate\" is 65; expected 1 to 64");
}

/// One triangle below a node that stands at x = 2 and moves to x = 4 in a second; a lamp and a camera on it.
constexpr const char* kGltf = R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"extensionsUsed": ["KHR_lights_punctual"],
"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb", "intensity": 3}]}},
"nodes": [{"name": "arm", "translation": [2, 0, 0], "mesh": 0, "children": [1, 2]},
          {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}}, {"name": "eye", "camera": 0}],
"cameras": [{"name": "shot", "type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
"materials": [{"name": "paint"}],
"meshes": [{"name": "tri", "primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
"animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": 1, "output": 2}]}],
"buffers": [{"byteLength": 68, "uri":
"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAABAAAAAAAAAAAAAAIBAAAAAAAAAAAA="}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
              {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
              {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}]})";

TEST(SceneFile, GltfAssetsBringAllTheyHold) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.gltf", std::string_view(kGltf));
    const Scene scene = parseScene(R"({"version": 1, "assets": {"a": {"gltf": "a.gltf"}}, "materials": {"red": {}},
      "cameras": {"own": {}},
      "instances": [{"name": "one", "asset": "a", "translate": [0, 10, 0]},
                    {"name": "two", "asset": "a", "translate": [0, 20, 0], "materials": {"paint": "red"}}]})",
                                   folder.path());
    ASSERT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
    expectNear(originOf(scene, scene.instances[0].node, 0), {2, 10, 0});
    expectNear(originOf(scene, scene.instances[1].node, 0.5f), {3, 20, 0});
    EXPECT_EQ(scene.instances[1].name.substr(0, 4), "two/");
    EXPECT_EQ(scene.materials[scene.instances[0].mesh->material].name, "a/paint");
    EXPECT_EQ(scene.materials[static_cast<size_t>(scene.instances[1].material)].name, "red");
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[1].name.substr(0, 4), "two/");
    expectNear(originOf(scene, scene.lights[1].node, 0), {2, 20, 0});
    ASSERT_EQ(scene.cameras.size(), 3u);
    EXPECT_EQ(scene.cameras[0].camera.name, "own");
    expectNear(cameraAt(scene, 2, 0).eye, {2, 20, 0});
}

TEST(SceneFile, AChoiceThatAnAssetDoesNotHaveIsPointedAt) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.gltf", std::string_view(kGltf));
    const auto refusalOf = [&](const std::string& choice) {
        return refusal(
            "{\"version\": 1, \"instances\": [{\"asset\": \"a\"}],\n\"assets\": {\"a\": {\"gltf\": \"a.gltf\", " +
                choice + "}}}",
            folder.path());
    };
    const auto expectPart = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expectPart(refusalOf("\"variant\": \"red\""), "s.json:2:47: asset \"a\": a.gltf: no such material variant");
    expectPart(refusalOf("\"scene\": 7"), "s.json:2:45: asset \"a\": a.gltf: no such scene in the file");
    expectPart(refusalOf("\"scene\": 7, \"variant\": \"red\""), "s.json:2:45: asset \"a\": a.gltf: no such scene");
    expectPart(refusalOf("\"scene\": 0, \"variant\": \"red\""), "s.json:2:59: asset \"a\": a.gltf: no such material");
    expectPart(refusalOf("\"scene\": 0, \"animation\": \"a\""), "s.json:2:61: asset \"a\": a.gltf: no such animation");
    EXPECT_EQ(refusal(R"({"version": 1, "render": {"set": {"scene.variant": "red"}}})"),
              "s.json:1:35: \"scene.variant\" does nothing to a scene file; expected \"scene\", \"variant\" or "
              "\"animation\" of an asset");
}

TEST(SceneFile, UnusedAssetsWarnAndAreNotBuilt) {
    MessageLog log;
    parseSceneFile(R"({"version": 1, "assets": {"big": {"hairball": {"strands": 200000}}}})", "s.json", {}, log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_EQ(log.warnings()[0], "s.json:1:27: asset \"big\" is used by no instance");
}

TEST(SceneFile, DigestFollowsEveryByteThatWasRead) {
    const std::string text = R"({"version": 1})", other = R"({"version":  1})";
    EXPECT_EQ(parseScene(text).contentDigest, parseScene(text).contentDigest);
    EXPECT_NE(parseScene(text).contentDigest, parseScene(other).contentDigest);
}

TEST(SceneFile, AStopIsHeard) {
    std::stop_source source;
    source.request_stop();
    LoadOptions options;
    options.stop = source.get_token();
    MessageLog log;
    try {
        parseSceneFile(R"({"version": 1})", "s.json", {}, log, options);
        ADD_FAILURE() << "the stop was not heard";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::Interrupted);
    }
}

}  // namespace
}  // namespace lumi::test

// What the specification of glTF 2.0 asks of who reads a file, and what it forbids the file.
#include <gtest/gtest.h>

#include "gltf_support.h"
#include "scene/deform.h"
#include "scene/node_pose.h"
#include "support/memory_limit.h"

namespace lumi {
namespace {

using test::GltfBuilder;

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

/// A joint outside the scene that names a mesh, and a channel that moves that mesh's weights.
GltfBuilder& withStrayJoint(GltfBuilder& file, int mesh) {
    file.triangle();
    file.primitive()["attributes"]["JOINTS_0"] = file.accessor(std::vector<uint8_t>(12, 0), "VEC4", 4, 5121);
    file.primitive()["attributes"]["WEIGHTS_0"] = file.floats({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"mesh", mesh}}};
    file.json["skins"] = {{{"joints", {1}}}};
    const int times = file.floats({0, 1}, "SCALAR", 1), weights = file.floats({0, 1}, "SCALAR", 1);
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", weights}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "weights"}}}}}}}};
    return file;
}

TEST(GltfRules, JointsOutsideTheSceneReferToWhatIsThere) {
    GltfBuilder good, bad;
    EXPECT_EQ(withStrayJoint(good, 0).load().skins.size(), 1u);
    withStrayJoint(bad, 99999999).expectRefused({"/nodes/1/mesh", "expected 0 to 0", "found 99999999"});
    for (const char* kind : {"camera", "skin"}) {
        GltfBuilder other;
        withStrayJoint(other, 0).json["nodes"][1][kind] = 7;
        other.expectRefused({std::string("/nodes/1/") + kind, "found 7"});
    }
}

TEST(GltfRules, CamerasStandWhereTheirNodesAreAtTheStart) {
    GltfBuilder file;
    file.triangle();
    const int times = file.floats({0, 1}, "SCALAR", 1), moved = file.floats({1, 0, 2, 5, 0, 2}, "VEC3", 3);
    file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    file.json["nodes"] = {{{"mesh", 0}, {"children", {1}}, {"translation", {9, 9, 9}}},
                          {{"camera", 0}, {"children", {2}}, {"scale", {2, 2, 2}}},
                          {{"camera", 0}, {"translation", {0, 1, 0}}}};
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", moved}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    expectNear(scene.cameras[0].camera.eye, {1, 0, 2});
    expectNear(scene.cameras[1].camera.eye, {1, 2, 2});
    for (int i = 0; i < 2; ++i) {
        const Camera& loaded = scene.cameras[static_cast<size_t>(i)].camera;
        expectNear(cameraAt(scene, i, 0).eye, loaded.eye);
        expectNear(cameraAt(scene, i, 0).target, loaded.target);
        expectNear(glm::normalize(loaded.target - loaded.eye), {0, 0, -1});
        expectNear(cameraAt(scene, i, 0.5f).eye, loaded.eye + Vec3(2, 0, 0));
    }
}

/// Two triangles of the square from (-1, -1) to (1, 1) without normals, and a target that moves one of its corners up.
GltfBuilder& foldedSquare(GltfBuilder& file, bool anisotropic) {
    nlohmann::json primitive;
    primitive["attributes"]["POSITION"] = file.floats({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3", 3);
    primitive["attributes"]["TEXCOORD_0"] = file.floats({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2", 2);
    primitive["indices"] = file.indices({0, 1, 2, 0, 2, 3});
    primitive["targets"] = {{{"POSITION", file.floats({0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0}, "VEC3", 3)}}};
    primitive["material"] = 0;
    file.json["meshes"] = {{{"primitives", {primitive}}}};
    file.json["materials"] = {nlohmann::json::object()};
    if (anisotropic) file.json["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyStrength"] = 0.5;
    return file;
}

TEST(GltfRules, FacesWithoutNormalsStayFlatWhenTheyMorph) {
    GltfBuilder file;
    const Scene scene = foldedSquare(file, true).load();
    const Mesh& mesh = *scene.instances.at(0).mesh;
    ASSERT_FALSE(mesh.normals.empty());
    ASSERT_FALSE(mesh.tangents.empty());
    for (const float weight : {0.0f, 0.5f, 1.0f}) {
        const std::vector<float> weights{weight};
        const DeformedVertices bent = deform(mesh, weights, {});
        // The corner (1, -1) rises by h = 4 weight: the first triangle's plane is z = h (x - y) / 2, the second's 0.
        const float slope = 2 * weight;
        for (int c = 0; c < 3; ++c) {
            expectNear(bent.normals[mesh.triangles[0][c]], glm::normalize(Vec3(-slope, slope, 1)));
            expectNear(bent.normals[mesh.triangles[1][c]], {0, 0, 1});
            // u grows along x.
            expectNear(bent.tangents[mesh.triangles[0][c]], glm::normalize(Vec3(1, 0, slope)));
            expectNear(bent.tangents[mesh.triangles[1][c]], {1, 0, 0});
        }
    }
}

TEST(GltfRules, AuthoredNormalsBesideFlatFacesKeepToTheFile) {
    GltfBuilder file;
    foldedSquare(file, false);
    nlohmann::json smooth = file.primitive();
    smooth["attributes"]["NORMAL"] = file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    file.json["meshes"][0]["primitives"].push_back(smooth);
    const Scene scene = file.load();
    const Mesh& mesh = *scene.instances.at(0).mesh;
    ASSERT_EQ(mesh.triangles.size(), 4u);
    const std::vector<float> weights{0.5f};
    const DeformedVertices bent = deform(mesh, weights, {});
    expectNear(bent.normals[mesh.triangles[0].x], glm::normalize(Vec3(-1, 1, 1)));
    for (int c = 0; c < 3; ++c) expectNear(bent.normals[mesh.triangles[2][c]], {0, 0, 1});
    GltfBuilder plain;
    EXPECT_TRUE(foldedSquare(plain, false).load().instances.at(0).mesh->normals.empty());
}

TEST(GltfRules, TangentsWithoutNormalsDoNotCount) {
    GltfBuilder file;
    foldedSquare(file, false);
    file.primitive()["attributes"]["TANGENT"] =
        file.floats({0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1}, "VEC4", 4);
    const int up = file.floats({0, 0, 9, 0, 0, 9, 0, 0, 9, 0, 0, 9}, "VEC3", 3);
    file.primitive()["targets"][0]["TANGENT"] = up;
    file.primitive()["targets"][0]["NORMAL"] = up;
    const Scene flat = file.load();
    EXPECT_TRUE(flat.instances.at(0).mesh->tangents.empty());
    EXPECT_TRUE(flat.instances.at(0).mesh->morphTargets.at(0).normals.empty());
    EXPECT_TRUE(flat.instances.at(0).mesh->morphTargets.at(0).tangents.empty());
    file.json["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyStrength"] = 0.5;
    const Scene directed = file.load();
    ASSERT_FALSE(directed.instances.at(0).mesh->tangents.empty());
    for (const Vec4& tangent : directed.instances.at(0).mesh->tangents) expectNear(Vec3(tangent), {1, 0, 0});
}

TEST(GltfRules, UnlitMaterialsHaveTheSidesOfTheFile) {
    for (const bool both : {false, true}) {
        GltfBuilder file;
        file.triangle().primitive()["material"] = 0;
        file.json["materials"] = {
            {{"doubleSided", both}, {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}}};
        const Scene scene = file.load();
        EXPECT_TRUE(scene.materials.at(0).unlit);
        EXPECT_EQ(scene.materials.at(0).doubleSided, both);
    }
}

/// A file with one triangle, textured through a sampler, that `breakIt` has spoilt is refused with these parts.
void expectRefused(const std::function<void(nlohmann::json&)>& breakIt,
                   const std::initializer_list<std::string>& parts) {
    GltfBuilder file;
    file.triangle().primitive()["material"] = 0;
    file.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9729}}};
    file.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.json["materials"] = {
        {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.load();
    breakIt(file.json);
    file.expectRefused(parts);
}

TEST(GltfRules, ModesThatAreNoneAreRefused) {
    expectRefused([](auto& f) { f["materials"][0]["alphaMode"] = "FOO"; },
                  {"/materials/0/alphaMode", "\"FOO\"", "MASK"});
    expectRefused([](auto& f) { f["samplers"][0]["wrapS"] = 5; }, {"/samplers/0/wrapS", "10497", "found 5"});
    expectRefused([](auto& f) { f["samplers"][0]["wrapT"] = 0; }, {"/samplers/0/wrapT", "found 0"});
    expectRefused([](auto& f) { f["samplers"][0]["magFilter"] = 9984; }, {"/samplers/0/magFilter", "found 9984"});
}

TEST(GltfRules, CamerasOutOfRangeAreWarnedOf) {
    GltfBuilder file;
    file.triangle();
    file.json["cameras"] = {
        {{"type", "perspective"}, {"perspective", {{"yfov", -1}, {"znear", 0.1}}}},
        {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 0}, {"znear", 0.1}, {"zfar", 10}}}},
        {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
    file.json["nodes"] = {{{"mesh", 0}}, {{"camera", 0}}, {{"camera", 1}}, {{"camera", 2}}};
    file.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
    MessageLog log;
    const Scene scene = file.load(log);
    EXPECT_FLOAT_EQ(scene.cameras.at(0).camera.fovYDeg, 1);
    EXPECT_FLOAT_EQ(scene.cameras.at(2).camera.fovYDeg, degrees(0.5f));
    ASSERT_EQ(log.warnings().size(), 2u);
    EXPECT_EQ(log.warnings()[0], "test.glb: /cameras/0/perspective/yfov: -1 is out of range; 0.01745 is taken");
    EXPECT_EQ(log.warnings()[1], "test.glb: /cameras/1/orthographic/ymag: 0 is out of range; 0.0001 is taken");
}

/// A .gltf of one triangle whose buffer is this data URI.
std::string withBuffer(const std::string& uri) {
    nlohmann::json file = {
        {"asset", {{"version", "2.0"}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
        {"buffers", {{{"byteLength", 36}, {"uri", uri}}}}};
    return file.dump();
}

TEST(GltfRules, DataWithoutAKindAreBytes) {
    const test::TemporaryFolder folder;
    MessageLog log;
    for (const char* kind : {"", "application/octet-stream", "model/gltf-buffer", "text/plain;charset=US-ASCII"}) {
        writeFileAtomically(folder / "a.gltf",
                            withBuffer("data:" + std::string(kind) + ";base64," + std::string(48, 'A')));
        EXPECT_EQ(loadGltf(folder / "a.gltf", log).triangleCount(), 1) << kind;
    }
    writeFileAtomically(folder / "a.gltf", withBuffer("DATA:Application/Octet-Stream;BASE64," + std::string(48, 'A')));
    EXPECT_EQ(loadGltf(folder / "a.gltf", log).triangleCount(), 1);
    writeFileAtomically(folder / "a.gltf", withBuffer("data:text/plain," + std::string(500, 'A')));
    const std::string shown = "\"data:text/plain," + std::string(24, 'A') + "...\"";
    test::expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "a.gltf", log); },
                      {"a.gltf", "a buffer has an unsupported kind of data URI, " + shown});

    GltfBuilder file;
    file.triangle().primitive()["material"] = 0;
    file.json["images"] = {{{"uri", "data:text/plain," + std::string(500, 'A')}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    file.primitive()["attributes"]["TEXCOORD_0"] = file.floats({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    file.load(log);
    ASSERT_EQ(log.warnings().size(), 1u);
    EXPECT_NE(log.warnings()[0].find("an unsupported kind of data URI, " + shown), std::string::npos);
}

TEST(GltfRules, BytesThatAreNoTextAreShownAsNumbers) {
    const test::TemporaryFolder folder;
    writeFileAtomically(folder / "a.gltf", std::string_view("{\"asset\": {\"generator\": \"B\xe4ume\"}}"));
    MessageLog log;
    test::expectError(ErrorKind::BadInput, [&] { loadGltf(folder / "a.gltf", log); },
                      {"a.gltf:1:28", "ill-formed UTF-8", "\\xe4"});
}

/// Primitives of 100,000 triangles over the same indices.
GltfBuilder& sharing(GltfBuilder& file, int primitives) {
    file.triangle();
    const int indices = file.accessor(std::vector<uint8_t>(300000, 0), "SCALAR", 1, 5121);
    file.primitive()["indices"] = indices;
    const nlohmann::json primitive = file.primitive();
    for (int i = 1; i < primitives; ++i) file.json["meshes"][0]["primitives"].push_back(primitive);
    return file;
}

TEST(GltfRules, SharedIndicesAreCountedBeforeTheyAreRead) {
    GltfBuilder many, few;
    sharing(many, 100).expectRefused({"/meshes/0/primitives/", "absurd count of triangles", "and 100000 here"});
    EXPECT_EQ(sharing(few, 20).load().triangleCount(), 2000000);
    const test::MemoryLimit limit(uint64_t(16) << 20);
    few.expectRefused({"the geometry of test.glb needs 30.5 MiB", "memory limit"}, ErrorKind::Resources);
}

/// The file with 100,000 such values beside its version.
GltfBuilder& withExtras(GltfBuilder& file, const nlohmann::json& value) {
    file.triangle().json["asset"]["extensions"] = nlohmann::json::object();
    file.json["asset"]["extras"] = std::vector<nlohmann::json>(100000, value);
    return file;
}

TEST(GltfRules, TheTreeOfTheJsonCountsAgainstTheMemoryLimit) {
    GltfBuilder numbers, objects, strings, small;
    EXPECT_EQ(withExtras(numbers, 1).load().triangleCount(), 1);
    withExtras(objects, {{"a", 1}}), withExtras(strings, "text");
    const test::MemoryLimit limit(uint64_t(4) << 20);
    EXPECT_EQ(small.triangle().load().triangleCount(), 1);
    for (const GltfBuilder* file : {&numbers, &objects, &strings})
        file->expectRefused({"the JSON of test.glb needs ", "memory limit"}, ErrorKind::Resources);
}

}  // namespace
}  // namespace lumi

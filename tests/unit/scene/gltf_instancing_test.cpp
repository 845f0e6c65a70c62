// EXT_mesh_gpu_instancing.
#include <gtest/gtest.h>

#include "gltf_support.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

using test::GltfBuilder;

void expectNear(const Vec3& a, const Vec3& b, float tolerance = 1e-5f) {
    EXPECT_LT(glm::length(a - b), tolerance) << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(GltfInstancing, PlacesTheMeshOfItsNode) {
    GltfBuilder file;
    file.triangle();
    const int t = file.floats({1, 0, 0, 0, 5, 0}, "VEC3", 3);
    const int r = file.accessor<int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", 4, 5120);
    file.json["accessors"][static_cast<size_t>(r)]["normalized"] = true;
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", t},
                                                                                    {"ROTATION", r}};
    file.json["nodes"][0]["translation"] = {0, 0, 3};
    const auto scene = std::make_shared<Scene>(file.load());
    ASSERT_EQ(scene->instances.size(), 2u);
    const auto posed = poseScene(scene, {});
    expectNear(transformPoint(posed->instances[0].worldFromObject, {1, 0, 0}), {2, 0, 3});
    expectNear(transformPoint(posed->instances[1].worldFromObject, {1, 0, 0}), {-1, 5, 3});
}

TEST(GltfInstancing, InstancesMorphAsTheirNodeDoes) {
    GltfBuilder file;
    file.triangle();
    file.primitive()["targets"] = {{{"POSITION", file.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3)}}};
    const int places = file.floats({1, 0, 0, 0, 5, 0}, "VEC3", 3);
    file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    const int times = file.floats({0, 2}, "SCALAR", 1), weights = file.floats({0, 1}, "SCALAR", 1);
    file.json["animations"] = {{{"samplers", {{{"input", times}, {"output", weights}}}},
                                {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}};
    const auto posed = poseScene(std::make_shared<Scene>(file.load()), {.open = 1, .close = 1, .previousOpen = 0});
    ASSERT_EQ(posed->instances.size(), 2u);
    for (const PosedInstance& instance : posed->instances) {
        expectNear(instance.deformed->positions[0], {0, 0, 0.5f});
        expectNear(instance.deformedPrevious()->positions[0], {0, 0, 0});
    }
    EXPECT_EQ(posed->instances[0].deformed, posed->instances[1].deformed);
}

TEST(GltfInstancing, InstancesAreAsManyAsAnyAttributeHas) {
    GltfBuilder file;
    file.triangle();
    const int ids = file.floats({7, 8, 9}, "SCALAR", 1), places = file.floats({1, 0, 0, 0, 5, 0}, "VEC3", 3);
    nlohmann::json& attributes = file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes["_ID"] = ids;
    EXPECT_EQ(file.load().instances.size(), 3u);
    attributes["TRANSLATION"] = places;
    file.expectRefused({"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/_ID", "another count", "3", "2"});
    attributes = {{"TRANSLATION", 99}};
    file.expectRefused({"/attributes/TRANSLATION", "no such entry in /accessors", "99"});
    for (const nlohmann::json& id : {nlohmann::json(99), nlohmann::json(), nlohmann::json("x")}) {
        attributes = {{"TRANSLATION", places}, {"_ID", id}};
        MessageLog log;
        EXPECT_EQ(file.load(log).instances.size(), 2u) << id;
        EXPECT_EQ(log.warnings().size(), 1u);
    }
    attributes = nlohmann::json::object();
    file.expectRefused({"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes", "names no accessor"});
}

}  // namespace
}  // namespace lumi

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.h"
#include "scene/defaults.h"
#include "scene/gltf/load_gltf.h"
#include "scene/obj/load_obj.h"
#include "scene/posed_scene.h"

namespace lumi {
namespace {

std::filesystem::path assets() {
    if (const char* folder = std::getenv("LUMISCOPE_ASSETS")) return folder;
    return std::filesystem::path(LUMISCOPE_SOURCE_DIR) / "../shared/assets";
}

Scene load(const std::string& file) {
    MessageLog log;
    return loadGltf(assets() / "gltf" / file, log);
}

class GltfAssets : public testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::is_directory(assets() / "gltf")) GTEST_SKIP() << "no shared assets at " << assets();
    }
};

TEST_F(GltfAssets, TriangleCountsAreThoseOfTheIndex) {
    const std::pair<const char*, int64_t> expected[] = {
        {"AlphaBlendModeTest/AlphaBlendModeTest.glb", 61},
        {"BitterliCoffee/coffee.gltf", 235176},
        {"Box With Spaces/Box With Spaces.gltf", 12},
        {"BoxInterleaved/BoxInterleaved.glb", 12},
        {"CesiumMan/CesiumMan.glb", 4672},
        {"CornellBoxMitsuba/cbox.glb", 38},
        {"DamagedHelmet/DamagedHelmet.glb", 15452},
        {"Duck/glTF-Embedded/Duck.gltf", 4212},
        {"Duck/glTF-Quantized/Duck.gltf", 4212},
        {"LightsPunctualLamp/LightsPunctualLamp.gltf", 6000},
        {"MeshPrimitiveModes/MeshPrimitiveModes.gltf", 16},
        {"MorphPrimitivesTest/MorphPrimitivesTest.glb", 32},
        {"MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb", 1040409},
        {"NegativeScaleTest/NegativeScaleTest.glb", 7724},
        {"SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf", 12},
        {"TransmissionTest/TransmissionTest.glb", 128775},
        {"VeachMIS/veach_mis.glb", 3854}};
    for (const auto& [file, triangles] : expected) EXPECT_EQ(load(file).triangleCount(), triangles) << file;
    // 125 instances of a cube; the index counts the mesh once.
    EXPECT_EQ(load("SimpleInstancing/SimpleInstancing.glb").triangleCount(), 125 * 12);
}

TEST_F(GltfAssets, SponzaAndKitchenAreWhole) {
    const Scene sponza = load("Sponza/Sponza.gltf");
    EXPECT_EQ(sponza.triangleCount(), 262205);
    EXPECT_EQ(sponza.instances.size(), 391u);
    EXPECT_EQ(sponza.materials.size(), 25u);
    const Camera camera = defaultCamera(sponza);
    EXPECT_LT(glm::distance(camera.eye, sponza.restBounds().centre()), 1e-3f) << "one stands inside";
    EXPECT_GT(camera.target.x, 10);
    const Scene kitchen = load("BitterliKitchen/kitchen.gltf");
    EXPECT_EQ(kitchen.triangleCount(), 1443307);
    EXPECT_EQ(kitchen.cameras.size(), 1u);
}

TEST_F(GltfAssets, AnimationStaysInTheDefaultPicture) {
    for (const char* file : {"AnimatedTriangle/glTF/AnimatedTriangle.gltf", "BoxAnimated/glTF/BoxAnimated.gltf",
                             "SimpleSkin/glTF/SimpleSkin.gltf", "CesiumMan/CesiumMan.glb"}) {
        const auto scene = std::make_shared<const Scene>(load(file));
        const CameraPose camera = poseCamera(defaultCamera(*scene), {100, 100});
        float widest = 0;
        for (int i = 0; i <= 40; ++i) {
            const auto posed = poseScene(scene, {scene->duration() * static_cast<float>(i) / 40});
            for (size_t k = 0; k < posed->instances.size(); ++k) {
                const PosedInstance& pose = posed->instances[k];
                for (const Vec3& p :
                     pose.deformed ? pose.deformed->positions : posed->mesh(static_cast<uint32_t>(k)).positions) {
                    const Vec3 pixel = camera.project(transformPoint(pose.worldFromObject, p));
                    widest = std::max({widest, std::abs(pixel.x - 50), std::abs(pixel.y - 50)});
                }
            }
        }
        EXPECT_LT(widest, 50) << file;
        EXPECT_GT(widest, 25) << file;
    }
}

/// Every file opens without a warning about damage, and its first moments can be posed.
TEST_F(GltfAssets, AllOpen) {
    int opened = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(assets() / "gltf")) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".gltf" && extension != ".glb") continue;
        const std::string name = entry.path().string();
        if (name.find("Sponza") != name.npos || name.find("Kitchen") != name.npos) continue;
        MessageLog log;
        try {
            const auto scene = std::make_shared<const Scene>(loadGltf(entry.path(), log));
            EXPECT_GT(scene->triangleCount(), 0) << name;
            const float time = 0.3f * scene->duration();
            const auto posed = poseScene(scene, {.open = time, .close = time, .previousOpen = 0});
            EXPECT_TRUE(isFinite(posed->bounds.lower) && isFinite(posed->bounds.upper)) << name;
            EXPECT_EQ(posed->anythingMoves, time > 0) << name;
            for (const std::string& warning : log.warnings())
                EXPECT_EQ(warning.find("stand-in"), warning.npos) << warning;
            ++opened;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("requires the extension"), std::string::npos) << error.what();
        }
    }
    EXPECT_GE(opened, 60);
}

TEST_F(GltfAssets, AnimationsStopAndGo) {
    const auto man = std::make_shared<const Scene>(load("CesiumMan/CesiumMan.glb"));
    ASSERT_EQ(man->skins.size(), 1u);
    EXPECT_EQ(man->skins[0].joints.size(), 19u);
    const auto posed = poseScene(man, {.open = 0.5f, .close = 0.5f, .previousOpen = 0.48f});
    // He stands on the ground, a man's height.
    EXPECT_NEAR(posed->bounds.size().y, 1.5f, 0.1f);
    const Scene still = load("DamagedHelmet/DamagedHelmet.glb");
    EXPECT_FALSE(still.isAnimated());
}

TEST_F(GltfAssets, ObjFilesOpen) {
    MessageLog log;
    const Scene spot = loadObj(assets() / "subdiv/spot/spot_triangulated.obj", log);
    EXPECT_EQ(spot.triangleCount(), 5856);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(assets() / "subdiv")) {
        if (entry.path().extension() != ".obj") continue;
        EXPECT_GT(loadObj(entry.path(), log).triangleCount(), 0) << entry.path();
    }
}

}  // namespace
}  // namespace lumi

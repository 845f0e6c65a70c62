// Damaged files: every loader either succeeds or says in one line, as an Error, what is wrong; it never crashes, never
// takes long, and never lets another exception out. $LUMISCOPE_MUTATIONS sets the number of cases (default 600).
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "image/exr.h"
#include "image/hdr.h"
#include "image/png.h"
#include "robustness/good_files.h"
#include "robustness/mutate.h"
#include "robustness/trace_few.h"
#include "scene/load.h"
#include "unit/scene/compressed_gltf.h"

namespace lumi {
namespace {
namespace fs = std::filesystem;

int caseCount() {
    const char* text = std::getenv("LUMISCOPE_MUTATIONS");
    return text ? std::atoi(text) : 600;
}

fs::path assets() {
    const char* folder = std::getenv("LUMISCOPE_ASSETS");
    return folder ? folder : LUMISCOPE_SOURCE_DIR "/../shared/assets";
}

/// A folder of its own for each test, gone afterwards.
class Robustness : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("lumiscope-robustness-" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& bytes) {
        writeFileAtomically(folder_ / name, std::string_view(bytes));
    }
    /// Loads `bytes` as a file of that name, or `opened`, which names it, with everything a session does to a scene:
    /// load, pose and trace.
    void tryScene(const std::string& name, const std::string& bytes, uint64_t seed, const std::string& opened = "") {
        const fs::path path = folder_ / (opened.empty() ? name : opened);
        write(name, bytes);
        const std::clock_t start = std::clock();
        try {
            MessageLog log;
            const auto scene = loadScene(path, log);
            traceAFew(scene);
            ++accepted_;
        } catch (const Error& error) {
            ++refused_;
            const std::string text = error.what();
            EXPECT_FALSE(text.empty()) << name << " seed " << seed;
            EXPECT_EQ(text.find('\n'), std::string::npos) << name << " seed " << seed << ": " << text;
            EXPECT_TRUE(error.kind() == ErrorKind::BadInput || error.kind() == ErrorKind::Resources)
                << name << " seed " << seed << ": " << text;
        } catch (const std::exception& other) {
            ADD_FAILURE() << name << " seed " << seed << " let out: " << other.what();
        }
        // The process's own time, whatever else runs.
        EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10) << name << " seed " << seed;
    }
    /// $LUMISCOPE_SEEDS names a folder that gets the good files, as a corpus for the fuzz targets.
    void mutateScene(const std::string& name, const std::string& good, bool isText, uint64_t base,
                     const std::string& opened = "") {
        if (const char* seeds = std::getenv("LUMISCOPE_SEEDS"))
            writeFileAtomically(fs::path(seeds) / (std::to_string(base) + "-" + name), std::string_view(good));
        tryScene(name, good, 0, opened);
        ASSERT_EQ(accepted_, 1) << "the file is refused before it is damaged";
        for (int i = 0; i < caseCount(); ++i) {
            const uint64_t seed = base + static_cast<uint64_t>(i);
            tryScene(name, Mutator(seed).mutate(good, isText), seed, opened);
        }
        // Damage is found often, but for files that others name, and not everything is damage.
        if (opened.empty()) {
            EXPECT_GT(refused_, caseCount() / 20);
        }
        EXPECT_GT(accepted_, caseCount() / 100);
    }
    fs::path folder_;
    int accepted_ = 0, refused_ = 0;
};

std::string assetBytes(const std::string& name) {
    const std::vector<uint8_t> bytes = readFile(assets() / name);
    return {bytes.begin(), bytes.end()};
}

#define REQUIRE_ASSETS() \
    if (!fs::exists(assets())) GTEST_SKIP() << "the test assets " << assets() << " are not here"

TEST_F(Robustness, SceneFiles) {
    mutateScene("scene.json", readTextFile(fs::path(LUMISCOPE_SOURCE_DIR) / "scenes" / "cornell.json"), true, 1000000);
}
TEST_F(Robustness, ObjFiles) {
    mutateScene("mesh.obj",
                "# a cube's corner\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n"
                "usemtl red\nf 1/1/1 2/2/1 3/3/1 4/1/1\nf 1 2 5\ns 1\no part\nf -1 -2 -3\n",
                true, 2000000);
}
TEST_F(Robustness, EmbeddedGltf) {
    REQUIRE_ASSETS();
    mutateScene("skin.gltf", assetBytes("gltf/SimpleSkin/glTF-Embedded/SimpleSkin.gltf"), true, 3000000);
}
TEST_F(Robustness, SparseGltf) {
    REQUIRE_ASSETS();
    mutateScene("sparse.gltf", assetBytes("gltf/SimpleSparseAccessor/glTF-Embedded/SimpleSparseAccessor.gltf"), true,
                4000000);
}
TEST_F(Robustness, BinaryGltf) {
    REQUIRE_ASSETS();
    mutateScene("box.glb", assetBytes("gltf/BoxAnimated/glTF-Binary/BoxAnimated.glb"), false, 5000000);
}
std::string glbBytes(const test::GltfBuilder& file) {
    const std::vector<uint8_t> bytes = file.glb();
    return {bytes.begin(), bytes.end()};
}

TEST_F(Robustness, DracoMeshes) {
    const test::Sheet sheet(5);
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        accepted_ = refused_ = 0;
        test::GltfBuilder file;
        test::addDraco(file, test::encodeDraco(sheet, method), sheet.indices.size());
        mutateScene("draco.glb", glbBytes(file), false, 9000000 + 500000 * static_cast<uint64_t>(method));
    }
}
TEST_F(Robustness, MeshoptViews) {
    for (const bool sequence : {false, true}) {
        accepted_ = refused_ = 0;
        test::GltfBuilder file;
        test::addMeshopt(file, test::Sheet(5), sequence);
        mutateScene("meshopt.glb", glbBytes(file), false, 10000000 + (sequence ? 500000 : 0));
    }
}
TEST_F(Robustness, ImagesOfOtherFormats) {
    test::GltfBuilder file;
    test::addForeignTextures(file);
    mutateScene("images.glb", glbBytes(file), false, 11000000);
}
TEST_F(Robustness, GltfWithAllThatIsShaded) {
    test::GltfBuilder file;
    test::addAllThatIsShaded(file);
    mutateScene("rich.gltf", test::asText(file), true, 12000000);
    accepted_ = refused_ = 0;
    mutateScene("rich.glb", glbBytes(file), false, 12500000);
}
TEST_F(Robustness, MaterialsOfObjFiles) {
    const std::vector<uint8_t> picture = test::smallPng(120);
    write("map.png", {picture.begin(), picture.end()});
    write("mesh.mtl", test::kMaterials);
    mutateScene("mesh.obj", test::kObjWithMaterials, true, 13000000);
    accepted_ = refused_ = 0;
    write("mesh.obj", test::kObjWithMaterials);
    mutateScene("mesh.mtl", test::kMaterials, true, 13500000, "mesh.obj");
}
TEST_F(Robustness, Cages) {
    write("scene.json", test::kCageScene);
    mutateScene("cage.obj", test::kCage, true, 14000000, "scene.json");
}
/// Good files of very many things: what they take to open grows with them, not with their square.
TEST_F(Robustness, VeryManyThingsOfAKind) {
    using nlohmann::json;
    test::GltfBuilder cameras;
    cameras.triangle();
    const int times = cameras.floats({0, 1}, "SCALAR", 1), values = cameras.floats({0, 0, 0, 0, 0, 0}, "VEC3", 3);
    cameras.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}}};
    cameras.json["animations"] = {{{"samplers", {{{"input", times}, {"output", values}}}}}};
    constexpr int kCameras = 8000;
    for (int i = 0; i < kCameras; ++i) {
        cameras.json["nodes"][static_cast<size_t>(i)] = {{"camera", 0}, {"children", {i + 1}}};
        cameras.json["animations"][0]["channels"].push_back(
            {{"sampler", 0}, {"target", {{"node", i}, {"path", "translation"}}}});
    }
    cameras.json["nodes"].push_back({{"mesh", 0}});
    tryScene("cameras.gltf", test::asText(cameras), 0);

    test::GltfBuilder primitives;
    primitives.triangle();
    const json good = primitives.primitive();
    constexpr int kPrimitives = 60000;
    for (int i = 0; i < kPrimitives; ++i) {
        json other = good;
        other["attributes"]["_" + std::to_string(i)] = 0;
        primitives.json["meshes"][0]["primitives"].push_back(std::move(other));
    }
    tryScene("primitives.gltf", test::asText(primitives), 0);
    EXPECT_EQ(accepted_, 2);
}
/// Opening them alone: a frame looks at every joint of every instance.
TEST_F(Robustness, VeryManyInstancesOfOneSkin) {
    test::GltfBuilder file;
    test::addAllThatIsShaded(file);
    constexpr int kEach = 12000;
    for (int i = 0; i < 2 * kEach; ++i) {
        const auto node = static_cast<int>(file.json["nodes"].size());
        file.json["nodes"].push_back(i < kEach ? nlohmann::json::object() : nlohmann::json{{"mesh", 0}, {"skin", 0}});
        if (i < kEach) file.json["skins"][0]["joints"].push_back(node);
        file.json["scenes"][0]["nodes"].push_back(node);
    }
    write("skinned.gltf", test::asText(file));
    const std::clock_t start = std::clock();
    MessageLog log;
    EXPECT_GT(loadScene(folder_ / "skinned.gltf", log)->instances.size(), size_t(kEach));
    EXPECT_LT(static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, 10);
}
/// Each file in turn is taken away, or becomes a folder, when loading tells of its first step, its second and so on.
TEST_F(Robustness, FilesThatVanishWhileLoading) {
    test::GltfBuilder rich;
    test::addAllThatIsShaded(rich);
    const std::vector<uint8_t> picture = test::smallPng(120);
    rich.json["images"][1] = {{"uri", "map.png"}};
    rich.json["buffers"] = {{{"byteLength", rich.bin.size()}, {"uri", "rich.bin"}}};
    const std::pair<std::string, std::string> files[] = {{"rich.gltf", rich.json.dump()},
                                                         {"rich.bin", {rich.bin.begin(), rich.bin.end()}},
                                                         {"map.png", {picture.begin(), picture.end()}},
                                                         {"mesh.obj", test::kObjWithMaterials},
                                                         {"mesh.mtl", test::kMaterials},
                                                         {"cage.obj", test::kCage},
                                                         {"scene.json", test::kCageScene}};
    for (const std::string opened : {"rich.gltf", "mesh.obj", "scene.json"})
        for (const auto& [victim, content] : files)
            for (int step = 0; step < 12; ++step) {
                for (const auto& [name, bytes] : files) {
                    if (fs::is_directory(folder_ / name)) fs::remove(folder_ / name);
                    write(name, bytes);
                }
                LoadOptions options;
                std::atomic<int> steps{0};
                options.progress = [&](float, const std::string&) {
                    if (steps++ != step) return;
                    fs::remove(folder_ / victim);
                    if (step % 2) fs::create_directory(folder_ / victim);
                };
                try {
                    MessageLog log;
                    traceAFew(loadScene(folder_ / opened, log, options));
                    ++accepted_;
                } catch (const Error& error) {
                    EXPECT_EQ(error.kind(), ErrorKind::BadInput)
                        << opened << " without " << victim << ": " << error.what();
                    ++refused_;
                }
            }
    EXPECT_GT(refused_, 5);
    EXPECT_GT(accepted_, 100);
}
TEST_F(Robustness, RadianceSkies) {
    std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
    for (int i = 0; i < 32; ++i) hdr += std::string("\x40\x50\x60\x80", 4);
    mutateScene("sky.hdr", hdr, false, 6000000);
}
TEST_F(Robustness, ExrSkies) {
    Image image({16, 8}, 3);
    image.fill(0.5f);
    ExrLayers layers;
    layers.add("", "RGB", image);
    const std::vector<uint8_t> bytes = encodeExr(layers);
    mutateScene("sky.exr", std::string(bytes.begin(), bytes.end()), false, 7000000);
}
TEST_F(Robustness, PngFiles) {
    Image8 picture{{16, 8}, std::vector<uint8_t>(16 * 8 * 4, 77)};
    const std::vector<uint8_t> good = encodePng(picture, {{kStateKey, "{}"}});
    for (int i = 0; i < caseCount(); ++i) {
        const std::string bytes =
            Mutator(8000000u + static_cast<uint64_t>(i)).mutate({good.begin(), good.end()}, false);
        try {
            decodePng(std::span(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()), "damaged.png");
        } catch (const Error&) {
            ++refused_;
        }
    }
    EXPECT_GT(refused_, caseCount() / 20);
}

}  // namespace
}  // namespace lumi

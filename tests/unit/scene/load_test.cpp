#include "scene/load.h"
#include "scene/asset_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <thread>

#include "base/files.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {
namespace fs = std::filesystem;

/// Sets $LUMISCOPE_SCENES while it lives.
class ScenesVariable {
public:
    explicit ScenesVariable(const std::string& value) { setenv("LUMISCOPE_SCENES", value.c_str(), 1); }
    ~ScenesVariable() { unsetenv("LUMISCOPE_SCENES"); }
};

/// A 2x1 Radiance file, flat scanlines: white and black.
std::string tinyHdr() {
    return std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
           std::string("\x80\x80\x80\x81\0\0\0\0", 8);
}

TEST(LoadScene, UnknownKindsAreNamed) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.txt", std::string_view("x"));
    MessageLog log;
    expectError(ErrorKind::BadInput, [&] { loadScene(folder / "a.txt", log); },
                {"unknown kind of scene; expected .json, .gltf, .glb, .obj, .hdr or .exr, found .txt"});
    expectError(ErrorKind::BadInput, [&] { loadScene(folder.path(), log); }, {"is a directory"});
    for (const char* name : {"no.json", "no.gltf", "no.glb", "no.obj", "no.hdr", "no.exr", "no.txt"})
        expectError(ErrorKind::BadInput, [&] { loadScene(folder / name, log); }, {name, "no such file"});
    fs::create_directory(folder / "d.json");
    expectError(ErrorKind::BadInput, [&] { loadScene(folder / "d.json", log); }, {"d.json: is a directory"});
}

TEST(LoadScene, OnlyGltfHasScenesVariantsAndAnimations) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "a.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    MessageLog log;
    LoadOptions scene, variant, animation;
    scene.choice.index = 7, variant.choice.variant = "red", animation.choice.animation = "run";
    expectError(ErrorKind::Usage, [&] { loadScene(folder / "a.obj", log, scene); }, {"one scene", "scene.index", "7"});
    expectError(ErrorKind::Usage, [&] { loadScene(folder / "a.obj", log, variant); },
                {"variants", "scene.variant", "red"});
    expectError(ErrorKind::Usage, [&] { loadScene(folder / "a.obj", log, animation); },
                {"animations", "scene.animation", "run"});
    EXPECT_NE(loadScene(folder / "a.obj", log), nullptr);
}

TEST(LoadScene, BrokenFilesSayWhereAndWhy) {
    const std::array<std::pair<const char*, const char*>, 6> faults{{
        {"truncated.json", "truncated.json:4:49: string without closing quote"},
        {"unknown_key.json", "unknown_key.json:4:31: unknown key \"rougness\"; expected \"roughness\""},
        {"out_of_range.json", "out_of_range.json:4:37: \"segments\" is 100000; expected 3 to 4096"},
        {"missing_asset.json", "missing_asset.json:3:31: asset \"hall\": "},
        {"cycle.json", "cycle.json:4:29: instance \"a\" is its own ancestor"},
        {"directory_as_sky.json", "directory_as_sky.json:3:27: \"environment\": "},
    }};
    for (const auto& [name, message] : faults) {
        MessageLog log;
        const fs::path path = fs::path(LUMISCOPE_SOURCE_DIR) / "tests/data/scenes" / name;
        expectError(ErrorKind::BadInput, [&] { loadScene(path, log); }, {message});
    }
}

TEST(LoadScene, StretchedSphereLightsAreNamed) {
    TemporaryFolder folder;
    const auto warningsOf = [&](const std::string& kind, const std::string& scale) {
        writeFileAtomically(folder / "lamps.json", std::string_view(R"({"version": 1,
            "assets": {"ball": {"sphere": {"radius": 1}}}, "materials": {"m": {}},
            "instances": [{"asset": "ball", "material": "m"}, {"name": "group", "scale": )" +
                                                                    scale + R"(}],
            "lights": {"lamp": {)" + kind + R"(, "radiance": [1, 1, 1], "parent": "group"}}})"));
        MessageLog log;
        loadScene(folder / "lamps.json", log);
        return log.warnings();
    };
    const std::string sphere = R"("sphere": {"radius": 0.5})";
    const std::vector<std::string> warnings = warningsOf(sphere, "[3, 1, 1]");
    ASSERT_EQ(warnings.size(), 1u);
    for (const char* part : {"lamps.json", "\"lamp\"", "3 x 1 x 1", "same area", "radius 0.78"})
        EXPECT_NE(warnings[0].find(part), std::string::npos) << warnings[0];
    EXPECT_TRUE(warningsOf(sphere, "[1, 1.005, 1]").empty());
    EXPECT_TRUE(warningsOf(sphere, "[2, 2, 2]").empty());
    EXPECT_TRUE(warningsOf(R"("disk": {"radius": 0.5})", "[3, 1, 1]").empty()) << "shown as the ellipse that it is";
}

TEST(LoadScene, ScenesWhereNumbersAreCoarseAreNamed) {
    TemporaryFolder folder;
    const auto warningsAt = [&](const char* distance, const char* size) {
        writeFileAtomically(folder / "far.json",
                            std::string(R"({"version": 1, "assets": {"b": {"box": {"size": [)") + size + ", 1, 1" +
                                R"(]}}}, "instances": [{"name": "b", "asset": "b", "translate": [)" + distance +
                                R"(, 0, 0]}], "environment": {"constant": [1, 1, 1]},
                                "cameras": {"main": {"eye": [0, 0, 4], "look-at": [0, 0, 0]}}})");
        MessageLog log;
        loadScene(folder / "far.json", log);
        return log.warnings();
    };
    const auto loadedAtScale = [&](const char* scale) {
        writeFileAtomically(folder / "small.json",
                            std::string(R"({"version": 1, "assets": {"b": {"box": {"size": [1, 1, 1]}}}, "instances":
                                [{"name": "b", "asset": "b", "scale": )") +
                                scale + R"(}], "environment": {"constant": [1, 1, 1]},
                                "cameras": {"main": {"eye": [0, 0, 4], "look-at": [0, 0, 0]}}})");
        MessageLog log;
        loadScene(folder / "small.json", log);
        return log.warnings();
    };
    EXPECT_TRUE(warningsAt("0", "1").empty());
    EXPECT_TRUE(warningsAt("20", "1").empty());
    EXPECT_TRUE(warningsAt("-5000", "10000").empty()) << "coarse, but beside its size it is not";
    EXPECT_TRUE(loadedAtScale("0.01").empty());
    const std::vector<std::string> small = loadedAtScale("0.001");
    ASSERT_EQ(small.size(), 1u);
    EXPECT_NE(small[0].find("is 0.0017 m in size: rays may start 1.5e-05 m off"), std::string::npos) << small[0];
    const std::vector<std::string> told = warningsAt("-100000", "1");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].find("far.json: lies 1e+05 m from the origin"), 0u) << told[0];
    EXPECT_NE(told[0].find("start 2 m off"), std::string::npos) << told[0];
}

TEST(LoadScene, OurOwnFilesStayDarkButGetACamera) {
    TemporaryFolder folder;
    writeFileAtomically(
        folder / "s.json",
        std::string_view(R"({"version": 1, "assets": {"b": {"box": {}}}, "instances": [{"asset": "b"}]})"));
    MessageLog log;
    const auto scene = loadScene(folder / "s.json", log);
    EXPECT_FALSE(scene->environment.visible());
    EXPECT_TRUE(log.warnings().empty());
    ASSERT_EQ(scene->cameras.size(), 1u);
    EXPECT_EQ(scene->cameras[0].camera.name, "default");
    EXPECT_EQ(scene->path, (folder / "s.json").string());
}

TEST(LoadScene, FilesAreSoughtBesideTheSceneFile) {
    TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    writeFileAtomically(folder / "sub/sky.hdr", tinyHdr());
    writeFileAtomically(folder / "s.json",
                        std::string_view(R"({"version": 1, "environment": {"file": "sub/sky.hdr"}})"));
    MessageLog log;
    const auto scene = loadScene(folder / "s.json", log);
    ASSERT_NE(scene->environment.image, nullptr);
    EXPECT_EQ(scene->environment.image->width(), 2);
    EXPECT_EQ(scene->environment.image->at(0, 0, 0), 1);

    const std::string digestBefore = scene->contentDigest;
    std::string changed = tinyHdr();
    changed.back() = 1;
    writeFileAtomically(folder / "sub/sky.hdr", changed);
    EXPECT_NE(loadScene(folder / "s.json", log)->contentDigest, digestBefore);
}

TEST(LoadScene, AnEnvironmentMapLightsMaterialBalls) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "dusk.hdr", tinyHdr());
    MessageLog log;
    const auto scene = loadScene(folder / "dusk.hdr", log);
    EXPECT_EQ(scene->title, "Material balls under dusk.hdr");
    EXPECT_EQ(scene->instances.size(), 4u);
    EXPECT_EQ(scene->environment.image->height(), 1);
    EXPECT_TRUE(log.warnings().empty());
    writeFileAtomically(folder / "broken.hdr", std::string_view("#?RADIANCE\n"));
    expectError(ErrorKind::BadInput, [&] { loadScene(folder / "broken.hdr", log); }, {"broken.hdr"});
}

TEST(LoadScene, ReportsItsProgressUpToTheEnd) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "s.json", std::string_view(R"({"version": 1})"));
    float last = -1;
    LoadOptions options;
    options.progress = [&](float fraction, const std::string&) {
        EXPECT_GE(fraction, last);
        last = fraction;
    };
    MessageLog log;
    loadScene(folder / "s.json", log, options);
    EXPECT_EQ(last, 1);
}

TEST(LoadScene, AnyThreadCountGivesTheSameScene) {
    MessageLog log;
    TemporaryFolder folder;
    writeFileAtomically(folder / "s.json", std::string_view(R"({"version": 1,
        "assets": {"a": {"hairball": {"strands": 500}}, "b": {"torus": {}}}, "instances": [{"asset": "a"}, {"asset": "b"}]})"));
    const auto one = loadScene(folder / "s.json", log), two = loadScene(folder / "s.json", log);
    ASSERT_EQ(one->instances.size(), two->instances.size());
    for (size_t i = 0; i < one->instances.size(); ++i)
        EXPECT_TRUE(one->instances[i].mesh->positions == two->instances[i].mesh->positions);
    EXPECT_EQ(one->contentDigest, two->contentDigest);
}

TEST(FindScene, TakesPathsAsTheyAre) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "x.json", std::string_view("{}"));
    EXPECT_EQ(findScene((folder / "x.json").string()), folder / "x.json");
    expectError(ErrorKind::BadInput, [&] { findScene((folder / "y.json").string()); }, {"y.json: no such file"});
    expectError(ErrorKind::BadInput, [&] { findScene(folder.path().string()); }, {"is a directory"});
    expectError(ErrorKind::BadInput, [] { findScene("y.glb"); }, {"y.glb: no such file"});
    ASSERT_EQ(mkfifo((folder / "pipe.gltf").c_str(), 0600), 0);
    std::filesystem::create_symlink("/dev/zero", folder / "link.glb");
    for (const char* name : {"pipe.gltf", "link.glb"})
        expectError(ErrorKind::BadInput, [&] { findScene((folder / name).string()); }, {name, "is not a regular file"});
    expectError(ErrorKind::BadInput, [] { findScene(""); }, {"no such file"});
}

TEST(FindScene, SeeksNamesInTheVariablesFoldersFirst) {
    TemporaryFolder a, b;
    writeFileAtomically(a / "mine.json", std::string_view(R"({"version": 1, "title": "Mine"})"));
    writeFileAtomically(b / "mine.json", std::string_view("{}"));
    writeFileAtomically(b / "other.json", std::string_view("broken"));
    writeFileAtomically(b / "scene.schema.json", std::string_view("{}"));
    const ScenesVariable variable(a.path().string() + ":/nonexistent::" + b.path().string());
    EXPECT_EQ(findScene("mine"), a / "mine.json");
    EXPECT_EQ(findScene("other"), b / "other.json");
    expectError(ErrorKind::Usage, [] { findScene("othr"); }, {"unknown scene \"othr\"; expected \"other\""});

    std::string mine, other;
    for (const SceneEntry& entry : listScenes()) {
        EXPECT_EQ(entry.name.find("schema"), std::string::npos);
        if (entry.name == "mine") mine = entry.title;
        if (entry.name == "other") other = entry.title;
    }
    EXPECT_EQ(mine, "Mine");
    EXPECT_EQ(other, "other") << "a broken file is listed by its name";
}

/// $LUMISCOPE_ASSETS while it lives.
class AssetsVariable {
public:
    explicit AssetsVariable(const fs::path& folder)
        : before_(std::getenv("LUMISCOPE_ASSETS") ? std::getenv("LUMISCOPE_ASSETS") : "") {
        setenv("LUMISCOPE_ASSETS", folder.c_str(), 1);
    }
    ~AssetsVariable() {
        before_.empty() ? unsetenv("LUMISCOPE_ASSETS") : setenv("LUMISCOPE_ASSETS", before_.c_str(), 1);
    }

private:
    std::string before_;
};

TEST(Assets, AreSoughtInTheVariablesFolder) {
    TemporaryFolder scenes, assets;
    writeFileAtomically(scenes / "far.json", std::string_view(R"({"version": 1, "title": "Far",
      "materials": {"m": {"base-color-texture": {"file": "assets:white.png"}}},
      "assets": {"shape": {"obj": "assets:models/shape.obj"}}, "instances": [{"asset": "shape"}],
      "environment": {"file": "assets:sky.hdr"}})"));
    const ScenesVariable scenesVariable(scenes.path().string());
    const AssetsVariable assetsVariable(assets.path());
    const auto missing = [] {
        for (const SceneEntry& entry : listScenes())
            if (entry.name == "far") return entry.missing;
        return std::string("not listed");
    };
    const auto load = [&] {
        MessageLog log;
        return loadScene(scenes / "far.json", log);
    };
    EXPECT_NE(missing().find("white.png: no such asset; expected $LUMISCOPE_ASSETS"), std::string::npos) << missing();
    expectError(ErrorKind::BadInput, load,
                {"far.json:2:", "white.png", "$LUMISCOPE_ASSETS to name a folder that holds white.png"});

    writePng(assets / "white.png", Image8{{1, 1}, {255, 255, 255, 255}});
    expectError(ErrorKind::BadInput, load, {"far.json:3:", "asset \"shape\"", "no such asset", "models/shape.obj"});
    fs::create_directory(assets / "models");
    writeFileAtomically(assets / "models/shape.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    expectError(ErrorKind::BadInput, load, {"far.json:4:", "\"environment\"", "no such asset", "sky.hdr"});
    writeFileAtomically(assets / "sky.hdr", std::string_view(tinyHdr()));
    EXPECT_EQ(missing(), "");
    EXPECT_EQ(load()->triangleCount(), 1);
}

TEST(Assets, StayInTheirFolder) {
    TemporaryFolder folder;
    const AssetsVariable variable(folder.path());
    for (const char* name : {"assets:../far.png", "assets:/tmp/far.png", "assets:a/../../far.png"}) {
        const std::string text = std::string(R"({"version": 1, "environment": {"file": ")") + name + "\"}}";
        writeFileAtomically(folder / "scene.json", std::string_view(text));
        MessageLog log;
        expectError(ErrorKind::BadInput, [&] { loadScene(folder / "scene.json", log); },
                    {"leads out of the folder of assets"});
    }
}

// Wherever a stop comes, between steps or within one, loading ends there.
TEST(Load, StopsAtEveryStep) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "cage.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"));
    const std::string text =
        R"({"version": 1, "assets": {"cage": {"obj": "cage.obj", "subdivision": "catmull-clark", "rate": 64},
        "ball": {"sphere": {}}}, "instances": [{"asset": "cage"}, {"asset": "ball"}]})";
    writeFileAtomically(folder / "a.json", std::string_view(text));
    MessageLog log;
    std::vector<float> steps;
    LoadOptions options;
    options.progress = [&](float fraction, const std::string&) { steps.push_back(fraction); };
    loadScene(folder / "a.json", log, options);
    ASSERT_GT(steps.size(), 6u);
    EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
    // After the last step there is nothing left to stop.
    for (size_t last = 0; last + 1 < steps.size(); ++last) {
        std::stop_source source;
        size_t done = 0;
        options.stop = source.get_token();
        options.progress = [&](float, const std::string&) {
            if (done++ == last) source.request_stop();
        };
        expectError(ErrorKind::Interrupted, [&] { loadScene(folder / "a.json", log, options); }, {});
        EXPECT_LE(done, last + 2) << last;
    }
}

// A scene file is its user's own: its paths go where they say. What other files name stays in their folder.
TEST(Assets, OfASceneFileMayLieOutsideItsFolder) {
    TemporaryFolder folder;
    fs::create_directories(folder / "scenes");
    fs::create_directories(folder / "shared meshes");
    writeFileAtomically(folder / "shared meshes/shape.obj", std::string_view("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    writeFileAtomically(folder / "sky.hdr", std::string_view(tinyHdr()));
    const auto load = [&](const std::string& mesh) {
        const std::string text = R"({"version": 1, "assets": {"it": {"obj": ")" + mesh +
                                 R"("}}, "instances": [{"asset": "it"}], "environment": {"file": "../sky.hdr"}})";
        writeFileAtomically(folder / "scenes/a.json", std::string_view(text));
        MessageLog log;
        return loadScene(folder / "scenes/a.json", log);
    };
    EXPECT_EQ(load("../shared meshes/shape.obj")->triangleCount(), 1);
    EXPECT_EQ(load((folder / "shared meshes/shape.obj").string())->triangleCount(), 1) << "an absolute path";
    // The glTF in the middle is read, but not followed out of its folder.
    writeFileAtomically(
        folder / "shared meshes/climbs.gltf",
        std::string_view(R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "../sky.hdr", "byteLength": 4}]})"));
    const std::string text =
        R"({"version": 1, "assets": {"it": {"gltf": "../shared meshes/climbs.gltf"}}, "instances": [{"asset": "it"}]})";
    writeFileAtomically(folder / "scenes/b.json", std::string_view(text));
    MessageLog log;
    expectError(ErrorKind::BadInput, [&] { loadScene(folder / "scenes/b.json", log); },
                {"asset \"it\"", "climbs.gltf", "leads out"});
}

// A title is no file.
TEST(Assets, AreWhatFilesAreNamed) {
    TemporaryFolder folder;
    writeFileAtomically(folder / "scene.json", std::string_view(R"({"version": 1, "title": "assets: none"})"));
    EXPECT_EQ(missingAsset(folder / "scene.json"), "");
}

TEST(FindScene, BuiltInScenesComeFirstInTheirOrder) {
    std::vector<std::string> expected;
    for (const char* name : {"cornell", "room", "atrium", "still-life", "parade"})
        if (fs::exists(fs::path(LUMISCOPE_SOURCE_DIR) / "scenes" / (std::string(name) + ".json")))
            expected.emplace_back(name);
    const std::vector<SceneEntry> scenes = listScenes();
    ASSERT_GE(scenes.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(scenes[i].name, expected[i]);
}

TEST(LoadScene, EveryBuiltInSceneLoads) {
    for (const SceneEntry& entry : listScenes()) {
        if (!entry.missing.empty()) {
            std::printf("left out: %s: %s\n", entry.name.c_str(), entry.missing.c_str());
            continue;
        }
        MessageLog log;
        const auto scene = loadScene(entry.path, log);
        EXPECT_GT(scene->triangleCount(), 0) << entry.name;
        EXPECT_TRUE(log.warnings().empty()) << entry.name << ": " << log.warnings()[0];
        EXPECT_NE(entry.title, entry.name) << "a built-in scene has a title";
    }
}

}  // namespace
}  // namespace lumi::test

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files.h"
#include "scene_file_support.h"
#include "support/schema_verdicts.h"
#include "support/temporary_folder.h"

namespace lumi::test {
namespace {
namespace fs = std::filesystem;

const fs::path kScenes = fs::path(LUMISCOPE_SOURCE_DIR) / "scenes";

/// Uses every structural key of the format; the schema and the parser must both take it.
constexpr const char* kEverything = R"({
  "$schema": "scene.schema.json", "version": 1, "title": "Everything",
  "assets": {
    "ball": {"sphere": {"radius": 0.5, "segments": 12}}, "floor": {"rectangle": {"size": [10, 10]}},
    "crate": {"box": {"size": [1, 2, 3], "bevel": 0.1}}, "ring": {"torus": {}}},
  "materials": {
    "plain": {"base-color": 0.5, "roughness": 1},
    "tiles": {"base-color-texture": {"checker": {"squares": 2}, "scale": 2, "offset": [0, 1], "rotate-deg": 45,
              "wrap": "mirror", "filter": "linear", "uv-set": 0, "mipmaps": false}, "emission": [1, 1, 1], "alpha-mode": "opaque"}},
  "instances": [
    {"name": "a", "asset": "ball", "material": "plain", "translate": [0, 1, 0], "rotate-deg": [0, 45, 0], "scale": 1,
     "interpolation": "linear", "loop": false,
     "keys": [{"time": 0, "translate": [0, 1, 0], "rotate-deg": [0, 0, 0], "scale": [1, 1, 1]}, {"time": 2}]},
    {"asset": "crate", "materials": {"surface": "tiles"}, "parent": "a", "scale": [1, 2, 3]}],
  "lights": {
    "lamp": {"rectangle": {"size": [1, 1]}, "radiance": [10, 10, 10], "translate": [0, 3, 0], "look-at": [0, 0, 0]},
    "round": {"disk": {"radius": 1}, "radiance": 1, "power": 2, "rotate-deg": [90, 0, 0], "parent": "a"},
    "bulb": {"sphere": {"radius": 1}, "loop": true, "interpolation": "step", "keys": [{"time": 1, "translate": [0, 0, 0]}]},
    "dot": {"point": {}, "intensity": 3}, "torch": {"spot": {"outer-cone-deg": 40}, "direction": [0, -1, 0]},
    "sun": {"directional": {"angle-deg": 0.53}, "irradiance": [3, 3, 3], "direction": [-1, -2, -1]}},
  "environment": {"sky": {"sun-share": 0.2}, "scale": 1, "rotate-deg": 0},
  "cameras": {"main": {"eye": [0, 1.6, 5], "look-at": [0, 1, 0], "up": [0, 1, 0], "fov-y-deg": 45, "aperture": 0,
    "focus": 5, "interpolation": "catmull-rom", "keys": [{"time": 0, "eye": [0, 1.6, 5]}, {"time": 4, "eye": [2, 1, 4]}]}},
  "render": {"size": [1280, 720], "fps": 60, "exposure": 0, "module": "accumulate", "set": {"path.max-depth": 4}}
})";

TEST(SceneSchema, TheShippedFileIsTheGeneratedOne) {
    const fs::path shipped = kScenes / "scene.schema.json";
    if (std::getenv("LUMISCOPE_UPDATE_SCHEMA")) writeFileAtomically(shipped, std::string_view(sceneFileSchema()));
    ASSERT_TRUE(readTextFile(shipped) == sceneFileSchema())
        << "a declaration changed; run this test once with LUMISCOPE_UPDATE_SCHEMA=1 and commit " << shipped;
}

TEST(SceneSchema, ParserAndSchemaTakeTheSameFile) {
    EXPECT_EQ(refusal(kEverything), "");
    if (!haveSchemaValidator()) GTEST_SKIP() << "python3-jsonschema is not installed";
    TemporaryFolder folder;
    writeFileAtomically(folder / "schema.json", std::string_view(sceneFileSchema()));
    writeFileAtomically(folder / "all.json", std::string_view(kEverything));
    EXPECT_EQ(schemaVerdicts(folder / "schema.json", {folder / "all.json"}), "1");
}

TEST(SceneSchema, RefusesWhatTheParserRefuses) {
    if (!haveSchemaValidator()) GTEST_SKIP() << "python3-jsonschema is not installed";
    TemporaryFolder folder;
    writeFileAtomically(folder / "schema.json", std::string_view(sceneFileSchema()));
    const std::string head = "{\"version\": 1, ";
    std::vector<fs::path> files;
    for (const std::string& text :
         {std::string("{}"), head + "\"titel\": \"x\"}", head + "\"materials\": {\"m\": {\"roughness\": 2}}}",
          head + "\"assets\": {\"a\": {\"sphere\": {\"radios\": 1}}}}",
          head + "\"lights\": {\"l\": {\"sphere\": {\"size\": [1, 1]}}}}"}) {
        EXPECT_NE(refusal(text), "") << text;
        files.push_back(folder / ("bad-" + std::to_string(files.size()) + ".json"));
        writeFileAtomically(files.back(), std::string_view(text));
    }
    EXPECT_EQ(schemaVerdicts(folder / "schema.json", files), std::string(files.size(), '0'));
}

TEST(SceneSchema, AcceptsEveryShippedScene) {
    if (!haveSchemaValidator()) GTEST_SKIP() << "python3-jsonschema is not installed";
    std::vector<fs::path> files;
    for (const fs::directory_entry& file : fs::directory_iterator(kScenes))
        if (file.path().extension() == ".json" && file.path().stem().extension() != ".schema")
            files.push_back(file.path());
    std::sort(files.begin(), files.end());
    const std::string answers = schemaVerdicts(kScenes / "scene.schema.json", files);
    ASSERT_EQ(answers.size(), files.size());
    for (size_t i = 0; i < files.size(); ++i) EXPECT_EQ(answers[i], '1') << files[i];
}

}  // namespace
}  // namespace lumi::test

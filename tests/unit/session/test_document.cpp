#include "session/document.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "image/exr.h"
#include "scene/defaults.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"
#include "support/tiny_scene.h"

namespace lumi::test {
namespace {

TEST(Slugs, AreLowerCaseAndUnique) {
    const std::vector<std::string> expected{"floor-paint", "floor-paint-2", "material-3", "a-b", "9", "floor-paint-3"};
    EXPECT_EQ(slugs({"Floor Paint", "floor.paint", "", " A__b! ", "9", "FLOOR/PAINT"}, "material"), expected);
}

TEST(Slugs, OfVeryManyEqualNamesAreUnique) {
    std::vector<std::string> names(100000, "a");
    names[1] = "A 3";
    const std::vector<std::string> unique = slugs(names, "material");
    EXPECT_EQ(std::vector(unique.begin(), unique.begin() + 4), (std::vector<std::string>{"a", "a-3", "a-2", "a-4"}));
    EXPECT_EQ(std::set<std::string>(unique.begin(), unique.end()).size(), names.size());
}

TEST(Document, OfManyLightsThatWhichChangedIsFound) {
    Scene scene = makeTinyScene();
    scene.lights.resize(20000, scene.lights[0]);
    Document document(std::make_shared<Scene>(scene));
    document.setText("light.lamp-20000.intensity", "3,2,1");
    EXPECT_EQ(document.changedValues().dump(), R"({"light.lamp-20000.intensity":[3.0,2.0,1.0]})");
    EXPECT_LT(document.listUnlike(*document.loadedScene()).size(), 50u) << "of the light and the sky";
}

TEST(Document, TakesTheScenesOwnSettings) {
    Scene scene = makeTinyScene();
    scene.render.exposureEv = 2;
    scene.render.module = "none";
    scene.render.set = {{"path.max-depth", "3"}, {"view.0.buffer", "albedo"}};
    const Document document(std::make_shared<Scene>(scene));
    EXPECT_EQ(document.render().width, 16);
    EXPECT_EQ(document.render().height, 12);
    EXPECT_EQ(document.path().maxDepth, 3);
    EXPECT_EQ(document.view(0).module, "none");
    EXPECT_EQ(document.view(0).buffer, "albedo");
    EXPECT_EQ(document.view(0).display.exposureEv, 2);
    EXPECT_TRUE(document.changedValues().empty()) << document.changedValues().dump();
}

TEST(Document, AScenesBadSettingIsBadInput) {
    Scene scene = makeTinyScene();
    scene.render.set = {{"path.max-dept", "3"}};
    expectError(ErrorKind::BadInput, [&] { Document document(std::make_shared<Scene>(scene)); },
                {"tiny.json", "path.max-dept", "\"path.max-depth\""});
}

TEST(Document, EveryIdCanBeReadAndSetToItself) {
    Document document(tinyScene());
    const std::vector<ParameterInfo> all = document.list();
    EXPECT_GT(all.size(), 60u);
    for (const ParameterInfo& info : all) {
        EXPECT_EQ(document.get(info.id), info.value) << info.id;
        EXPECT_EQ(document.initial(info.id), info.value) << info.id;
        EXPECT_NO_THROW(document.set(info.id, info.value)) << info.id;
        EXPECT_FALSE(info.help.empty()) << info.id;
    }
    EXPECT_TRUE(document.changedValues().empty()) << document.changedValues().dump();
}

TEST(Document, WhatIsOfTheSceneIsListedApart) {
    const auto scene = tinyScene();
    Document document(scene);
    std::set<std::string> parts;
    for (const ParameterInfo& info : document.list("", Document::Part::OfScene)) {
        parts.insert(info.id);
        const std::string kind = info.id.substr(0, info.id.find('.'));
        EXPECT_TRUE(kind == "material" || kind == "light" || kind == "environment") << info.id;
    }
    for (const ParameterInfo& info : document.list("", Document::Part::Others)) {
        EXPECT_TRUE(parts.insert(info.id).second) << info.id << " is listed in both";
        document.set(info.id, info.value);
        EXPECT_EQ(document.scene(), scene) << info.id << " makes another scene of it";
    }
    EXPECT_EQ(parts.size(), document.list().size());
}

TEST(Document, EditsReachTheSceneAndLeaveTheLoadedOneAlone) {
    Document document(tinyScene());
    const auto loaded = document.loadedScene();
    EXPECT_GE(document.setText("material.floor-paint-2.roughness", "0.25"), Redo::Samples);
    document.setText("light.lamp.power", "3");
    document.setText("environment.scale", "2");
    EXPECT_EQ(document.scene()->materials[1].roughness, 0.25f);
    EXPECT_EQ(document.scene()->materials[0].roughness, 0.5f);
    EXPECT_EQ(document.scene()->lights[0].power, 3);
    EXPECT_EQ(document.scene()->environment.scale, 2);
    EXPECT_EQ(document.loadedScene(), loaded);
    EXPECT_EQ(loaded->materials[1].roughness, 0.5f);
    EXPECT_EQ(document.scene()->instances[0].mesh, loaded->instances[0].mesh);
}

TEST(Document, SettingTheSameValueIsNoChange) {
    Document document(tinyScene());
    const auto before = document.scene();
    document.setText("material.floor-paint.roughness", "0.5");
    EXPECT_EQ(document.scene(), before);
}

TEST(Document, ACopyIsAValue) {
    Document document(tinyScene());
    Document copy = document;
    copy.setText("path.max-depth", "2");
    copy.setText("light.lamp.power", "2");
    EXPECT_EQ(document.path().maxDepth, PathSettings().maxDepth);
    EXPECT_EQ(document.scene()->lights[0].power, 1);
}

TEST(Document, UnknownIdsNameTheNearest) {
    Document document(tinyScene());
    const auto refuse = [&](const char* id, std::initializer_list<std::string> parts) {
        expectError(
            ErrorKind::Usage, [&] { document.setText(id, "1", "--set"); }, parts);
    };
    refuse("path.max-dept", {"--set", "\"path.max-depth\""});
    refuse("material.flor-paint.roughness", {"\"material.floor-paint.roughness\""});
    refuse("acumulate.limit", {"\"accumulate.limit\""});
    refuse("lamp", {"unknown parameter \"lamp\""});
    refuse("accumulate.max-sample", {"\"accumulate.max-samples\""});
    refuse("", {"unknown parameter \"\""});
    refuse("path.", {"unknown parameter"});
    expectError(ErrorKind::Usage, [&] { document.get("camera.eyes"); }, {"\"camera.eye\""});
}

TEST(Document, ValuesOutOfRangeAreRefused) {
    Document document(tinyScene());
    expectError(ErrorKind::Usage, [&] { document.set("path.max-depth", 0); }, {"path.max-depth", "1 to 64", "0"});
    expectError(ErrorKind::Usage, [&] { document.set("path.max-depth", std::string("x")); }, {"path.max-depth"});
    expectError(ErrorKind::Usage, [&] { document.setText("view.0.module", "svgg"); }, {"unknown module"});
    expectError(ErrorKind::Usage, [&] { document.setText("view.0.buffer", "albdo"); }, {"\"albedo\""});
    EXPECT_TRUE(document.changedValues().empty());
}

TEST(Document, InstancesHaveParametersOfTheirOwn) {
    Document document(tinyScene());
    document.setText("accumulate@b.max-samples", "7");
    EXPECT_EQ(std::get<int>(document.get("accumulate@b.max-samples")), 7);
    EXPECT_NE(document.get("accumulate.max-samples"), document.get("accumulate@b.max-samples"));
    EXPECT_EQ(document.list("accumulate@b.").size(), document.list("accumulate.").size());
}

TEST(Document, ANewModuleDropsABufferItLacks) {
    Document document(tinyScene());
    document.setText("view.0.buffer", "standardError");
    document.setText("view.0.module", "none");
    EXPECT_EQ(document.view(0).buffer, "image");
    document.setText("view.0.buffer", "normal");
    document.setText("view.0.module", "accumulate@x");
    EXPECT_EQ(document.view(0).buffer, "normal");
}

TEST(Document, OnlyDrawnViewsAreActive) {
    Document document(tinyScene());
    EXPECT_EQ(document.activeInstances(), std::vector<std::string>{"accumulate"});
    document.setText("view.layout", "wipe");
    EXPECT_EQ(document.activeInstances(), (std::vector<std::string>{"accumulate", "none"}));
    document.setText("view.1.module", "accumulate");
    EXPECT_EQ(document.activeInstances(), std::vector<std::string>{"accumulate"});
}

TEST(Document, CameraEditsHoldUntilACameraIsChosen) {
    Document document(movingScene());
    const Vec3 flown(7, 8, 9);
    document.set("camera.eye", flown);
    document.setTime(1);
    EXPECT_EQ(document.camera().eye, flown);
    document.setText("camera.select", "side-view");
    EXPECT_EQ(document.camera().eye, Vec3(5, 2, 0));
    for (const char* name : {"Side View", "side-view", "1"}) {
        Document other(movingScene());
        other.setText("camera.select", name);
        EXPECT_EQ(other.cameraIndex(), 1) << name;
    }
    document.setText("camera.select", "main");
    EXPECT_NEAR(document.camera().eye.x, 0.5f, 0.3f);
    EXPECT_NE(document.camera().eye, flown);
}

TEST(Document, ChangedValuesMakeTheSameDocument) {
    Document document(tinyScene());
    const std::pair<const char*, const char*> edits[] = {{"render.width", "64"},
                                                         {"path.max-depth", "2"},
                                                         {"camera.select", "side-view"},
                                                         {"camera.fov-y-deg", "30"},
                                                         {"camera.eye", "1,2,3"},
                                                         {"camera.jitter", "none"},
                                                         {"view.layout", "wipe"},
                                                         {"view.1.buffer", "depth"},
                                                         {"view.0.exposure", "-1.25"},
                                                         {"light.lamp.intensity", "1,2,3"},
                                                         {"time", "0.1"},
                                                         {"accumulate.limit", "true"},
                                                         {"accumulate.max-samples", "9"},
                                                         {"sampler.kind", "halton"},
                                                         {"material.material-3.base-color", "0.1,0.2,0.3"},
                                                         {"environment.scale", "0.3"},
                                                         {"render.seed", "5"}};
    for (const auto& [id, text] : edits) document.setText(id, text);
    const nlohmann::json values = nlohmann::json::parse(document.changedValues().dump());
    EXPECT_EQ(values.size(), std::size(edits)) << values.dump();
    Document again(document.loadedScene());
    again.apply(values);
    EXPECT_EQ(again.changedValues(), values);
    for (const ParameterInfo& info : document.list()) EXPECT_EQ(again.get(info.id), info.value) << info.id;
}

TEST(Document, DifferencesLeadFromOneToTheOther) {
    Document a(tinyScene()), b = a;
    a.setText("camera.eye", "1,1,1");
    a.setText("camera.focus", "3");
    a.setText("accumulate.limit", "true");
    a.setText("light.lamp.power", "4");
    b.setText("camera.eye", "2,2,2");
    b.setText("path.clamp", "true");
    Document moved = a;
    moved.apply(Document::difference(a, b));
    EXPECT_TRUE(Document::difference(moved, b).empty()) << Document::difference(moved, b).dump();
    EXPECT_EQ(moved.camera(), b.camera());
    EXPECT_EQ(moved.scene()->lights[0].power, 1);
}

TEST(Document, AnEditToThePresentValueFixesACameraThatMoves) {
    Document document(movingScene());
    const Vec3 eye = document.camera().eye;
    document.set("camera.eye", eye);
    document.setTime(1);
    EXPECT_EQ(document.camera().eye, eye);
    Document again(document.loadedScene());
    again.apply(document.changedValues());
    again.setTime(2);
    EXPECT_EQ(again.camera().eye, eye);
}

TEST(Document, AResetCameraFollowsItsAnimationAgain) {
    Document document(movingScene());
    const Document fresh = document;
    document.setText("camera.eye", "0,2,7");
    document.setText("camera.fov-y-deg", "30");
    document.setTime(1);
    EXPECT_GE(document.reset({"camera.eye"}), Redo::Samples);
    EXPECT_EQ(document.camera().eye, fresh.cameraAt(1).eye);
    EXPECT_EQ(document.camera().fovYDeg, 30);
    EXPECT_EQ(document.changedValues().count("camera.eye"), 0u) << document.changedValues().dump();
    EXPECT_EQ(document.reset({"camera.eye"}), Redo::Display) << "nothing was left to take back";
    expectError(ErrorKind::Usage, [&] { document.reset({"camera.eyes"}); }, {"camera.eye"});
}

TEST(Document, ResetsAllThatChanged) {
    Scene scene = makeTinyScene();
    scene.render.module = "svgf";
    scene.render.set = {{"view.0.buffer", "historyLength"}};
    Document document(std::make_shared<Scene>(scene));
    for (const auto& [id, text] : std::vector<std::pair<const char*, const char*>>{{"view.0.module", "none"},
                                                                                   {"camera.select", "side-view"},
                                                                                   {"camera.eye", "5,2,1"},
                                                                                   {"camera.jitter", "none"},
                                                                                   {"path.max-depth", "2"},
                                                                                   {"light.lamp.power", "3"},
                                                                                   {"svgf.color-alpha", "0.5"},
                                                                                   {"time", "2"}})
        document.setText(id, text);
    std::vector<std::string> ids;
    const nlohmann::json changed = document.changedValues();
    for (const auto& [id, value] : changed.items()) ids.push_back(id);
    EXPECT_GE(document.reset(ids), Redo::Samples);
    EXPECT_TRUE(document.changedValues().empty()) << document.changedValues().dump();
    EXPECT_EQ(document.view(0).buffer, "historyLength") << "the method is there before its buffer";
}

TEST(Document, FramesASecondSetTheShutter) {
    Document document(tinyScene());
    EXPECT_GE(document.setText("render.fps", "30"), Redo::Samples);
}

TEST(Document, DifferencesTakeBackWhatOneInstanceHad) {
    Document before(tinyScene()), after = before;
    after.setText("accumulate@b.max-samples", "7");
    after.apply(Document::difference(after, before));
    EXPECT_EQ(after.get("accumulate@b.max-samples"), before.get("accumulate@b.max-samples"));
}

/// A sky of one radiance.
void writeSky(const std::filesystem::path& path, float radiance) {
    Image sky({4, 2}, 3);
    sky.fill(radiance);
    ExrLayers layers;
    layers.add("", "RGB", sky);
    writeExr(path, layers);
}

TEST(Document, DifferencesTakeBackASkyWithItsSettings) {
    TemporaryFolder folder;
    writeSky(folder / "sky.exr", 1);
    Document before(tinyScene());
    before.setText("environment.scale", "2");
    Document after = before;
    after.setText("environment.file", (folder / "sky.exr").string());
    Document back = after;
    back.apply(Document::difference(after, before));
    EXPECT_EQ(back.scene()->environment.scale, 2);
    EXPECT_EQ(back.scene()->environment.image, nullptr);
    back.apply(Document::difference(before, after));
    EXPECT_EQ(back.scene()->environment.scale, 2);
    EXPECT_TRUE(Document::difference(back, after).empty()) << Document::difference(back, after).dump();
}

TEST(Document, AResetSkyIsTheScenesOwn) {
    TemporaryFolder folder;
    writeSky(folder / "sky.exr", 2);
    Document document(tinyScene());
    const auto before = document.scene();
    EXPECT_EQ(document.reset({"environment.file"}), Redo::Display);
    EXPECT_EQ(document.scene(), before) << "it was the scene's own";
    document.setText("environment.file", (folder / "sky.exr").string());
    document.setText("environment.scale", "3");
    EXPECT_GE(document.reset({"environment.file"}), Redo::Samples);
    EXPECT_TRUE(document.changedValues().empty()) << document.changedValues().dump();
}

TEST(Document, ASkyIsFoundBesideTheFileThatNamesIt) {
    TemporaryFolder folder;
    writeSky(folder / "sky.exr", 0.25f);
    Document document(tinyScene());
    document.apply({{"environment.file", "sky.exr"}}, (folder / "shot.png").string());
    EXPECT_EQ(document.scene()->environment.image->at(0, 0, 0), 0.25f);
    EXPECT_EQ(std::get<std::string>(document.get("environment.file")), "sky.exr");
}

TEST(Document, AppliesWhatIsSelectedBeforeItsEdits) {
    Document document(tinyScene());
    document.apply({{"camera.eye", {9, 9, 9}}, {"camera.select", "side-view"}});
    EXPECT_EQ(document.camera().eye, Vec3(9));
    EXPECT_EQ(document.cameraIndex(), 1);
    expectError(ErrorKind::Usage, [&] { document.apply({{"nothing", 1}}, "shot.png"); }, {"shot.png", "nothing"});
}

TEST(Document, ItsCameraTrackFollowsTheKeysUnderTheOpenShutter) {
    auto scene = std::make_shared<Scene>(*movingScene());
    scene->cameras[0].interpolation = Interpolation::Linear;
    EXPECT_TRUE(Document(scene).cameraTrack().empty()) << "the shutter is open for an instant";
    scene->cameras[0].camera.shutter = 60;
    EXPECT_EQ(Document(scene).cameraTrack().size(), 3u) << "half of a straight way";
    // A glance aside between the halvings of the shutter.
    const SceneCamera::Key rest{.time = 0, .eye = {0, 2, 5}};
    scene->cameras[0].keys.assign(5, rest);
    const float times[] = {0, 0.40f, 0.4375f, 0.475f, 1};
    for (size_t i = 0; i < 5; ++i) scene->cameras[0].keys[i].time = times[i];
    scene->cameras[0].keys[2].eye.x = 3;
    const CameraTrack track = Document(scene).cameraTrack();
    EXPECT_TRUE(std::any_of(track.begin(), track.end(), [](const CameraPose& p) { return p.position().x > 2.9f; }));
    Document fixed(scene);
    fixed.setText("camera.eye", "0,2,5");
    EXPECT_TRUE(fixed.cameraTrack().empty());
}

TEST(Document, ARadianceTakesThePlaceOfTheBuiltInSky) {
    MessageLog log;
    Scene dark = makeTinyScene();
    dark.environment = {};
    dark.lights.clear();
    for (Instance& instance : dark.instances) instance.light = -1;
    for (Material& material : dark.materials) material.emission = Vec3(0);
    addDefaults(dark, log, true);
    Document document(std::make_shared<const Scene>(dark));
    const auto builtIn = document.scene()->environment.image;
    ASSERT_NE(builtIn, nullptr);
    EXPECT_GE(document.setText("environment.constant", "0.5,1,2"), Redo::Samples);
    EXPECT_EQ(document.scene()->environment.image, nullptr);
    EXPECT_EQ(document.scene()->environment.constant, Vec3(0.5f, 1, 2));
    document.reset({"environment.constant"});
    EXPECT_EQ(document.scene()->environment.image, builtIn);
    document.setText("environment.constant", "1,1,1");
    TemporaryFolder folder;
    writeSky(folder / "sky.exr", 1);
    document.setText("environment.file", (folder / "sky.exr").string());
    document.setText("environment.constant", "2,2,2");
    EXPECT_NE(document.scene()->environment.image, nullptr) << "a file is there because someone wants it";
    document.setText("environment.file", "");
    EXPECT_EQ(document.scene()->environment.image, builtIn);
}

}  // namespace
}  // namespace lumi::test

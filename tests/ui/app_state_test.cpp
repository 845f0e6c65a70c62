#include "ui/app_state.h"

#include <cstdlib>
#include <fstream>

#include "support/session_test.h"
#include "support/temporary_folder.h"
#include "ui/commands.h"
#include "ui/preferences.h"

namespace lumi::test {
namespace {

class AppStateTest : public SessionTest {
protected:
    AppStateTest() {
        if (const char* cache = std::getenv("XDG_CACHE_HOME")) cacheBefore = cache;
        setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
    }
    ~AppStateTest() override {
        if (cacheBefore) setenv("XDG_CACHE_HOME", cacheBefore->c_str(), 1);
        else unsetenv("XDG_CACHE_HOME");
    }
    /// A reference that takes longer than any test.
    void makeLongReference() {
        open();
        state.beginFrame();
        state.makeReference(ReferenceGoal::kMostSamples);
        state.beginFrame();
        EXPECT_TRUE(state.metrics.reference().working);
        EXPECT_FALSE(session.rendering()) << "it waits for the reference";
    }

    std::optional<std::string> cacheBefore;
    TemporaryFolder folder;
    AppState state{session, log};
};

TEST_F(AppStateTest, AnotherSceneGoesOnWithoutTheReferenceOfTheOneBefore) {
    makeLongReference();
    state.open(folder / "missing.gltf");
    waitFor("the failure", [&] { return logged("missing.gltf"); });
    state.beginFrame();
    EXPECT_TRUE(state.metrics.reference().working) << "the scene is the same yet";
    state.open(kCornell);
    waitFor("rendering", [&] {
        state.beginFrame();
        return session.rendering();
    });
    EXPECT_FALSE(state.metrics.reference().working);
}

TEST_F(AppStateTest, PanelsReadTheDocumentsParametersAsTheyStand) {
    open();
    const auto expectSame = [&] {
        state.beginFrame();
        const Document document = session.document();
        std::map<std::string, std::vector<std::string>> names;
        for (const ParameterInfo& info : document.list()) {
            const ParameterInfo* found = state.document.find(info.id);
            ASSERT_TRUE(found) << info.id;
            EXPECT_EQ(found->value, info.value) << info.id;
            const size_t first = info.id.find('.'), last = info.id.rfind('.');
            if (first == last) continue;
            std::vector<std::string>& ofKind = names[info.id.substr(0, first)];
            const std::string name = info.id.substr(first + 1, last - first - 1);
            if (std::count(ofKind.begin(), ofKind.end(), name) == 0) ofKind.push_back(name);
        }
        EXPECT_EQ(state.document.names("material"), names.at("material"));
        EXPECT_TRUE(state.document.names("nothing").empty());
        for (const std::string prefix : {"material.", "camera.", "view.0.", "path.max-depth", "environment."}) {
            const std::vector<ParameterInfo> expected = document.list(prefix);
            const std::vector<const ParameterInfo*> group = state.document.group(prefix);
            ASSERT_EQ(group.size(), expected.size()) << prefix;
            for (size_t i = 0; i < group.size(); ++i) EXPECT_EQ(group[i]->id, expected[i].id);
            EXPECT_TRUE(state.document.hasGroup(prefix));
        }
        EXPECT_FALSE(state.document.find("materia"));
        EXPECT_FALSE(state.document.hasGroup("materials."));
        EXPECT_TRUE(state.document.group("zz").empty());
    };
    expectSame();
    const std::string roughness = "material." + state.document.names("material").back() + ".roughness";
    state.set(roughness, 0.125f);
    state.set("path.max-depth", 3);
    expectSame();
    EXPECT_EQ(state.document.number(roughness, 0), 0.125f);
    EXPECT_EQ(state.document.changedIds(),
              (std::set<std::string>{roughness, "path.max-depth", "render.height", "render.width"}));
}

TEST_F(AppStateTest, WhoPausesByHandStaysPaused) {
    makeLongReference();
    state.setRendering(true);
    state.setRendering(false);
    state.metrics.cancelReference();
    state.beginFrame();
    EXPECT_FALSE(session.rendering());
}

TEST_F(AppStateTest, TheSurfaceAskedForIsWhatTheCameraOrbitsAround) {
    open();
    state.beginFrame();
    const Camera before = session.document().camera();
    state.orbitTarget = session.surfaceAt({16, 20});
    waitFor("the answer", [&] {
        state.beginFrame();
        return !state.orbitTarget.valid();
    });
    const Camera after = session.document().camera();
    EXPECT_EQ(after.eye, before.eye);
    EXPECT_NE(after.target, before.target);
    EXPECT_NEAR(glm::dot(glm::normalize(after.target - after.eye), glm::normalize(before.target - before.eye)), 1,
                1e-5f);
}

TEST_F(AppStateTest, ABookmarkIsTheWholeCamera) {
    open();
    state.beginFrame();
    session.setAll({{"camera.aperture", 0.0123456789f}, {"camera.fov-y-deg", 20.0f}, {"camera.up", Vec3(0.3f, 1, 0)}});
    state.beginFrame();
    EXPECT_EQ(cameraAsCommandLine(state.document).find("camera.select"), std::string::npos);
    for (const char* told : {"--set camera.eye=", " --set camera.look-at=", " --set camera.fov-y-deg=20",
                             " --set camera.aperture=0.012345679", " --set camera.up=0.3,1,0"})
        EXPECT_NE(cameraAsCommandLine(state.document).find(told), std::string::npos) << told;
    runCommand(state, UiCommand::StoreBookmark, 3);
    const Camera stored = session.document().camera();
    session.setAll(
        {{"camera.projection", std::string("orthographic")}, {"camera.eye", Vec3(9)}, {"camera.aperture", 0.0f}});
    state.beginFrame();
    savePreferences(state, folder / "window.json");
    AppState later(session, log);
    later.beginFrame();
    loadPreferences(later, folder / "window.json");
    runCommand(later, UiCommand::RecallBookmark, 3);
    const Camera back = session.document().camera();
    EXPECT_EQ(back.eye, stored.eye);
    EXPECT_EQ(back.projection, Projection::Perspective);
    EXPECT_EQ(back.fovYDeg, 20.0f);
    EXPECT_EQ(back.aperture, stored.aperture);
    EXPECT_EQ(back.up, stored.up);
}

TEST_F(AppStateTest, PosesOfTheFirstPreferencesAreRead) {
    open();
    state.beginFrame();
    std::ofstream(folder / "window.json") << R"({"version": 1, "bookmarks": {")" << kCornell.string()
                                          << R"(": {"2": {"eye": [1, 2, 3], "look-at": [0, 0, 1]}}}})";
    loadPreferences(state, folder / "window.json");
    runCommand(state, UiCommand::RecallBookmark, 1);
    EXPECT_EQ(session.document().camera().eye, Vec3(1, 2, 3));
    EXPECT_TRUE(log.messages().empty());
}

TEST_F(AppStateTest, WhatWasSteppedGoesOnWhenItIsPlayed) {
    open();
    state.beginFrame();
    runCommand(state, UiCommand::PlayTime);
    EXPECT_TRUE(state.timePlays());
    runCommand(state, UiCommand::Step);
    EXPECT_FALSE(state.timePlays()) << "the step holds it";
    runCommand(state, UiCommand::PlayTime);
    EXPECT_TRUE(state.timePlays());
    runCommand(state, UiCommand::PlayTime);
    EXPECT_FALSE(state.timePlays());
    EXPECT_TRUE(session.rendering()) << "time alone stands";
}

}  // namespace
}  // namespace lumi::test

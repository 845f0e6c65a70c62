#include "ui/app_state.h"

#include <cstdlib>

#include "support/session_test.h"
#include "support/temporary_folder.h"

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

}  // namespace
}  // namespace lumi::test

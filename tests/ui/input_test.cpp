#include "ui/input.h"

#include <gtest/gtest.h>
#include <imgui.h>

namespace lumi {
namespace {

class Input : public testing::Test {
protected:
    Input() : context_(ImGui::CreateContext()) { mapImGuiKeys(); }
    ~Input() override { ImGui::DestroyContext(context_); }

    ImGuiContext* context_;
    InputQueue queue_;
};

TEST_F(Input, aClickWithinOneFrameIsSpreadOverTwo) {
    queue_.add(MouseMoved{{10, 20}});
    queue_.add(MouseButtonChanged{MouseButton::Left, true});
    queue_.add(MouseButtonChanged{MouseButton::Left, false});
    queue_.applyFrame();
    EXPECT_EQ(ImGui::GetIO().MousePos.x, 10);
    EXPECT_TRUE(ImGui::GetIO().MouseDown[0]);
    EXPECT_FALSE(queue_.empty());
    queue_.applyFrame();
    EXPECT_FALSE(ImGui::GetIO().MouseDown[0]);
    EXPECT_TRUE(queue_.empty());
}

TEST_F(Input, aMoveAfterAPressWaits) {
    queue_.add(MouseMoved{{10, 20}});
    queue_.add(MouseButtonChanged{MouseButton::Left, true});
    queue_.add(MouseMoved{{90, 20}});
    queue_.applyFrame();
    EXPECT_EQ(ImGui::GetIO().MousePos.x, 10);
    queue_.applyFrame();
    EXPECT_EQ(ImGui::GetIO().MousePos.x, 90);
}

TEST_F(Input, chordsCarryTheModifiersOfTheirMoment) {
    queue_.add(KeyChanged{Key::LeftControl, true});
    queue_.add(KeyChanged{Key::Z, true});
    queue_.add(KeyChanged{Key::Z, false});
    queue_.add(KeyChanged{Key::LeftControl, false});
    queue_.add(KeyChanged{Key::F, true});
    const FrameInput first = queue_.applyFrame();
    ASSERT_EQ(first.pressed.size(), 1u);
    EXPECT_EQ(first.pressed[0], (KeyChord{Key::Z, true}));
    const FrameInput second = queue_.applyFrame();
    ASSERT_EQ(second.pressed.size(), 1u);
    EXPECT_EQ(second.pressed[0], (KeyChord{Key::F}));
}

TEST_F(Input, losingFocusReleasesEverything) {
    queue_.add(KeyChanged{Key::W, true});
    queue_.add(MouseButtonChanged{MouseButton::Right, true});
    queue_.applyFrame();
    queue_.add(FocusLost{});
    queue_.applyFrame();
    EXPECT_FALSE(ImGui::IsKeyDown(static_cast<int>(Key::W)));
    EXPECT_FALSE(ImGui::GetIO().MouseDown[1]);
}

TEST_F(Input, droppedFilesArrive) {
    queue_.add(FilesDropped{{"/a/b.gltf"}});
    const FrameInput frame = queue_.applyFrame();
    ASSERT_EQ(frame.dropped.size(), 1u);
    EXPECT_EQ(frame.dropped[0], "/a/b.gltf");
}

}  // namespace
}  // namespace lumi

#include <gtest/gtest.h>
#include <imgui.h>

#include <array>

#include "base/error.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "ui/draw_renderer.h"
#include "ui/image_painter.h"

namespace lumi {
namespace {

using Colour = std::array<int, 3>;

Colour pixel(const Image8& image, int x, int y) {
    const uint8_t* p =
        &image.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(image.extent.width) + static_cast<size_t>(x))];
    return {p[0], p[1], p[2]};
}

class Drawing : public testing::TestWithParam<ContextKind> {
protected:
    void SetUp() override {
        try {
            context_ = createHeadlessContext(GetParam());
        } catch (const Error& error) {
            GTEST_SKIP() << error.what();
        }
    }
    const GlFunctions& gl() const { return context_->gl(); }
    void clear(const Framebuffer& target) const {
        target.bind();
        gl().ClearColor(0, 0, 0, 1);
        gl().Clear(GL_COLOR_BUFFER_BIT);
    }

    std::unique_ptr<HeadlessContext> context_;
};

/// One ImGui frame with a rectangle, a clipped one, and text in the built-in font.
Image8 drawImGui(const GlFunctions& gl, Extent2 extent) {
    ImGuiContext* imgui = ImGui::CreateContext();
    Image8 image;
    {
        DrawRenderer renderer(gl);
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().Fonts->AddFontDefault();
        renderer.uploadFonts();
        ImGui::GetIO().DisplaySize = ImVec2(static_cast<float>(extent.width), static_cast<float>(extent.height));
        ImGui::NewFrame();
        ImDrawList& list = *ImGui::GetForegroundDrawList();
        list.AddRectFilled(ImVec2(10, 20), ImVec2(50, 40), IM_COL32(200, 100, 50, 255));
        list.PushClipRect(ImVec2(60, 20), ImVec2(70, 40));
        list.AddRectFilled(ImVec2(0, 0), ImVec2(100, 100), IM_COL32(0, 255, 0, 255));
        list.PopClipRect();
        list.AddText(ImVec2(10, 60), IM_COL32(255, 255, 255, 255), "Text");
        ImGui::Render();
        const Framebuffer target(gl, extent);
        target.bind();
        gl.ClearColor(0, 0, 0, 1);
        gl.Clear(GL_COLOR_BUFFER_BIT);
        renderer.draw(*ImGui::GetDrawData(), extent);
        image = target.read();
    }
    ImGui::DestroyContext(imgui);
    return image;
}

TEST_P(Drawing, putsImGuiRectanglesWhereTheyBelong) {
    const Image8 image = drawImGui(gl(), {120, 90});
    EXPECT_EQ(pixel(image, 30, 30), (Colour{200, 100, 50}));
    EXPECT_EQ(pixel(image, 11, 21), (Colour{200, 100, 50}));
    EXPECT_EQ(pixel(image, 8, 30), (Colour{0, 0, 0}));
    EXPECT_EQ(pixel(image, 30, 44), (Colour{0, 0, 0}));
    EXPECT_EQ(pixel(image, 65, 30), (Colour{0, 255, 0}));
    EXPECT_EQ(pixel(image, 58, 30), (Colour{0, 0, 0})) << "clipping let a pixel through";
    EXPECT_EQ(pixel(image, 72, 30), (Colour{0, 0, 0}));
    int white = 0;
    for (int y = 60; y < 74; ++y)
        for (int x = 10; x < 40; ++x) white += pixel(image, x, y)[0] > 200;
    EXPECT_GT(white, 20) << "the text is missing";
}

TEST_P(Drawing, isTheSameBytesAgain) { EXPECT_EQ(drawImGui(gl(), {120, 90}).rgba, drawImGui(gl(), {120, 90}).rgba); }

std::shared_ptr<const Image8> checker(Colour even, Colour odd) {
    auto image = std::make_shared<Image8>();
    image->extent = {4, 4};
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            const Colour& c = (x + y) % 2 == 0 ? even : odd;
            for (const int value : c) image->rgba.push_back(static_cast<uint8_t>(value));
            image->rgba.push_back(255);
        }
    return image;
}

constexpr Colour kRed{255, 0, 0}, kBlue{0, 0, 255}, kWhite{255, 255, 255}, kGreen{0, 255, 0};

TEST_P(Drawing, magnifiesPixelsWithSharpEdges) {
    ImagePainter painter(gl());
    painter.setPicture(0, checker(kRed, kBlue));
    const Framebuffer target(gl(), {48, 48});
    clear(target);
    PanePicture pane;
    pane.corner = {4, 4};
    pane.size = {40, 40};
    pane.zoom = 8;
    pane.origin = {2, 3};
    painter.draw({pane}, {48, 48}, {0, 0, 0, 1});
    const Image8 image = target.read();
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const Colour expected = (x / 8 + y / 8) % 2 == 0 ? kRed : kBlue;
            ASSERT_EQ(pixel(image, 4 + 2 + x, 4 + 3 + y), expected) << x << ' ' << y;
        }
    EXPECT_EQ(pixel(image, 5, 20), (Colour{0, 0, 0})) << "the surround is drawn beside the picture";
}

TEST_P(Drawing, wipesBetweenTwoPictures) {
    ImagePainter painter(gl());
    painter.setPicture(0, checker(kRed, kRed));
    painter.setPicture(1, checker(kGreen, kGreen));
    const Framebuffer target(gl(), {40, 40});
    clear(target);
    PanePicture pane;
    pane.size = {40, 40};
    pane.zoom = 10;
    pane.right = 1;
    pane.wipeX = 13;
    painter.draw({pane}, {40, 40}, {0, 0, 0, 1});
    const Image8 image = target.read();
    EXPECT_EQ(pixel(image, 12, 20), kRed);
    EXPECT_EQ(pixel(image, 13, 20), kGreen);
}

TEST_P(Drawing, averagesWhenItShrinks) {
    ImagePainter painter(gl());
    painter.setPicture(0, checker(kWhite, Colour{0, 0, 0}));
    const Framebuffer target(gl(), {8, 8});
    clear(target);
    PanePicture pane;
    pane.size = {8, 8};
    pane.zoom = 0.5f;
    painter.draw({pane}, {8, 8}, {0, 0, 0, 1});
    const Image8 image = target.read();
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(pixel(image, i, 1)[0], 128, 1);
}

TEST_P(Drawing, drawsAGridOnlyBetweenPixels) {
    ImagePainter painter(gl());
    painter.setPicture(0, checker(kRed, kRed));
    const Framebuffer target(gl(), {80, 80});
    clear(target);
    PanePicture pane;
    pane.size = {80, 80};
    pane.zoom = 20;
    pane.grid = 1;
    painter.draw({pane}, {80, 80}, {0, 0, 0, 1});
    const Image8 image = target.read();
    EXPECT_EQ(pixel(image, 10, 10), kRed);
    const Colour line{128, 128, 128};
    int lines = 0;
    for (int x = 15; x < 25; ++x) lines += pixel(image, x, 10) == line;
    EXPECT_GE(lines, 1);
    EXPECT_LE(lines, 2);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Drawing, testing::Values(ContextKind::Egl, ContextKind::OsMesa),
                         [](const auto& kind) { return kind.param == ContextKind::Egl ? "Egl" : "OsMesa"; });

}  // namespace
}  // namespace lumi

#include <gtest/gtest.h>

#include <array>

#include "base/error.h"
#include "gl/context.h"
#include "gl/framebuffer.h"
#include "gl/program.h"

namespace lumi {
namespace {

/// Each kind of context that this machine can give.
class Contexts : public testing::TestWithParam<ContextKind> {
protected:
    void SetUp() override {
        try {
            context_ = createHeadlessContext(GetParam());
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::NoDisplay);
            GTEST_SKIP() << error.what();
        }
    }
    const GlFunctions& gl() const { return context_->gl(); }

    std::unique_ptr<HeadlessContext> context_;
};

constexpr const char* kTriangleVertex = R"(#version 330 core
void main() {
    vec2 corners[3] = vec2[3](vec2(-1.0, -1.0), vec2(1.0, -1.0), vec2(-1.0, 1.0));
    gl_Position = vec4(corners[gl_VertexID], 0.0, 1.0);
})";
constexpr const char* kTriangleFragment = R"(#version 330 core
uniform vec4 uColour;
out vec4 oColour;
void main() { oColour = uColour; })";

/// Lower-left half of a square in `colour`, the rest black.
Image8 drawTriangle(const GlFunctions& gl, Extent2 extent) {
    const Framebuffer target(gl, extent);
    const Program program(gl, "triangle", kTriangleVertex, kTriangleFragment);
    GLuint vertexArray = 0;
    gl.GenVertexArrays(1, &vertexArray);
    gl.BindVertexArray(vertexArray);
    target.bind();
    gl.ClearColor(0, 0, 0, 1);
    gl.Clear(GL_COLOR_BUFFER_BIT);
    program.use();
    program.set("uColour", 1.0f, 0.2f, 0.4f, 1.0f);
    gl.DrawArrays(GL_TRIANGLES, 0, 3);
    Image8 image = target.read();
    gl.DeleteVertexArrays(1, &vertexArray);
    return image;
}

std::array<int, 4> pixel(const Image8& image, int x, int y) {
    const uint8_t* p =
        &image.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(image.extent.width) + static_cast<size_t>(x))];
    return {p[0], p[1], p[2], p[3]};
}

TEST_P(Contexts, areAtLeastOpenGl33) {
    GLint major = 0, minor = 0;
    gl().GetIntegerv(GL_MAJOR_VERSION, &major);
    gl().GetIntegerv(GL_MINOR_VERSION, &minor);
    EXPECT_GE(major * 10 + minor, 33);
    EXPECT_FALSE(context_->description().empty());
}

TEST_P(Contexts, drawATriangleWhereItBelongs) {
    const Image8 image = drawTriangle(gl(), {64, 64});
    const std::array<int, 4> inside{255, 51, 102, 255}, outside{0, 0, 0, 255};
    EXPECT_EQ(pixel(image, 2, 61), inside);  // top row first: the lower left is at the end
    EXPECT_EQ(pixel(image, 2, 5), inside);
    EXPECT_EQ(pixel(image, 58, 61), inside);
    EXPECT_EQ(pixel(image, 61, 2), outside);
    EXPECT_EQ(pixel(image, 40, 20), outside);
    int covered = 0;
    for (size_t i = 0; i < image.rgba.size(); i += 4) covered += image.rgba[i] == 255;
    EXPECT_NEAR(covered, 64 * 64 / 2, 64);
}

TEST_P(Contexts, drawTheSameBytesAgain) {
    const Image8 first = drawTriangle(gl(), {61, 43});
    context_.reset();
    context_ = createHeadlessContext(GetParam());
    EXPECT_EQ(first.rgba, drawTriangle(gl(), {61, 43}).rgba);
}

TEST_P(Contexts, giveTexturesBackAsTheyCame) {
    Image8 image;
    image.extent = {5, 3};
    for (int i = 0; i < 60; ++i) image.rgba.push_back(static_cast<uint8_t>(4 * i));
    GlTexture texture(gl());
    texture.upload(image.extent, image.rgba.data());
    GLuint framebuffer = 0;
    gl().GenFramebuffers(1, &framebuffer);
    gl().BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl().FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture.id(), 0);
    // readPixels() turns OpenGL's bottom-up rows over, and textures here hold their top row first.
    const Image8 back = readPixels(gl(), image.extent);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) EXPECT_EQ(pixel(back, x, 2 - y), pixel(image, x, y)) << x << ' ' << y;
    gl().DeleteFramebuffers(1, &framebuffer);
}

TEST_P(Contexts, reportShadersThatDoNotCompile) {
    try {
        const Program program(gl(), "broken", kTriangleVertex, "#version 330 core\nvoid main() { nonsense; }");
        FAIL() << "a broken shader compiled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput);
        EXPECT_NE(std::string(error.what()).find("broken.frag"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("nonsense"), std::string::npos) << error.what();
    }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Contexts, testing::Values(ContextKind::Egl, ContextKind::OsMesa),
                         [](const auto& kind) { return kind.param == ContextKind::Egl ? "Egl" : "OsMesa"; });

TEST(HeadlessContext, isFoundOnAnyMachineWithMesa) { EXPECT_NO_THROW(createHeadlessContext()); }

}  // namespace
}  // namespace lumi

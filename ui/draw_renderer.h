#pragma once
#include <memory>

#include "gl/program.h"
#include "gl/texture.h"

struct ImDrawData;
struct ImDrawList;

namespace lumi {

/// Draws ImGui's triangles with any context's function table: a GLFW window, EGL or OSMesa alike. ImTextureID is the
/// OpenGL name of a texture.
class DrawRenderer {
public:
    explicit DrawRenderer(const GlFunctions& gl);
    ~DrawRenderer();
    DrawRenderer(const DrawRenderer&) = delete;
    DrawRenderer& operator=(const DrawRenderer&) = delete;

    /// Uploads the font atlas of the current ImGui context; again whenever it was rebuilt.
    void uploadFonts();
    /// Draws into the framebuffer that is bound, of `target` pixels, over what is there.
    void draw(const ImDrawData& data, Extent2 target);

private:
    void setState(const ImDrawData& data, Extent2 target);
    void drawList(const ImDrawList& list, const ImDrawData& data, Extent2 target);

    const GlFunctions& gl_;
    Program program_;
    std::unique_ptr<GlTexture> fonts_;
    GLuint vertexArray_ = 0, vertices_ = 0, indices_ = 0;
};

}  // namespace lumi

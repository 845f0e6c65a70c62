#pragma once
#include "gl/texture.h"
#include "image/image.h"

namespace lumi {

/// A colour target of RGBA8, what a headless context draws to.
class Framebuffer {
public:
    Framebuffer(const GlFunctions& gl, Extent2 extent);
    ~Framebuffer();
    Framebuffer(const Framebuffer&) = delete;
    Framebuffer& operator=(const Framebuffer&) = delete;

    /// Binds it for drawing; the viewport covers it.
    void bind() const;
    /// What was drawn, top row first.
    Image8 read() const;
    Extent2 extent() const { return colour_.extent(); }

private:
    const GlFunctions& gl_;
    GlTexture colour_;
    GLuint id_ = 0;
};

/// Pixels of the framebuffer that is bound, top row first.
Image8 readPixels(const GlFunctions& gl, Extent2 extent);

}  // namespace lumi

#include "gl/framebuffer.h"

#include <algorithm>

#include "base/error.h"

namespace lumi {

Framebuffer::Framebuffer(const GlFunctions& gl, Extent2 extent) : gl_(gl), colour_(gl) {
    colour_.upload(extent, nullptr);
    gl.GenFramebuffers(1, &id_);
    gl.BindFramebuffer(GL_FRAMEBUFFER, id_);
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour_.id(), 0);
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        gl.DeleteFramebuffers(1, &id_);
        throw Error(ErrorKind::NoDisplay, {.what = "OpenGL cannot draw into an RGBA8 texture of this size",
                                           .where = "",
                                           .expected = "",
                                           .found = ""});
    }
}

Framebuffer::~Framebuffer() { gl_.DeleteFramebuffers(1, &id_); }

void Framebuffer::bind() const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, id_);
    gl_.Viewport(0, 0, extent().width, extent().height);
}

Image8 Framebuffer::read() const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, id_);
    return readPixels(gl_, extent());
}

Image8 readPixels(const GlFunctions& gl, Extent2 extent) {
    Image8 image;
    image.extent = extent;
    image.rgba.resize(static_cast<size_t>(extent.area()) * 4);
    gl.PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl.ReadPixels(0, 0, extent.width, extent.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
    const auto rowBytes = static_cast<std::ptrdiff_t>(extent.width) * 4;
    for (int y = 0; y < extent.height / 2; ++y) {
        const auto top = image.rgba.begin() + y * rowBytes;
        const auto bottom = image.rgba.begin() + (extent.height - 1 - y) * rowBytes;
        std::swap_ranges(top, top + rowBytes, bottom);
    }
    return image;
}

}  // namespace lumi

#include "gl/texture.h"

namespace lumi {

GlTexture::GlTexture(const GlFunctions& gl, GlFilter filter) : gl_(gl) {
    gl.GenTextures(1, &id_);
    gl.BindTexture(GL_TEXTURE_2D, id_);
    const GLint mode = filter == GlFilter::Nearest ? GL_NEAREST : GL_LINEAR;
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mode);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

GlTexture::~GlTexture() { gl_.DeleteTextures(1, &id_); }

void GlTexture::upload(Extent2 extent, const uint8_t* rgba) {
    gl_.BindTexture(GL_TEXTURE_2D, id_);
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    if (extent == extent_ && rgba) {
        gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, extent.width, extent.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
        return;
    }
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, extent.width, extent.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba);
    extent_ = extent;
}

void GlTexture::bind(int unit) const {
    gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_.BindTexture(GL_TEXTURE_2D, id_);
}

}  // namespace lumi

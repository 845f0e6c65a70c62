#pragma once
#include <cstdint>

#include "gl/functions.h"
#include "math/vector.h"

namespace lumi {

enum class GlFilter { Nearest, Linear };

/// An RGBA8 texture, clamped at its edges, top row first in memory and at v = 0.
class GlTexture {
public:
    explicit GlTexture(const GlFunctions& gl, GlFilter filter = GlFilter::Nearest);
    ~GlTexture();
    GlTexture(const GlTexture&) = delete;
    GlTexture& operator=(const GlTexture&) = delete;

    /// `rgba`: 4 bytes a pixel, rows without gaps; null leaves the contents undefined. Memory is kept if the extent
    /// stays.
    void upload(Extent2 extent, const uint8_t* rgba);

    void bind(int unit) const;
    GLuint id() const { return id_; }
    Extent2 extent() const { return extent_; }

private:
    const GlFunctions& gl_;
    GLuint id_ = 0;
    Extent2 extent_;
};

}  // namespace lumi

#pragma once
#include <cmath>

#include "trace/scene_tables.h"

namespace lumi {

/// How finely textures are filtered: between two mip levels where the eye rests on the surface, else from one.
enum class MipFilter : uint8_t { Between, Nearest };

/// Texture coordinates of a surface point, and how many of their units a metre of the surface spans.
class TextureLookups {
public:
    TextureLookups(const InstanceRecord& instance, const UVec3& triangle, Vec2 barycentrics, float footprint,
                   float twiceArea, MipFilter mips)
        : instance_(instance),
          triangle_(triangle),
          b_(barycentrics),
          footprint_(footprint),
          twiceArea_(twiceArea),
          mips_(mips) {}

    Vec4 operator()(const Texture& texture) {
        const Place& at = place(texture.uvSet);
        return mips_ == MipFilter::Between ? texture.sample(at.uv, at.width)
                                           : texture.sampleNearestLevel(at.uv, at.width);
    }
    void prefetch(const Texture& texture) {
        const Place& at = place(texture.uvSet);
        texture.prefetch(at.uv, at.width);
    }

    const InstanceRecord& instance() const { return instance_; }
    const UVec3& triangle() const { return triangle_; }
    Vec2 barycentrics() const { return b_; }

private:
    struct Place {
        bool known = false;
        Vec2 uv{0};
        float width = 0;
    };

    const Place& place(int uvSet) {
        const int set = uvSet == 1 ? 1 : 0;
        Place& at = places_[set];
        if (at.known) return at;
        at.known = true;
        const Vec2* uv = instance_.uv[set];
        if (!uv) return at;
        const Vec2 a = uv[triangle_.x], d1 = uv[triangle_.y] - a, d2 = uv[triangle_.z] - a;
        at.uv = a + d1 * b_.x + d2 * b_.y;
        const float twiceUvArea = std::abs(d1.x * d2.y - d1.y * d2.x);
        if (footprint_ > 0 && twiceArea_ > 0) at.width = footprint_ * std::sqrt(twiceUvArea / twiceArea_);
        return at;
    }

    const InstanceRecord& instance_;
    const UVec3 triangle_;
    const Vec2 b_;
    const float footprint_, twiceArea_;
    const MipFilter mips_;
    Place places_[2];
};

}  // namespace lumi

#pragma once
#include <cmath>

#include "trace/scene_tables.h"

namespace lumi {

/// Texture coordinates of a surface point, and how many of their units a metre of the surface spans.
class TextureLookups {
public:
    TextureLookups(const InstanceRecord& instance, const UVec3& triangle, Vec2 barycentrics, float footprint, float twiceArea)
        : instance_(instance), triangle_(triangle), b_(barycentrics), footprint_(footprint), twiceArea_(twiceArea) {}

    Vec4 operator()(const Texture& texture) {
        const int set = texture.uvSet == 1 ? 1 : 0;
        if (!known_[set]) find(set);
        return texture.sample(uv_[set], width_[set]);
    }

private:
    void find(int set) {
        known_[set] = true;
        const Vec2* uv = instance_.uv[set];
        if (!uv) return;
        const Vec2 a = uv[triangle_.x], d1 = uv[triangle_.y] - a, d2 = uv[triangle_.z] - a;
        uv_[set] = a + d1 * b_.x + d2 * b_.y;
        const float twiceUvArea = std::abs(d1.x * d2.y - d1.y * d2.x);
        if (footprint_ > 0 && twiceArea_ > 0) width_[set] = footprint_ * std::sqrt(twiceUvArea / twiceArea_);
    }

    const InstanceRecord& instance_;
    const UVec3 triangle_;
    const Vec2 b_;
    const float footprint_, twiceArea_;
    bool known_[2] = {false, false};
    Vec2 uv_[2] = {Vec2(0), Vec2(0)};
    float width_[2] = {0, 0};
};

}  // namespace lumi

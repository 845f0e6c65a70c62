#pragma once
#include "trace/scene_tables.h"

namespace lumi {

/// One triangle of an instance that moves while the shutter is open, as it is at one time: a record of its own, with
/// the three corners as its vertices 0, 1 and 2.
class MovingTriangle {
public:
    MovingTriangle(const InstanceRecord& instance, uint32_t primitive, float time);
    MovingTriangle(const MovingTriangle&) = delete;
    MovingTriangle& operator=(const MovingTriangle&) = delete;

    const InstanceRecord& instance() const { return instance_; }
    static constexpr UVec3 kCorners{0, 1, 2};
    /// World-space corner 0, 1 or 2.
    Vec3 corner(int c) const {
        return instance_.inWorld ? positions_[c] : transformPoint(instance_.worldFromObject, positions_[c]);
    }

private:
    InstanceRecord instance_;
    Vec3 positions_[3], normals_[3], restPositions_[3], restNormals_[3], deformedTangents_[3], deformedBitangents_[3];
    Vec4 tangents_[3], colours_[3];
    Vec2 uv_[2][3];
};

}  // namespace lumi

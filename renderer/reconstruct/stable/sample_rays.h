#pragma once
#include "reconstruct/stable/sample_set.h"
#include "trace/tracer.h"

namespace lumi {

/// Rays from a camera to samples, which it sees without lens and shutter.
class SampleRays {
public:
    explicit SampleRays(const CameraPose& camera);

    /// The ray that goes to a sample whose location is known, or through the place of a new one, and its footprint. Returns
    /// the sample's distance, infinite for new ones and the sky. `inWorld`: position or direction; not read for new ones.
    float aim(const SampleLocation& location, Vec2 place, const Vec3& inWorld, PathStart& start) const;
    /// The ray through a place on the screen.
    PathStart through(Vec2 place) const { return cameraStart(camera_, place, Vec2(0.5f), 0); }

private:
    CameraPose camera_;
    Vec3 position_, forward_;
    float pixelSize_;
};

}  // namespace lumi

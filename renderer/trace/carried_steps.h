#pragma once
#include "scene/posed_scene.h"

namespace lumi {

/// At some moment of the open shutter a thing may be flat, and no ray can be carried into its space: it mirrors, or
/// grows from nothing. Its vertices are carried into the world then, at equally spaced steps, and go straight between
/// them.
///
/// How many steps: the moments of its track, or, where it both moves and deforms and vertices go along parabolas from
/// moment to moment, 32 of their intervals or more.
unsigned carriedSteps(const ShutterTrack& track);

/// One of them.
class CarriedStep {
public:
    /// `still`: vertices of what does not deform meanwhile.
    CarriedStep(const ShutterTrack& track, const Vec3* still, unsigned step, unsigned steps);
    Vec3 vertex(size_t i) const {
        return transformPoint(world_, fraction_ > 0 ? glm::mix(from_[i], to_[i], fraction_) : from_[i]);
    }

private:
    Mat4 world_;
    const Vec3* from_;
    const Vec3* to_;
    float fraction_ = 0;
};

}  // namespace lumi

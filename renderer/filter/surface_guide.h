#pragma once
#include "frame/signals.h"

namespace lumi {

/// The noise-free G-buffer that steers an image-space filter, as planes of one extent without gaps between their rows.
/// On the sky inverse depth and normals are 0, which gives every neighbour the weight 0.
struct SurfaceGuide {
    int width = 0, height = 0;
    const float* inverseDepth = nullptr;  ///< 1/m; affine in screen space on a plane, see also orthographicGuide()
    const float* slopeX = nullptr;        ///< d(inverseDepth)/dx per pixel on the tangent plane
    const float* slopeY = nullptr;
    const float* normal[3] = {nullptr, nullptr, nullptr};  ///< world space, unit
    int64_t area() const { return static_cast<int64_t>(width) * height; }
};

/// Of a frame that has InverseDepth, DepthGradient and Normal.
inline SurfaceGuide surfaceGuide(const Signals& signals) {
    SurfaceGuide guide;
    guide.width = signals.extent().width;
    guide.height = signals.extent().height;
    guide.inverseDepth = signals[Signal::InverseDepth].plane(0).data;
    guide.slopeX = signals[Signal::DepthGradient].plane(0).data;
    guide.slopeY = signals[Signal::DepthGradient].plane(1).data;
    for (int c = 0; c < 3; ++c) guide.normal[c] = signals[Signal::Normal].plane(c).data;
    return guide;
}

/// What surfaceGuide() reads.
inline SignalSet surfaceGuideSignals() { return {Signal::InverseDepth, Signal::DepthGradient, Signal::Normal}; }

}  // namespace lumi

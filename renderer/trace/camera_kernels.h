#pragma once
#include "base/isa.h"

namespace lumi {

/// A pinhole camera that does not move, as kernels read it.
struct PinholeView {
    float axisX[3], axisY[3], axisZ[3];  ///< columns of the matrix to the world
    float centreX = 0, centreY = 0;      ///< of the image, pixels
    float pixelSize = 0;                 ///< at view depth 1
};

struct CameraKernels {
    /// Unit world directions through continuous pixels (x[i], y[i]), and the growth of their footprints in metres a
    /// metre: what cameraStart() gives, for `count` pixels of a row.
    void (*pinhole)(const PinholeView& camera, const float* x, const float* y, int count, float* directionX,
                    float* directionY, float* directionZ, float* spread);
};

LUMI_KERNELS(CameraKernels, camera)

}  // namespace lumi

#include "trace/camera_kernels.h"

#include "trace/lane_math.h"

namespace lumi::LUMI_ISA {
namespace {

void pinhole(const PinholeView& camera, const float* __restrict x, const float* __restrict y, int count,
             float* __restrict directionX, float* __restrict directionY, float* __restrict directionZ,
             float* __restrict spread) {
    const PinholeView c = camera;
    for (int i = 0; i < count; ++i) {
        const float filmX = (x[i] - c.centreX) * c.pixelSize, filmY = (c.centreY - y[i]) * c.pixelSize;
        const float inverse = 1 / std::sqrt(filmX * filmX + filmY * filmY + 1);
        const float a = filmX * inverse, b = filmY * inverse, d = -inverse;
        const Lane3 world = {c.axisX[0] * a + c.axisY[0] * b + c.axisZ[0] * d,
                             c.axisX[1] * a + c.axisY[1] * b + c.axisZ[1] * d,
                             c.axisX[2] * a + c.axisY[2] * b + c.axisZ[2] * d};
        const Lane3 direction = unit(world);
        directionX[i] = direction.x, directionY[i] = direction.y, directionZ[i] = direction.z;
        spread[i] = c.pixelSize * inverse;
    }
}

}  // namespace

const CameraKernels& cameraTable() {
    static const CameraKernels table{pinhole};
    return table;
}

}  // namespace lumi::LUMI_ISA

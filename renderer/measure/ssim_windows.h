#pragma once
#include <functional>
#include <optional>

#include "image/image.h"

namespace lumi {

constexpr int kSsimWindow = 11, kSsimBorder = kSsimWindow / 2;  ///< pixels a side, and from its centre to its edge

/// One channel of two images.
struct SsimPlanes {
    ConstFloatPlane a, b;
    /// Given, the planes are linear and are compared as shown: times this, clamped, sRGB encoded. Else they are as they
    /// are.
    std::optional<float> exposureFactor{};
};

/// Values of the windows whose centres are (x + kSsimBorder ..., y + kSsimBorder) for `count` consecutive x.
struct SsimSpan {
    int x = 0, y = 0, count = 0;
    const float *ssim = nullptr, *contrast = nullptr;  ///< SSIM and its contrast-structure part [Wang 2004, eq. 13]
};

/// Gaussian windows of 11x11 pixels, sigma 1.5, at every place fully inside [Wang 2004, sec. III.B]. `take` is called
/// on several threads at once and gives what is to be added up; the sum does not depend on threads. Windows that lie on
/// others' rows and columns are never handed out twice. 0 if no window fits.
double sumOverWindows(const SsimPlanes& planes, const std::function<double(const SsimSpan&)>& take);

}  // namespace lumi

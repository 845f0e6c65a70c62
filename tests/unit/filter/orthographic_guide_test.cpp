#include "filter/orthographic_guide.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumi::test {
namespace {

constexpr Extent2 kExtent{24, 16};
constexpr float kHeight = 4, kRiseX = 0.125f, kRiseY = -0.0625f;

/// A slanted plane from `nearest` metres on, seen by an orthographic camera; the first row is sky.
Signals slanted(float nearest) {
    Signals signals;
    signals.reset(kExtent, surfaceGuideSignals(), 1);
    for (int y = 0; y < kExtent.height; ++y)
        for (int x = 0; x < kExtent.width; ++x) {
            const float depth = nearest + kRiseX * static_cast<float>(x) - kRiseY * static_cast<float>(kExtent.height) +
                                kRiseY * static_cast<float>(y);
            const float inverse = y == 0 ? 0 : 1 / depth;
            signals[Signal::InverseDepth].at(0, x, y) = inverse;
            signals[Signal::DepthGradient].at(0, x, y) = -kRiseX * inverse * inverse;
            signals[Signal::DepthGradient].at(1, x, y) = -kRiseY * inverse * inverse;
        }
    return signals;
}

TEST(OrthographicGuide, IsAffineOnAPlaneHoweverFarTheCameraIs) {
    for (const float nearest : {2.0f, 40.0f}) {
        const Signals signals = slanted(nearest);
        Image planes;
        const SurfaceGuide guide = orthographicGuide(signals, kHeight, planes);
        float least = 2;
        for (int64_t p = kExtent.width; p < kExtent.area(); ++p) {
            EXPECT_NEAR(guide.slopeX[p], -kRiseX / kHeight, 1e-5f);
            EXPECT_NEAR(guide.slopeY[p], -kRiseY / kHeight, 1e-5f);
            least = std::min(least, guide.inverseDepth[p]);
        }
        EXPECT_EQ(least, 1) << "the farthest";
        const int64_t p = 5 * kExtent.width + 3, q = 12 * kExtent.width + 20;
        EXPECT_NEAR(guide.inverseDepth[q] - guide.inverseDepth[p], 17 * guide.slopeX[p] + 7 * guide.slopeY[p], 1e-5f)
            << nearest;
        for (int x = 0; x < kExtent.width; ++x) EXPECT_EQ(guide.inverseDepth[x], 0) << "sky";
    }
}

}  // namespace
}  // namespace lumi::test

#include <algorithm>
#include <cmath>

#include "frame/display.h"
#include "frame/tone_curve_constants.h"

namespace lumi {
namespace {

Vec3 multiply(const float (&m)[9], const Vec3& v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z,
            m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

/// Luminance L becomes L / (1 + L) [Reinhard 2002, eq. 3]; the colour keeps its chromaticity until a channel passes 1.
Vec3 reinhard(const Vec3& c) { return c * (1 / (1 + luminance(c))); }

Vec3 aces(const Vec3& c) {
    const Vec3 v = multiply(kAcesIn, c * kAcesExposure);
    const auto& [a, b, k, d, e] = kAcesCurve;
    return multiply(kAcesOut, (v * (v + a) - b) / (v * (k * v + d) + e));
}

float agxSigmoid(float x) {
    float y = kAgxCurve[0];
    for (int i = 1; i < 7; ++i) y = y * x + kAgxCurve[i];
    return y;
}

Vec3 agx(const Vec3& c) {
    Vec3 v = multiply(kAgxInset, c);
    for (int i = 0; i < 3; ++i) {
        const float ev = std::clamp(std::log2(std::max(v[i], 1e-10f)), kAgxMinEv, kAgxMaxEv);
        v[i] = agxSigmoid((ev - kAgxMinEv) / (kAgxMaxEv - kAgxMinEv));
    }
    v = multiply(kAgxOutset, v);
    for (int i = 0; i < 3; ++i) v[i] = std::pow(std::max(v[i], 0.0f), kAgxGamma);
    return v;
}

}  // namespace

Vec3 toneMap(const Vec3& linear, ToneCurve curve) {
    Vec3 c = glm::min(glm::max(linear, Vec3(0)), Vec3(kBrightest));
    switch (curve) {
        case ToneCurve::Clamp: break;
        case ToneCurve::Reinhard: c = reinhard(c); break;
        case ToneCurve::Aces: c = aces(c); break;
        case ToneCurve::AgX: c = agx(c); break;
    }
    return glm::clamp(c, Vec3(0), Vec3(1));
}

}  // namespace lumi

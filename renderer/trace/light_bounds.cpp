#include "trace/light_bounds.h"

#include <algorithm>
#include <cmath>

namespace lumi {
namespace {

/// Solid angle that the lights shine into, weighted by the cosine [Conty Estevez & Kulla 2018, equation 1].
float orientationMeasure(const LightBounds& b) {
    const float spread = std::acos(std::clamp(b.cosSpread, -1.0f, 1.0f));
    const float reach = std::acos(std::clamp(b.cosReach, -1.0f, 1.0f));
    const float whole = std::min(spread + reach, kPi);
    const float sinSpread = std::sin(spread);
    return 2 * kPi * (1 - b.cosSpread) +
           kPi / 2 * (2 * whole * sinSpread - std::cos(spread - 2 * whole) - 2 * spread * sinSpread + b.cosSpread);
}

float areaOf(const Bounds3& box) {
    const Vec3 s = box.size();
    return 2 * (s.x * s.y + s.y * s.z + s.z * s.x);
}

}  // namespace

float costOf(const LightBounds& b) {
    const float length = glm::length(b.box.size());
    return b.intensity * orientationMeasure(b) * (areaOf(b.box) + 1e-3f * length * length + 1e-20f);
}

LightBounds unite(const LightBounds& a, const LightBounds& b) {
    LightBounds all = a;
    all.box.extend(b.box);
    all.intensity = a.intensity + b.intensity;
    all.cosReach = std::min(a.cosReach, b.cosReach);
    all.bothSides = a.bothSides || b.bothSides;
    // The cone around both spreads; with both sides lit the opposite axis is as good.
    const LightBounds& wide = a.cosSpread <= b.cosSpread ? a : b;
    const LightBounds& narrow = &wide == &a ? b : a;
    float between = glm::dot(wide.axis, narrow.axis);
    const bool flips = all.bothSides && between < 0;
    const Vec3 axis = flips ? -narrow.axis : narrow.axis;
    between = std::clamp(flips ? -between : between, -1.0f, 1.0f);
    all.axis = wide.axis;
    all.cosSpread = wide.cosSpread;
    if (wide.cosSpread <= -1) return all;
    if (narrow.cosSpread >= 1 && between >= wide.cosSpread) return all;
    const float spreadWide = std::acos(std::clamp(wide.cosSpread, -1.0f, 1.0f));
    const float spreadNarrow = std::acos(std::clamp(narrow.cosSpread, -1.0f, 1.0f));
    const float angle = std::acos(between);
    if (angle + spreadNarrow <= spreadWide) return all;
    const float spread = 0.5f * (spreadWide + angle + spreadNarrow);
    const float turn = spread - spreadWide, sine = std::sin(angle);
    const Vec3 turned =
        sine > 1e-4f ? wide.axis * (std::sin(angle - turn) / sine) + axis * (std::sin(turn) / sine) : wide.axis;
    const float length = glm::length(turned);
    // Opposite axes have no middle; nearly equal ones need none, their spread is a little more.
    if (!(spread < kPi) || !(length > 0.5f) || (sine <= 1e-4f && between < 0)) {
        all.cosSpread = -1;
        return all;
    }
    all.axis = turned / length;
    all.cosSpread = std::cos(std::min(spread + (sine > 1e-4f ? 1e-4f : 1e-4f + turn), kPi));
    return all;
}

}  // namespace lumi

#include "scene/animation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lumi {
namespace {

/// The span of keys around a time, and where in it the time lies.
struct Span {
    size_t first = 0, second = 0;
    float t = 0;        ///< in [0, 1]
    float seconds = 0;  ///< length of the span
};

Span findSpan(const std::vector<float>& times, float time) {
    if (!(time > times.front())) return {0, 0, 0, 0};
    const size_t last = times.size() - 1;
    if (time >= times.back()) return {last, last, 0, 0};
    const size_t second = static_cast<size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
    const float start = times[second - 1], seconds = times[second] - start;
    return {second - 1, second, seconds > 0 ? (time - start) / seconds : 0, seconds};
}

Quat quatAt(const float* v) { return {v[3], v[0], v[1], v[2]}; }

void storeUnit(Quat q, float* out) {
    const float length = std::sqrt(glm::dot(q, q));
    q = length > 0 ? q * (1 / length) : Quat(1, 0, 0, 0);
    out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
}

/// Cubic Hermite basis: weights of value 0, tangent 0, value 1, tangent 1 (tangents per unit t).
struct Hermite {
    float p0, m0, p1, m1;
    explicit Hermite(float t) {
        const float t2 = t * t, t3 = t2 * t;
        p0 = 2 * t3 - 3 * t2 + 1, m0 = t3 - 2 * t2 + t;
        p1 = -2 * t3 + 3 * t2, m1 = t3 - t2;
    }
};

/// Catmull-Rom through keys at uneven times: the tangent at a key is the slope between its neighbours; at the ends,
/// the slope of the end span. Rotations follow the shorter way from key to key, then are made unit.
void evaluateCatmullRom(const AnimationChannel& channel, const Span& span, float* out) {
    const size_t n = static_cast<size_t>(channel.components), last = channel.times.size() - 1;
    const size_t keys[4] = {span.first > 0 ? span.first - 1 : 0, span.first, span.second,
                            std::min(span.second + 1, last)};
    const bool rotation = channel.property == AnimatedProperty::Rotation;
    float sign[4] = {1, 1, 1, 1};
    for (int k = 1; rotation && k < 4; ++k) {
        const float dot = glm::dot(quatAt(&channel.values[keys[k - 1] * n]), quatAt(&channel.values[keys[k] * n]));
        sign[k] = dot < 0 ? -sign[k - 1] : sign[k - 1];
    }
    const auto slope = [&](int a, int b, size_t c) {
        const float seconds = channel.times[keys[b]] - channel.times[keys[a]];
        const float rise = sign[b] * channel.values[keys[b] * n + c] - sign[a] * channel.values[keys[a] * n + c];
        return seconds > 0 ? rise / seconds : 0;
    };
    const Hermite basis(span.t);
    for (size_t c = 0; c < n; ++c)
        out[c] = basis.p0 * sign[1] * channel.values[keys[1] * n + c] + basis.m0 * span.seconds * slope(0, 2, c) +
                 basis.p1 * sign[2] * channel.values[keys[2] * n + c] + basis.m1 * span.seconds * slope(1, 3, c);
}

}  // namespace

void AnimationChannel::evaluate(float time, float* out) const {
    assert(!times.empty());
    const Span span = findSpan(times, time);
    const size_t n = static_cast<size_t>(components);
    const bool cubic = interpolation == Interpolation::CubicSpline;
    // CubicSpline stores three rows a key: in-tangent, value, out-tangent.
    const auto value = [&](size_t key) { return &values[(cubic ? 3 * key + 1 : key) * n]; };
    const bool rotation = property == AnimatedProperty::Rotation;

    if (span.first == span.second || interpolation == Interpolation::Step) {
        std::copy_n(value(span.first), n, out);
    } else if (cubic) {
        const Hermite basis(span.t);
        const float* outTangent = &values[(3 * span.first + 2) * n];
        const float* inTangent = &values[3 * span.second * n];
        for (size_t c = 0; c < n; ++c)
            out[c] = basis.p0 * value(span.first)[c] + basis.m0 * span.seconds * outTangent[c] +
                     basis.p1 * value(span.second)[c] + basis.m1 * span.seconds * inTangent[c];
    } else if (interpolation == Interpolation::CatmullRom) {
        evaluateCatmullRom(*this, span, out);
    } else if (rotation) {
        float a[4], b[4];
        storeUnit(quatAt(value(span.first)), a);
        storeUnit(quatAt(value(span.second)), b);
        storeUnit(glm::slerp(quatAt(a), quatAt(b), span.t), out);
        return;
    } else {
        for (size_t c = 0; c < n; ++c) out[c] = (1 - span.t) * value(span.first)[c] + span.t * value(span.second)[c];
    }
    if (rotation) storeUnit(quatAt(out), out);
}

}  // namespace lumi

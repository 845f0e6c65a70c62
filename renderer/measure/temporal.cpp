#include "measure/temporal.h"

#include <cmath>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr float kDepthTolerance = 0.05f;

Vec3 colourAt(const Image& image, int x, int y) { return {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)}; }

bool finite(const Image& image, int x, int y) {
    const Vec3 c = colourAt(image, x, y);
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

/// Luminance as shown; NaN where the pixel is not finite.
Image shownLuminance(const Image& linear, float exposureEv) {
    const Image shown = ldrImage(linear, exposureEv);
    Image out(linear.extent(), 1);
    parallelRanges(linear.height(), 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < linear.width(); ++x)
                out.at(0, x, y) = finite(linear, x, y) ? luminance(colourAt(shown, x, y)) : std::nanf("");
    });
    return out;
}

/// Bilinear value of the previous frame where a pixel's point was, or nothing if that cannot be known.
class Follower {
public:
    Follower(const TemporalPair& pair, const Image& previous) : pair_(pair), previous_(previous) {}

    bool follow(int x, int y, float& value) const {
        const Image& motion = *pair_.motion;
        const float px = static_cast<float>(x) + motion.at(0, x, y), py = static_cast<float>(y) + motion.at(1, x, y);
        if (!(px >= 0 && py >= 0 && px <= static_cast<float>(previous_.width() - 1) &&
              py <= static_cast<float>(previous_.height() - 1)))
            return false;
        const int left = static_cast<int>(px), top = static_cast<int>(py);
        const float fx = px - static_cast<float>(left), fy = py - static_cast<float>(top);
        value = 0;
        for (int tap = 0; tap < 4; ++tap) {
            const int dx = tap & 1, dy = tap >> 1;
            const float weight = (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
            if (weight == 0) continue;
            if (!sameSurface(x, y, left + dx, top + dy)) return false;
            value += weight * previous_.at(0, left + dx, top + dy);
        }
        return true;
    }

private:
    bool sameSurface(int x, int y, int px, int py) const {
        if (!pair_.depth || !pair_.previousDepth) return true;
        const float depth = pair_.depth->at(0, x, y), seen = pair_.previousDepth->at(0, px, py);
        if (std::isinf(depth) || std::isinf(seen)) return std::isinf(depth) && std::isinf(seen);  // the sky stays the sky
        const float was = depth + (pair_.motion->channels() > 2 ? pair_.motion->at(2, x, y) : 0);
        return std::abs(seen - was) <= kDepthTolerance * std::abs(was);
    }

    const TemporalPair& pair_;
    const Image& previous_;
};

Measurement difference(const TemporalPair& pair, bool follows, bool wantMap) {
    const Image now = shownLuminance(pair.image, pair.exposureEv), before = shownLuminance(pair.previous, pair.exposureEv);
    const Follower follower(pair, before);
    Image map(now.extent(), 1);
    double sum = 0;
    int64_t count = 0, asked = 0, broken = 0;
    for (int y = 0; y < now.height(); ++y) {
        double row = 0;
        for (int x = 0; x < now.width(); ++x) {
            broken += std::isnan(now.at(0, x, y)) || std::isnan(before.at(0, x, y));
            if (pair.mask && !(pair.mask->at(0, x, y) > 0.5f)) continue;
            ++asked;
            float earlier = before.at(0, x, y);
            if (follows && pair.motion && !follower.follow(x, y, earlier)) continue;
            const float error = std::abs(now.at(0, x, y) - earlier);
            if (!std::isfinite(error)) continue;
            map.at(0, x, y) = error;
            row += error;
            ++count;
        }
        sum += row;
    }
    Measurement result;
    result.value = count > 0 ? sum / static_cast<double>(count) : std::nan("");
    result.details.emplace_back("nonfinite_pixels", static_cast<double>(broken));
    if (follows)
        result.details.emplace_back("covered", asked > 0 ? static_cast<double>(count) / static_cast<double>(asked) : 0.0);
    if (wantMap) result.map = std::move(map);
    return result;
}

}  // namespace

const std::vector<SequenceMetric>& sequenceMetricCatalog() {
    static const std::vector<SequenceMetric> catalog = {
        {"temporal", "Temporal error", "Mean absolute difference of the luminances of consecutive tone-mapped frames in [0,1]; for static views."},
        {"temporal_reprojected", "Reprojected temporal error", "The same after following the reference's motion, over the points that the frame before saw: what moves is no flicker."},
        {"lag", "Lag", "Frames after a step of the light until the output's response to it, in linear luminance, is 0.9."},
    };
    return catalog;
}

Measurement measureTemporal(const TemporalPair& pair, bool wantMap) { return difference(pair, false, wantMap); }
Measurement measureReprojectedTemporal(const TemporalPair& pair, bool wantMap) { return difference(pair, true, wantMap); }

LagMeter::LagMeter(const Image& before, const Image& after, const Image* mask)
    : before_(before.extent(), 1), step_(before.extent(), 1), first_(before.extent(), 1) {
    first_.fill(-1);
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            if ((mask && !(mask->at(0, x, y) > 0.5f)) || !finite(before, x, y) || !finite(after, x, y)) continue;
            const float low = luminance(colourAt(before, x, y)), change = luminance(colourAt(after, x, y)) - low;
            before_.at(0, x, y) = low;
            step_.at(0, x, y) = change;
            largest_ = std::max(largest_, std::abs(change));
            squares_ += static_cast<double>(change) * change;
        }
}

void LagMeter::add(const Image& frame) {
    double sum = 0;
    const auto number = static_cast<float>(curve_.size());
    for (int y = 0; y < frame.height(); ++y)
        for (int x = 0; x < frame.width(); ++x) {
            const float change = step_.at(0, x, y);
            // A broken pixel has not moved.
            if (change == 0 || !finite(frame, x, y)) continue;
            const float moved = luminance(colourAt(frame, x, y)) - before_.at(0, x, y);
            sum += static_cast<double>(moved) * change;
            if (first_.at(0, x, y) < 0 && moved / change >= static_cast<float>(kReached)) first_.at(0, x, y) = number;
        }
    curve_.push_back(squares_ > 0 ? sum / squares_ : std::nan(""));
}

int64_t LagMeter::lag() const {
    for (size_t i = 0; i < curve_.size(); ++i)
        if (curve_[i] >= kReached) return static_cast<int64_t>(i);
    return -1;
}

Image LagMeter::map() const {
    Image out(first_.extent(), 1);
    for (size_t i = 0; i < out.size(); ++i) {
        if (std::abs(step_.data()[i]) < 0.01f * largest_ || step_.data()[i] == 0) continue;
        out.data()[i] = first_.data()[i] < 0 ? static_cast<float>(curve_.size()) : first_.data()[i];
    }
    return out;
}

}  // namespace lumi

#include "measure/lag.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "math/colour.h"

namespace lumi {
namespace {

Vec3 colourAt(const Image& image, int x, int y) { return {image.at(0, x, y), image.at(1, x, y), image.at(2, x, y)}; }

bool finite(const Vec3& c) { return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z); }

/// Sum of |b - a| over that of |a| + |b|, of luminances, over what counts; 0 for two black frames.
double relativeChange(const Image& before, const Image& after, const Image* mask) {
    double change = 0, light = 0;
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            if (mask && !(mask->at(0, x, y) > 0.5f)) continue;
            const Vec3 a = colourAt(before, x, y), b = colourAt(after, x, y);
            if (!finite(a) || !finite(b)) continue;
            const double from = luminance(a), to = luminance(b);
            change += std::abs(to - from);
            light += std::abs(from) + std::abs(to);
        }
    return light > 0 ? change / light : 0;
}

}  // namespace

LagMeter::LagMeter(const Image& before, const Image& after, const Image* mask)
    : before_(before.extent(), 1), step_(before.extent(), 1), first_(before.extent(), 1) {
    first_.fill(-1);
    for (int y = 0; y < before.height(); ++y)
        for (int x = 0; x < before.width(); ++x) {
            const Vec3 from = colourAt(before, x, y), to = colourAt(after, x, y);
            if ((mask && !(mask->at(0, x, y) > 0.5f)) || !finite(from) || !finite(to)) continue;
            const float low = luminance(from), change = luminance(to) - low;
            before_.at(0, x, y) = low;
            step_.at(0, x, y) = change;
            largest_ = std::max(largest_, std::abs(change));
            squares_ += static_cast<double>(change) * change;
        }
}

void LagMeter::add(const Image& frame) {
    double sum = 0, squares = 0;
    const auto number = static_cast<float>(curve_.size());
    for (int y = 0; y < frame.height(); ++y)
        for (int x = 0; x < frame.width(); ++x) {
            const float change = step_.at(0, x, y);
            const Vec3 colour = colourAt(frame, x, y);
            nonFinite_ += !finite(colour);
            if (change == 0 || !finite(colour)) continue;
            const float moved = luminance(colour) - before_.at(0, x, y);
            sum += static_cast<double>(moved) * change;
            squares += static_cast<double>(change) * change;
            if (first_.at(0, x, y) < 0 && moved / change >= static_cast<float>(kReached)) first_.at(0, x, y) = number;
        }
    curve_.push_back(squares > 0 ? sum / squares : std::nan(""));
}

Lag LagMeter::lag(int64_t stepFrame) const {
    Lag result{std::nan(""), stepFrame, curve_, nonFinite_, ""};
    const auto reached =
        std::find_if(curve_.begin(), curve_.end(), [](double response) { return response >= kReached; });
    if (reached != curve_.end()) result.value = static_cast<double>(reached - curve_.begin());
    else if (!changes()) result.reason = "the step changes nothing that counts";
    else if (std::all_of(curve_.begin(), curve_.end(), [](double v) { return std::isnan(v); }))
        result.reason = "no pixel that the step changes is finite";
    else result.reason = fmt::format("not reached within {} frames", curve_.size());
    return result;
}

Image LagMeter::map() const {
    Image out(first_.extent(), 1);
    for (size_t i = 0; i < out.size(); ++i) {
        if (std::abs(step_.data()[i]) < 0.01f * largest_ || step_.data()[i] == 0) continue;
        out.data()[i] = first_.data()[i] < 0 ? static_cast<float>(curve_.size()) : first_.data()[i];
    }
    return out;
}

void LagSequence::add(int64_t number, const Image& image, const Image& reference, const Image* mask) {
    if (!previous_.empty()) {
        if (number != previousNumber_ + 1 && firstMissing_ < 0) firstMissing_ = previousNumber_ + 1;
        const double change = relativeChange(previous_, reference, mask);
        changes_.push_back(change);
        // Until the end each frame that changes more than any before it is taken for the step.
        if (!meter_ || change > stepChange_) {
            meter_.emplace(previous_, reference, mask);
            stepChange_ = change;
            stepFrame_ = number;
        }
    }
    if (meter_) meter_->add(image);
    previous_ = reference;
    previousNumber_ = number;
}

bool LagSequence::hasStep() const {
    if (!meter_ || !meter_->changes() || stepChange_ < kLeastChange) return false;
    std::vector<double> sorted = changes_;
    std::sort(sorted.begin(), sorted.end());
    return sorted.size() < 2 || stepChange_ >= kAboveUsual * sorted[(sorted.size() - 1) / 2];
}

Lag LagSequence::result() const {
    Lag none{std::nan(""), -1, {}, 0, ""};
    if (changes_.empty()) none.reason = "there is one frame only";
    else if (firstMissing_ >= 0) none.reason = fmt::format("frame {} is missing", firstMissing_);
    else if (!hasStep()) none.reason = "the reference's light makes no step";
    return none.reason.empty() ? meter_->lag(stepFrame_) : none;
}

Image LagSequence::map() const { return firstMissing_ < 0 && hasStep() ? meter_->map() : Image(); }

}  // namespace lumi

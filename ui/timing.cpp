#include "ui/timing.h"

#include <algorithm>
#include <cmath>

namespace lumi {

void UiTiming::add(double ms) {
    if (frames_.size() < kFrames) {
        frames_.push_back(ms);
        return;
    }
    frames_[next_] = ms;
    next_ = (next_ + 1) % kFrames;
}

std::vector<float> UiTiming::history() const {
    std::vector<float> ordered;
    ordered.reserve(frames_.size());
    for (size_t i = 0; i < frames_.size(); ++i)
        ordered.push_back(static_cast<float>(frames_[(next_ + i) % frames_.size()]));
    return ordered;
}

double UiTiming::percentile(double fraction) const {
    if (frames_.empty()) return 0;
    std::vector<double> sorted = frames_;
    std::sort(sorted.begin(), sorted.end());
    const double rank = std::ceil(fraction * static_cast<double>(sorted.size())) - 1;
    return sorted[static_cast<size_t>(std::clamp(rank, 0.0, static_cast<double>(sorted.size() - 1)))];
}

}  // namespace lumi

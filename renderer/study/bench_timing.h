#pragma once
#include <algorithm>
#include <functional>
#include <stop_token>
#include <vector>

#include "base/error.h"
#include "base/timer.h"
#include "math/statistics.h"

namespace lumi {

/// Milliseconds of repeated runs.
class RunTimes {
public:
    void add(double ms) { times_.push_back(ms); }
    size_t count() const { return times_.size(); }
    double median() const { return lumi::median(times_); }
    /// (slowest - fastest) / median.
    double spread() const {
        if (times_.empty()) return 0;
        const auto [fastest, slowest] = std::minmax_element(times_.begin(), times_.end());
        return (*slowest - *fastest) / std::max(median(), 1e-9);
    }

private:
    std::vector<double> times_;
};

inline void throwIfStopped(const std::stop_token& stop) {
    if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
}

inline double timeOf(const std::function<void()>& body) {
    const Timer timer;
    body();
    return timer.elapsedMs();
}

/// Times of two things that run in turn, so that what else the machine does meets both alike.
struct PairedTimes {
    RunTimes own, limit;
};

/// At least 5 rounds, and more for quick ones: up to 25, until a second and a half is spent.
inline PairedTimes timeInTurn(const std::function<void()>& own, const std::function<void()>& limit,
                              const std::stop_token& stop) {
    constexpr size_t kLeastRounds = 5, kMostRounds = 25;
    constexpr double kEnoughMs = 1500;
    PairedTimes times;
    const Timer total;
    while (times.own.count() < kLeastRounds || (times.own.count() < kMostRounds && total.elapsedMs() < kEnoughMs)) {
        throwIfStopped(stop);
        times.own.add(timeOf(own));
        times.limit.add(timeOf(limit));
    }
    return times;
}

}  // namespace lumi

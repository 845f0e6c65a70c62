#pragma once
#include <ctime>
#include <vector>

namespace lumi {

/// CPU milliseconds of the calling thread.
inline double threadCpuMs() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// The UI thread's own work a frame: its CPU time outside OpenGL calls, over the last kFrames frames.
class UiTiming {
public:
    static constexpr size_t kFrames = 600;

    void add(double ms);
    size_t count() const { return frames_.size(); }
    double median() const { return percentile(0.5); }
    double p99() const { return percentile(0.99); }
    double worst() const { return percentile(1); }
    /// Oldest first, for the graph.
    std::vector<float> history() const;

private:
    double percentile(double fraction) const;

    std::vector<double> frames_;
    size_t next_ = 0;
};

}  // namespace lumi

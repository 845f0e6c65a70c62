#pragma once
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace lumi {

/// Wall-clock milliseconds since construction or restart().
class Timer {
public:
    Timer() { restart(); }
    void restart() { start_ = std::chrono::steady_clock::now(); }
    double elapsedMs() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_;
};

/// Milliseconds by stage of one frame, in the order the stages first ran. Stages of a module are `<module>.<stage>`.
class StageTimer {
public:
    /// Adds the time until it goes out of scope to `stage`.
    class Scope {
    public:
        Scope(StageTimer& owner, std::string stage) : owner_(owner), stage_(std::move(stage)) {}
        ~Scope() { owner_.add(stage_, timer_.elapsedMs()); }
        Scope(const Scope&) = delete;
        Scope& operator=(const Scope&) = delete;

    private:
        StageTimer& owner_;
        std::string stage_;
        Timer timer_;
    };

    Scope measure(std::string stage) { return Scope(*this, prefix_ + std::move(stage)); }
    void setPrefix(std::string prefix) { prefix_ = std::move(prefix); }

    void add(const std::string& stage, double ms) {
        for (auto& entry : stages_)
            if (entry.first == stage) {
                entry.second += ms;
                return;
            }
        stages_.emplace_back(stage, ms);
    }
    void clear() { stages_.clear(); }
    const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

private:
    std::string prefix_;
    std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace lumi

#pragma once
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace lumi {

/// Large scratch that tasks borrow, one each, so that it is not made anew for each of them: there are at most as many
/// as ran at a time. Any thread may take and give back.
template <class T>
class Spares {
public:
    /// One that was given back, as it was left, or a new one.
    std::unique_ptr<T> take() {
        const std::lock_guard lock(mutex_);
        if (spare_.empty()) return std::make_unique<T>();
        std::unique_ptr<T> taken = std::move(spare_.back());
        spare_.pop_back();
        return taken;
    }
    void giveBack(std::unique_ptr<T> taken) {
        const std::lock_guard lock(mutex_);
        spare_.push_back(std::move(taken));
    }

private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> spare_;
};

}  // namespace lumi

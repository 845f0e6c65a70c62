#pragma once
#include <memory>
#include <mutex>
#include <vector>

#include "frame/signals.h"

namespace lumi {

/// Signals to trace into. What nobody holds any more is lent again, so that a frame allocates nothing. Others may let
/// go of them on any thread, also after the pool is gone: the lock orders what they read before what is written next.
class SignalsPool {
public:
    std::shared_ptr<Signals> take() {
        const std::lock_guard lock(shelf_->mutex);
        if (shelf_->free.empty()) {
            shelf_->all.push_back(std::make_unique<Signals>());
            shelf_->free.reserve(shelf_->all.size());  // handing back never allocates
            shelf_->free.push_back(shelf_->all.back().get());
        }
        Signals* signals = shelf_->free.back();
        shelf_->free.pop_back();
        return {signals, [shelf = shelf_](Signals* done) {
                    const std::lock_guard returning(shelf->mutex);
                    shelf->free.push_back(done);
                }};
    }
    /// Of all, lent or not; while none is being written.
    size_t byteCount() const {
        const std::lock_guard lock(shelf_->mutex);
        size_t bytes = 0;
        for (const auto& signals : shelf_->all) bytes += signals->bytes();
        return bytes;
    }

private:
    struct Shelf {
        std::mutex mutex;
        std::vector<std::unique_ptr<Signals>> all;
        std::vector<Signals*> free;
    };
    std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace lumi

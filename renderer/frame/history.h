#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lumi {

/// What a method keeps from one frame to the next, as the transaction that reconstruct/module.h asks for:
///
///     const auto step = history.begin(context.frame, context.changes.cut);
///     ... read *step.previous (if any), write the whole of step.next; leave early where stopped ...
///     history.commit();
///
/// begin() with a new number builds on the last committed frame; with the same number again it builds on the frame
/// before that, so that the result is replaced. What was begun and not committed leaves no trace.
template <class T>
class FrameHistory {
public:
    struct Step {
        const T* previous;  ///< null after a cut, or where there is no frame before
        T& next;            ///< contents undefined; keeps the memory of an older frame
    };

    Step begin(int64_t frame, bool cut) {
        pending_ = frame;
        const int from = frame == frame_ ? order_[0] : order_[1];
        const bool known = frame == frame_ ? committed_ > 1 : committed_ > 0;
        return {known && !cut ? &slots_[static_cast<size_t>(from)] : nullptr, slots_[static_cast<size_t>(order_[2])]};
    }

    void commit() {
        if (pending_ == frame_) {
            std::swap(order_[1], order_[2]);
            return;
        }
        order_ = {order_[1], order_[2], order_[0]};
        frame_ = pending_;
        if (committed_ < 2) ++committed_;
    }

    /// Forgets all frames and frees their memory.
    void clear() { *this = FrameHistory(); }
    /// The last committed frame; meaningless before the first commit().
    const T& current() const { return slots_[static_cast<size_t>(order_[1])]; }
    /// The frame that the last committed one was built on.
    const T& previous() const { return slots_[static_cast<size_t>(order_[0])]; }
    bool empty() const { return committed_ == 0; }

    template <class Bytes>
    size_t byteCount(Bytes bytesOf) const {
        return bytesOf(slots_[0]) + bytesOf(slots_[1]) + bytesOf(slots_[2]);
    }

private:
    std::array<T, 3> slots_;
    std::array<int, 3> order_{0, 1, 2};  ///< previous, current, next
    int64_t frame_ = -1, pending_ = -1;
    int committed_ = 0;
};

}  // namespace lumi

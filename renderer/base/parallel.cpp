#include "base/parallel.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <memory>

namespace lumi {
namespace {

std::atomic<bool> lowPriority{false};

/// Prepares each thread that joins the pool.
class WorkerSetup : public tbb::task_scheduler_observer {
public:
    WorkerSetup() { observe(true); }
    void on_scheduler_entry(bool isWorker) override {
        flushDenormals();
        if (isWorker && lowPriority) setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 10);
    }
};

std::unique_ptr<tbb::global_control>& threadLimit() {
    static std::unique_ptr<tbb::global_control> limit;
    return limit;
}

/// Lives until the process ends: TBB's own statics may be gone before ours would be.
void ensureSetup() {
    static WorkerSetup* const setup = new WorkerSetup;
    static_cast<void>(setup);
}

/// What came before a loop happens before each of its calls, and these before what follows it. TBB sees to that;
/// ThreadSanitizer cannot look into TBB and is told. Nothing in other builds.
class LoopOrder {
public:
#ifdef __SANITIZE_THREAD__
    ~LoopOrder() { calls_.load(std::memory_order_acquire); }

    class Call {
    public:
        explicit Call(LoopOrder& order) : calls_(order.calls_) { calls_.load(std::memory_order_acquire); }
        ~Call() { calls_.fetch_add(1, std::memory_order_release); }

    private:
        std::atomic<int64_t>& calls_;
    };

    LoopOrder() { calls_.store(0, std::memory_order_release); }

private:
    std::atomic<int64_t> calls_;
#else
    struct Call {
        explicit Call(LoopOrder&) {}
        ~Call() {}
    };
#endif
};

}  // namespace

void setThreadCount(int count) {
    threadLimit().reset();
    if (count > 0)
        threadLimit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                              static_cast<size_t>(count));
}

int threadCount() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void lowerWorkerPriority() { lowPriority = true; }

void flushDenormals() {
    // Bit 15 is flush-to-zero, bit 6 denormals-are-zero.
    _mm_setcsr(_mm_getcsr() | 0x8040u);
}

void parallelRanges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body,
                    std::stop_token stop) {
    ensureSetup();
    if (count <= 0) return;
    grain = std::max<int64_t>(grain, 1);
    const int64_t blocks = (count + grain - 1) / grain;
    LoopOrder order;
    tbb::parallel_for(
        tbb::blocked_range<int64_t>(0, blocks, 1),
        [&](const tbb::blocked_range<int64_t>& range) {
            const LoopOrder::Call call(order);
            flushDenormals();
            for (int64_t block = range.begin(); block != range.end(); ++block) {
                if (stop.stop_requested()) return;
                body(block * grain, std::min(count, (block + 1) * grain));
            }
        },
        tbb::simple_partitioner());
}

void parallelFor(int64_t count, const std::function<void(int64_t)>& body, std::stop_token stop) {
    parallelRanges(
        count, 1, [&](int64_t begin, int64_t) { body(begin); }, stop);
}

void parallelInvoke(const std::function<void()>& a, const std::function<void()>& b) {
    ensureSetup();
    LoopOrder order;
    const auto ordered = [&](const std::function<void()>& body) {
        return [&] {
            const LoopOrder::Call call(order);
            body();
        };
    };
    tbb::parallel_invoke(ordered(a), ordered(b));
}

}  // namespace lumi

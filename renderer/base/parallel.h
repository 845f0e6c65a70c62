#pragma once
#include <cstdint>
#include <functional>
#include <stop_token>

namespace lumi {

/// The one pool of worker threads. This is the only place that knows TBB.
///
/// Threads that run our loops have flush-to-zero and denormals-are-zero set (Embree asks for it, and a denormal in a
/// filter costs hundreds of cycles) and, after lowerWorkerPriority(), run below the UI thread's priority.

/// Limits all later loops to `count` threads; 0 means one for each core. Call before the first loop of a program.
void setThreadCount(int count);
int threadCount();

/// Makes worker threads give way to the UI thread (nice +10 for each worker as it joins the pool).
void lowerWorkerPriority();

/// Sets FTZ and DAZ on the calling thread. Workers have them set already.
void flushDenormals();

/// Calls body(begin, end) for disjoint ranges that cover [0, count), each at most `grain` long, on all threads.
/// Ranges are multiples of `grain` (but the last), so what one call sees never depends on the thread count.
/// A requested stop skips ranges that have not begun. Exceptions of `body` reach the caller.
void parallelRanges(int64_t count, int64_t grain, const std::function<void(int64_t, int64_t)>& body,
                    std::stop_token stop = {});

/// Calls body(index) for each index in [0, count).
void parallelFor(int64_t count, const std::function<void(int64_t)>& body, std::stop_token stop = {});

/// Runs both on the pool and returns when both are done.
void parallelInvoke(const std::function<void()>& a, const std::function<void()>& b);

}  // namespace lumi

#include <gtest/gtest.h>
#include <xmmintrin.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/parallel.h"

namespace lumi {
namespace {

using Ranges = std::set<std::pair<int64_t, int64_t>>;

Ranges rangesOf(int64_t count, int64_t grain) {
    Ranges ranges;
    std::mutex mutex;
    parallelRanges(count, grain, [&](int64_t begin, int64_t end) {
        const std::lock_guard lock(mutex);
        EXPECT_TRUE(ranges.insert({begin, end}).second);
    });
    return ranges;
}

TEST(Parallel, RangesCoverOnceAndDoNotDependOnThreads) {
    for (const int64_t count : {int64_t(0), int64_t(1), int64_t(16), int64_t(1000), int64_t(1001)})
        for (const int64_t grain : {int64_t(1), int64_t(16), int64_t(5000)}) {
            std::vector<Ranges> all;
            for (const int threads : {1, 2, 8}) {
                setThreadCount(threads);
                all.push_back(rangesOf(count, grain));
            }
            EXPECT_EQ(all[0], all[1]);
            EXPECT_EQ(all[0], all[2]);
            int64_t next = 0;
            for (const auto& [begin, end] : all[0]) {
                EXPECT_EQ(begin, next);
                EXPECT_LE(end - begin, grain);
                EXPECT_EQ(begin % grain, 0);
                next = end;
            }
            EXPECT_EQ(next, count);
        }
    setThreadCount(0);
}

TEST(Parallel, NonsenseGrainsAndCountsAreHarmless) {
    EXPECT_TRUE(rangesOf(-5, 4).empty());
    EXPECT_EQ(rangesOf(3, 0).size(), 3u);
}

TEST(Parallel, IndicesEachOnce) {
    std::vector<std::atomic<int>> hits(5000);
    parallelFor(5000, [&](int64_t i) { ++hits[static_cast<size_t>(i)]; });
    for (const auto& hit : hits) ASSERT_EQ(hit, 1);
}

TEST(Parallel, ExceptionsReachTheCaller) {
    for (const int threads : {1, 2}) {
        setThreadCount(threads);
        EXPECT_THROW(parallelFor(100,
                                 [](int64_t i) {
                                     if (i == 57) throw std::runtime_error("57");
                                 }),
                     std::runtime_error);
    }
    setThreadCount(0);
    // The pool works on afterwards.
    EXPECT_EQ(rangesOf(10, 1).size(), 10u);
}

TEST(Parallel, AStopSkipsWhatHasNotBegun) {
    std::stop_source source;
    std::atomic<int> done = 0;
    parallelFor(
        100000,
        [&](int64_t) {
            if (++done == 10) source.request_stop();
        },
        source.get_token());
    EXPECT_GE(done, 10);
    EXPECT_LT(done, 1000);
    done = 0;
    parallelFor(
        100, [&](int64_t) { ++done; }, source.get_token());
    EXPECT_EQ(done, 0);
}

TEST(Parallel, LoopsMayNest) {
    std::atomic<int> sum = 0;
    parallelFor(20, [&](int64_t) { parallelFor(20, [&](int64_t) { ++sum; }); });
    EXPECT_EQ(sum, 400);
    parallelInvoke([&] { ++sum; }, [&] { ++sum; });
    EXPECT_EQ(sum, 402);
}

TEST(Parallel, ThreadCountIsWhatWasSet) {
    setThreadCount(3);
    EXPECT_EQ(threadCount(), 3);
    setThreadCount(0);
    EXPECT_GE(threadCount(), 1);
}

TEST(Parallel, DenormalsAreFlushedInLoops) {
    std::atomic<int> wrong = 0;
    std::thread([&] {
        parallelFor(200, [&](int64_t) {
            if ((_mm_getcsr() & 0x8040u) != 0x8040u) ++wrong;
        });
    }).join();
    EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace lumi

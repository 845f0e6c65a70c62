#include "study/bench_memory.h"

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <numeric>

#include "base/memory.h"
#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kStreamGrain = 1 << 16;

}  // namespace

MemoryPeak::MemoryPeak() {
    malloc_trim(0);
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;  // forgets the peak: proc(5)
    good_ = reset.good();
    before_ = residentBytes();
}

std::optional<uint64_t> MemoryPeak::bytes() const {
    if (!good_) return std::nullopt;
    const uint64_t peak = peakResidentBytes();
    return peak > before_ ? peak - before_ : 0;
}

MemoryStream::MemoryStream(size_t bytes) : values_(std::max<size_t>(bytes / sizeof(float), 1), 1.0f) {
    const int64_t count = static_cast<int64_t>(values_.size());
    sums_.resize(static_cast<size_t>((count + kStreamGrain - 1) / kStreamGrain));
}

void MemoryStream::run() {
    parallelRanges(static_cast<int64_t>(values_.size()), kStreamGrain, [&](int64_t begin, int64_t end) {
        // Eight sums side by side keep the loop waiting for memory, not for additions.
        float sums[8] = {};
        int64_t i = begin;
        for (; i + 8 <= end; i += 8)
            for (int64_t k = 0; k < 8; ++k) sums[k] += values_[static_cast<size_t>(i + k)];
        for (; i < end; ++i) sums[0] += values_[static_cast<size_t>(i)];
        sums_[static_cast<size_t>(begin / kStreamGrain)] = std::accumulate(sums, sums + 8, 0.0);
    });
    sum_ = std::accumulate(sums_.begin(), sums_.end(), 0.0);
}

}  // namespace lumi

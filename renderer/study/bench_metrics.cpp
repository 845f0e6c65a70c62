#include "study/bench_metrics.h"

#include <malloc.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <optional>
#include <string>

#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"
#include "measure/measure.h"
#include "study/bench_timing.h"

namespace lumi {
namespace {

constexpr Extent2 kMetricExtent{1920, 1080};
constexpr int64_t kStreamGrain = 1 << 16;
constexpr double kMiB = 1024 * 1024;

/// A smooth image with noise on it, always the same.
Image noisyImage(float noise) {
    Image image(kMetricExtent, 3);
    parallelRanges(kMetricExtent.height, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < kMetricExtent.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const uint32_t key = hashCombine(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(c));
                    const float smooth = 0.4f + 0.3f * static_cast<float>((x / 60 + y / 60) % 2) * (c == 1 ? 0.7f : 1.0f);
                    image.at(c, x, y) = smooth + noise * (unitFloat(key) - 0.5f);
                }
    });
    return image;
}

/// The highest resident size of the process since it was made, above what it had then.
class MemoryPeak {
public:
    MemoryPeak() {
        malloc_trim(0);
        std::ofstream reset("/proc/self/clear_refs");
        reset << "5" << std::flush;  // forgets the peak: proc(5)
        good_ = reset.good();
        before_ = residentBytes();
    }
    /// Nothing where the system does not tell.
    std::optional<uint64_t> bytes() const {
        std::ifstream status("/proc/self/status");
        for (std::string line; good_ && std::getline(status, line);)
            if (line.starts_with("VmHWM:")) {
                const uint64_t peak = std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
                return peak > before_ ? peak - before_ : 0;
            }
        return std::nullopt;
    }

private:
    bool good_ = false;
    uint64_t before_ = 0;
};

}  // namespace

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

std::vector<std::string> benchedMetrics() {
    std::vector<std::string> ids;
    for (const Metric& metric : metricCatalog()) ids.emplace_back(metric.id);
    return ids;
}

void benchMetric(const std::string& id, const std::string& name, const std::stop_token& stop, const BenchOutput& output) {
    const Metric& metric = findMetric(id);
    ImagePair pair{noisyImage(0.1f), noisyImage(0), {}, 0};
    pair.prepare();
    const size_t bytes = pair.image.bytes() + pair.reference.bytes();
    MemoryStream stream(bytes);
    const auto own = [&] { metric.measure(pair, false); };
    const MemoryPeak peak;
    own();
    const std::optional<uint64_t> allocated = peak.bytes();
    const PairedTimes times = timeInTurn(own, [&] { stream.run(); }, stop);
    const double megapixels = static_cast<double>(kMetricExtent.area()) / 1e6;
    output({name, megapixels / times.own.median() * 1000, "Mpixel/s", times.own.median(), times.own.spread(),
            megapixels / times.limit.median() * 1000});
    if (!allocated) return;
    output({"memory/" + name, static_cast<double>(*allocated) / kMiB, "MiB", 0, 0, static_cast<double>(bytes) / kMiB});
}

}  // namespace lumi

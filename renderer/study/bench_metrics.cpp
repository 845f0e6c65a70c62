#include "study/bench_metrics.h"

#include <optional>
#include <string>

#include "base/parallel.h"
#include "math/hash.h"
#include "measure/lag.h"
#include "measure/temporal.h"
#include "study/bench_memory.h"
#include "study/bench_timing.h"

namespace lumi {
namespace {

constexpr Extent2 kMetricExtent{1920, 1080};
constexpr double kMiB = 1024 * 1024;

/// A smooth image with noise on it, always the same.
Image noisyImage(float noise) {
    Image image(kMetricExtent, 3);
    parallelRanges(kMetricExtent.height, 16, [&](int64_t begin, int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y)
            for (int x = 0; x < kMetricExtent.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const uint32_t key =
                        hashCombine(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(c));
                    const float smooth =
                        0.4f + 0.3f * static_cast<float>((x / 60 + y / 60) % 2) * (c == 1 ? 0.7f : 1.0f);
                    image.at(c, x, y) = smooth + noise * (unitFloat(key) - 0.5f);
                }
    });
    return image;
}

/// Everything that a metric may look at, and how it is run on it.
class MetricRun {
public:
    explicit MetricRun(const std::string& id) : pair_{noisyImage(0.1f), noisyImage(0), {}, 0} {
        pair_.prepare();
        bytes_ = pair_.image.bytes() + pair_.reference.bytes();
        if (id == "temporal") run_ = [this] { measureTemporal({pair_.image, pair_.reference}, false); };
        else if (id == "temporal_reprojected") followMotion();
        else if (id == "lag") followStep();
        else run_ = [this, &metric = findMetric(id)] { metric.measure(pair_, false); };
    }
    void run() const { run_(); }
    /// Of what the metric reads.
    size_t bytes() const { return bytes_; }

private:
    /// A camera that moves by half a pixel a frame, past one flat thing.
    void followMotion() {
        motion_ = Image(kMetricExtent, 3), depth_ = Image(kMetricExtent, 1);
        for (int64_t i = 0; i < kMetricExtent.area(); ++i) motion_.data()[i] = 0.5f;
        depth_.fill(4);
        bytes_ += motion_.bytes() + 2 * depth_.bytes();
        run_ = [this] {
            TemporalPair pair{pair_.image, pair_.reference};
            pair.motion = &motion_, pair.depth = pair.previousDepth = &depth_;
            measureReprojectedTemporal(pair, false);
        };
    }
    void followStep() {
        meter_.emplace(pair_.reference, pair_.image);
        run_ = [this] { meter_->add(pair_.image); };
    }

    ImagePair pair_;
    Image motion_, depth_;
    std::optional<LagMeter> meter_;
    size_t bytes_ = 0;
    std::function<void()> run_;
};

}  // namespace

std::vector<std::string> benchedMetrics() {
    std::vector<std::string> ids;
    for (const Metric& metric : metricCatalog()) ids.emplace_back(metric.id);
    for (const SequenceMetric& metric : sequenceMetricCatalog()) ids.emplace_back(metric.id);
    return ids;
}

void benchMetric(const std::string& id, const std::string& name, const std::stop_token& stop,
                 const BenchOutput& output) {
    const MetricRun metric(id);
    MemoryStream stream(metric.bytes());
    const MemoryPeak peak;
    metric.run();
    const std::optional<uint64_t> allocated = peak.bytes();
    const PairedTimes times = timeInTurn([&] { metric.run(); }, [&] { stream.run(); }, stop);
    const double megapixels = static_cast<double>(kMetricExtent.area()) / 1e6;
    output({name, megapixels / times.own.median() * 1000, "Mpixel/s", times.own.median(), times.own.spread(),
            megapixels / times.limit.median() * 1000});
    if (!allocated) return;
    output({"memory/" + name, static_cast<double>(*allocated) / kMiB, "MiB", 0, 0,
            static_cast<double>(metric.bytes()) / kMiB});
}

}  // namespace lumi

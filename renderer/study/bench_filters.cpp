#include <algorithm>
#include <map>
#include <optional>

#include "base/memory.h"
#include "reconstruct/catalog.h"
#include "study/bench_memory.h"
#include "study/bench_metrics.h"
#include "study/bench_scene.h"
#include "study/bench_timing.h"

namespace lumi {
namespace {

constexpr Extent2 kFilterExtent{1280, 720};
constexpr double kMiB = 1024 * 1024;
/// Frames before the first that counts: history is full, and every page of memory has been touched.
constexpr FrameNumber kWarmUp = 6;

/// Bytes of the signals that a module reads.
size_t bytesOf(const Signals& signals, const SignalSet& read) {
    size_t bytes = 0;
    for (int i = 0; i < kSignalCount; ++i) {
        const Signal signal = static_cast<Signal>(i);
        if (read.has(signal)) bytes += signalInfo(signal).isId ? signals.ids(signal).bytes() : signals[signal].bytes();
    }
    return bytes;
}

}  // namespace

/// One frame of a scene with all its signals.
class ModuleBench {
public:
    ModuleBench(const std::shared_ptr<const Scene>& scene, const std::stop_token& stop) {
        posed_ = poseScene(scene, {});
        camera_ = poseCamera(cameraAt(*scene, 0, 0), kFilterExtent);
        tracer_.bind(posed_);
        sampling_.extent = kFilterExtent;
        sampling_.camera = sampling_.previousCamera = camera_;
        sampling_.jitter = Jitter::PerFrame;
        sampling_.wanted = SignalSet::all();
        if (!tracer_.sample(sampling_, signals_, stop)) throwIfStopped(stop);
    }

    void run(Module& module, FrameNumber frame, StageTimer& timer, Image& out) {
        Changes changes;
        changes.cut = frame == 0;
        const TapSet none;
        module.run({frame, signals_, *posed_, camera_, camera_, changes, none, tracer_, sampling_, timer, {}}, out);
    }
    const Signals& signals() const { return signals_; }

private:
    std::shared_ptr<const PosedScene> posed_;
    CameraPose camera_;
    Tracer tracer_;
    FrameSampling sampling_;
    Signals signals_;
};

FilterBench::FilterBench(MessageLog& log, std::stop_token stop) : log_(log), stop_(std::move(stop)) {}
FilterBench::~FilterBench() = default;

std::vector<std::string> benchedModules() {
    std::vector<std::string> ids;
    for (const ModuleEntry& entry : moduleCatalog())
        if (std::string(entry.id) != "none") ids.emplace_back(entry.id);
    return ids;
}

void FilterBench::run(const std::string& id, const BenchOutput& output) {
    if (!frame_) frame_ = std::make_unique<ModuleBench>(loadBenchScene(*benchSceneFile("atrium"), log_, stop_), stop_);
    const MemoryPeak peak;
    const std::unique_ptr<Module> module = findModule(id).make();
    module->resize(kFilterExtent);
    Image out;
    FrameNumber frame = 0;
    StageTimer warm;
    while (frame < kWarmUp) frame_->run(*module, frame++, warm, out);
    const std::optional<uint64_t> held = peak.bytes();

    const size_t bytes = bytesOf(frame_->signals(), module->reads()) + out.bytes();
    MemoryStream stream(bytes);
    std::map<std::string, RunTimes> stages;
    const PairedTimes times = timeInTurn(
        [&] {
            StageTimer timer;
            frame_->run(*module, frame++, timer, out);
            for (const auto& [stage, ms] : timer.stages()) stages[stage].add(ms);
        },
        [&] { stream.run(); }, stop_);
    const double limit = 1000 / times.limit.median();
    output({"filter/" + id, 1000 / times.own.median(), "frame/s", times.own.median(), times.own.spread(), limit});
    for (const auto& [stage, own] : stages)
        output({"filter/" + id + "/" + stage, 1000 / std::max(own.median(), 1e-6), "frame/s", own.median(), own.spread(), limit});
    const uint64_t most = std::max(held.value_or(0), static_cast<uint64_t>(module->byteCount()));
    output({"memory/filter/" + id, static_cast<double>(most) / kMiB, "MiB", 0, 0, static_cast<double>(bytes) / kMiB});
}

}  // namespace lumi

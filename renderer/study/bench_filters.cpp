#include <fmt/format.h>

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
constexpr Extent2 kOtherExtents[] = {{640, 360}, {1920, 1080}};
constexpr double kMiB = 1024 * 1024;
constexpr double kMostMs = 120, kMostPerPixel = 1.2;  ///< the marks
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
    ModuleBench(const std::shared_ptr<const Scene>& scene, Extent2 extent, const std::stop_token& stop) {
        posed_ = poseScene(scene, {});
        camera_ = poseCamera(cameraAt(*scene, 0, 0), extent);
        tracer_.bind(posed_);
        sampling_.extent = extent;
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

/// A module with its history, on a frame.
class WarmModule {
public:
    WarmModule(ModuleBench& bench, const std::string& id) : bench_(bench), module_(findModule(id).make()) {
        module_->resize(bench.signals().extent());
        for (StageTimer warm; frame_ < kWarmUp;) bench_.run(*module_, frame_++, warm, out_);
    }
    /// Adds the time of each stage, and of all but antialiasing as `filter` where there are others.
    void run(std::map<std::string, RunTimes>& stages) {
        StageTimer timer;
        bench_.run(*module_, frame_++, timer, out_);
        double filter = 0;
        for (const auto& [stage, ms] : timer.stages()) {
            stages[stage].add(ms);
            if (stage != "antialiasing") filter += ms;
        }
        if (filter > 0 && timer.stages().size() > 1) stages["filter"].add(filter);
    }
    size_t bytesStreamed() const { return bytesOf(bench_.signals(), module_->reads()) + out_.bytes(); }
    size_t byteCount() const { return module_->byteCount(); }

private:
    ModuleBench& bench_;
    std::unique_ptr<Module> module_;
    Image out_;
    FrameNumber frame_ = 0;
};

ModuleBench& FilterBench::frame() {
    if (!scene_) scene_ = loadBenchScene(*benchSceneFile("atrium"), log_, stop_);
    if (!frame_) frame_ = std::make_unique<ModuleBench>(scene_, kFilterExtent, stop_);
    return *frame_;
}

void FilterBench::run(const std::string& id, const BenchOutput& output) {
    ModuleBench& bench = frame();
    const MemoryPeak peak;
    WarmModule module(bench, id);
    const std::optional<uint64_t> held = peak.bytes();

    const size_t bytes = module.bytesStreamed();
    MemoryStream stream(bytes);
    std::map<std::string, RunTimes> stages;
    const PairedTimes times = timeInTurn([&] { module.run(stages); }, [&] { stream.run(); }, stop_);
    const double limit = 1000 / times.limit.median();
    output({"filter/" + id, 1000 / times.own.median(), "frame/s", times.own.median(), times.own.spread(), limit});
    for (const auto& [stage, own] : stages)
        output({"filter/" + id + "/" + stage, 1000 / std::max(own.median(), 1e-6), "frame/s", own.median(),
                own.spread(), limit});
    const uint64_t most = std::max(held.value_or(0), static_cast<uint64_t>(module.byteCount()));
    output({"memory/filter/" + id, static_cast<double>(most) / kMiB, "MiB", 0, 0, static_cast<double>(bytes) / kMiB});
}

std::vector<FilterBench::Sized> FilterBench::timeSizes(const std::string& id, RunTimes& whole) {
    if (!scene_) scene_ = loadBenchScene(*benchSceneFile("atrium"), log_, stop_);
    frame_.reset();
    std::vector<Sized> sizes;
    ModuleBench usual(scene_, kFilterExtent, stop_);
    WarmModule module(usual, id);
    for (const Extent2 extent : kOtherExtents) {
        ModuleBench bench(scene_, extent, stop_);
        WarmModule other(bench, id);
        std::map<std::string, RunTimes> stages, usualStages;
        whole = timeInTurn([&] { other.run(stages); }, [&] { module.run(usualStages); }, stop_).limit;
        sizes.push_back({extent, stages["filter"], usualStages["filter"]});
    }
    return sizes;
}

void FilterBench::runSizes(const std::string& id, const std::string& name, const BenchOutput& output) {
    RunTimes whole;
    const auto rate = [](Extent2 size, const RunTimes& ms) {
        return static_cast<double>(size.area()) * 1e-3 / std::max(ms.median(), 1e-6);
    };
    for (const auto& [extent, own, usual] : timeSizes(id, whole))
        output({fmt::format("{}/{}x{}", name, extent.width, extent.height), rate(extent, own), "Mpixel/s", own.median(),
                own.spread(), rate(kFilterExtent, usual)});
}

void FilterBench::runMarks(const std::string& id, const std::string& name, const BenchOutput& output) {
    RunTimes whole;
    const std::vector<Sized> sizes = timeSizes(id, whole);
    const auto named = [&](Extent2 extent) { return fmt::format("{}/{}x{}", name, extent.width, extent.height); };
    output({named(kFilterExtent), whole.median(), "ms", whole.median(), whole.spread(), kMostMs, true});
    const auto perPixel = [](Extent2 size, const RunTimes& ms) {
        return ms.median() / static_cast<double>(size.area());
    };
    double least = 1, most = 1;
    for (const auto& [extent, own, usual] : sizes) {
        const double ratio = perPixel(extent, own) / perPixel(kFilterExtent, usual);
        least = std::min(least, ratio), most = std::max(most, ratio);
        output({named(extent), ratio, "of 720p", own.median(), own.spread(), kMostPerPixel, true});
    }
    output({name + "/size-spread", most / least, "of cheapest", 0, 0, kMostPerPixel, true});
}

}  // namespace lumi

#include "study/bench.h"

#include <fmt/format.h>

#include <regex>

#include "study/bench_metrics.h"
#include "study/bench_pathtracer.h"
#include "study/bench_program.h"
#include "study/bench_scene.h"
#include "study/bench_timing.h"

namespace lumi {
namespace {

constexpr const char* kScenes[] = {"cornell", "atrium", "sponza"};
/// What a large glTF with textures may take to load, seconds.
constexpr double kLoadSeconds = 3;
constexpr int kLoads = 3;

using Output = std::function<void(const BenchResult&)>;

struct Entry {
    std::string name;
    std::function<void(const std::string& name)> run;
};

/// All entries with what they share: the scene that was opened last.
class Bench {
public:
    Bench(const BenchOptions& options, MessageLog& log, Output output)
        : options_(options), log_(log), output_(std::move(output)), filters_(log, options.stop) {
        for (const char* scene : kScenes)
            if (benchSceneFile(scene)) addScene(scene);
        add("trace/emitters", [this](const std::string& name) { emitters(name); });
        for (const std::string& id : benchedMetrics())
            add("metric/" + id, [this, id](const std::string& name) { benchMetric(id, name, options_.stop, output_); });
        for (const std::string& id : benchedModules())
            add("filter/" + id, [this, id](const std::string&) { filters_.run(id, output_); });
        add("size/svgf", [this](const std::string& name) { filters_.runSizes("svgf", name, output_); });
        add("mark/svgf", [this](const std::string& name) { filters_.runMarks("svgf", name, output_); });
        if (!hasPathtracer()) return;
        add("trace/embree-pathtracer/cornell_box", [this](const std::string& name) { pathtracer(name, ""); });
        for (const char* scene : {"atrium", "sponza"})
            if (benchSceneFile(scene))
                add(std::string("trace/embree-pathtracer/") + scene,
                    [this, scene](const std::string& name) { pathtracer(name, scene); });
    }

    const std::vector<Entry>& entries() const { return entries_; }

private:
    void add(std::string name, std::function<void(const std::string&)> run) {
        entries_.push_back({std::move(name), std::move(run)});
    }

    void addScene(const std::string& scene) {
        const auto calls = [this, scene](const CallFilter& filter) {
            return [this, scene, filter](const std::string& name) { rays(name, scene, filter); };
        };
        using Call = RecordedRays::Call;
        const auto first = [](const Call& call) { return call.coherence == Coherence::Coherent; };
        add("trace/primary/" + scene, calls([first](const Call& call) { return !call.anyHit && first(call); }));
        add("trace/bounce/" + scene, calls([first](const Call& call) { return !call.anyHit && !first(call); }));
        add("trace/shadow/" + scene, calls([](const Call& call) { return call.anyHit; }));
        add("trace/path/" + scene, [this, scene](const std::string& name) { paths(name, scene); });
        add("trace/frame/" + scene, [this, scene](const std::string& name) { frames(name, scene); });
        add("load/" + scene, [this, scene](const std::string& name) { load(name, scene); });
        add("build/" + scene, [this, scene](const std::string& name) { build(name, scene); });
        if (!options_.program.empty())
            add("memory/" + scene, [this, scene](const std::string& name) { memory(name, scene); });
    }

    BenchScene& opened(const std::string& name) {
        if (openName_ != name) {
            open_.reset();
            open_ =
                std::make_unique<BenchScene>(loadBenchScene(*benchSceneFile(name), log_, options_.stop), kBenchExtent);
            openName_ = name;
        }
        return *open_;
    }

    /// `count` things a run, in units of `scale`.
    void report(const std::string& name, const std::string& unit, double count, const PairedTimes& times) const {
        const double seconds = times.own.median() / 1000, limitSeconds = times.limit.median() / 1000;
        output_({name, count / seconds, unit, times.own.median(), times.own.spread(), count / limitSeconds});
    }

    void rays(const std::string& name, const std::string& sceneName, const CallFilter& filter) {
        BenchScene& scene = opened(sceneName);
        const RecordedRays record = selectCalls(scene.record(options_.stop), filter);
        if (record.rays.empty()) return;
        const EmbreeScene& embree = scene.tracer().embree();
        const auto own = [&] { replayCalls(embree, record); };
        const auto bare = [&] { replayBare(embree, record); };
        own();
        report(name, "Mray/s", static_cast<double>(record.rays.size()) / 1e6, timeInTurn(own, bare, options_.stop));
    }

    void paths(const std::string& name, const std::string& sceneName) {
        BenchScene& scene = opened(sceneName);
        const RecordedRays record = scene.record(options_.stop);
        report(name, "Mray/s", static_cast<double>(record.rays.size()) / 1e6, frameAndBare(scene, record));
    }

    void frames(const std::string& name, const std::string& sceneName) {
        BenchScene& scene = opened(sceneName);
        const PathSettings settings = scene.path();
        scene.path().maxDepth = 2;
        const RecordedRays record = scene.record(options_.stop);
        const PairedTimes times = frameAndBare(scene, record);
        scene.path() = settings;
        report(name, "frame/s", 1, times);
    }

    void emitters(const std::string& name) const {
        BenchScene many(emitterScene(true, log_, options_.stop), kBenchExtent);
        BenchScene few(emitterScene(false, log_, options_.stop), kBenchExtent);
        report(
            name, "frame/s", 1,
            timeInTurn([&] { many.render(0, options_.stop); }, [&] { few.render(0, options_.stop); }, options_.stop));
    }

    PairedTimes frameAndBare(BenchScene& scene, const RecordedRays& record) const {
        return timeInTurn([&] { scene.render(0, options_.stop); }, [&] { replayBare(scene.tracer().embree(), record); },
                          options_.stop);
    }

    void load(const std::string& name, const std::string& sceneName) const {
        RunTimes times;
        for (int i = 0; i < kLoads; ++i) {
            throwIfStopped(options_.stop);
            times.add(timeOf([&] { loadBenchScene(*benchSceneFile(sceneName), log_, options_.stop); }));
        }
        output_({name, times.median() / 1000, "s", times.median(), times.spread(), kLoadSeconds});
    }

    void build(const std::string& name, const std::string& sceneName) {
        const auto scene = opened(sceneName).tracer().scene().scene;
        RunTimes times;
        for (int i = 0; i < kLoads; ++i) {
            throwIfStopped(options_.stop);
            Tracer tracer;
            times.add(timeOf([&] { tracer.bind(poseScene(scene, {})); }));
        }
        output_({name, times.median() / 1000, "s", times.median(), times.spread(), 0});
    }

    void memory(const std::string& name, const std::string& sceneName) {
        constexpr double kMiB = 1024 * 1024;
        const uint64_t peak = peakOfRender(options_.program, *benchSceneFile(sceneName), kBenchExtent);
        if (peak == 0) return log_.warning(name + ": the program could not be run");
        const BenchScene& scene = opened(sceneName);
        const double held = static_cast<double>(scene.scene().byteCount() + scene.tracer().byteCount());
        output_({name, static_cast<double>(peak) / kMiB, "MiB", 0, 0, 2 * held / kMiB});
    }

    void pathtracer(const std::string& name, const std::string& sceneName) {
        const auto result = sceneName.empty() ? comparePathtracerOnCornell(options_.stop)
                                              : comparePathtracer(opened(sceneName).scene(), options_.stop);
        if (!result) return log_.warning(name + ": Embree's pathtracer gave no result");
        log_.info(
            fmt::format("{}: same file, size, camera and point light, one sample a pixel, three surfaces a path, no "
                        "roulette; rays a path {:.2f} of ours, {:.2f} of theirs; ours alone asks for hits "
                        "without gaps between triangles and draws Owen-scrambled Sobol numbers",
                        name, result->ownRaysAPath, result->theirRaysAPath));
        output_({name, result->ownMrays, "Mray/s", result->times.median(), result->times.spread(), result->theirMrays});
    }

    const BenchOptions& options_;
    MessageLog& log_;
    const Output output_;
    FilterBench filters_;
    std::vector<Entry> entries_;
    std::string openName_;
    std::unique_ptr<BenchScene> open_;
};

}  // namespace

std::vector<BenchEntry> benchEntries() {
    static constexpr std::pair<const char*, const char*> kKinds[] = {
        {"trace/primary/", "camera rays of a frame, Mray/s; the limit is one call of Embree a ray"},
        {"trace/bounce/", "rays after the first hit, Mray/s; the limit is one call of Embree a ray"},
        {"trace/shadow/", "shadow rays, Mray/s; the limit is one call of Embree a ray"},
        {"trace/path/", "full path tracing, Mray/s over all rays; the limit is Embree over the same rays"},
        {"trace/frame/", "frames a second at 640x360, one sample a pixel, one bounce; the limit is its bare rays"},
        {"trace/emitters", "frames a second at 640x360 under 100,352 triangles that shine; the limit is ten of them"},
        {"trace/embree-pathtracer/", "Mray/s; the limit is Embree's own path tracer"},
        {"load/", "seconds to read the scene"},
        {"build/", "seconds to make the scene ready for rays"},
        {"memory/", "peak of loading and rendering; the limit is twice what scene and tracer hold"},
        {"metric/", "Mpixel/s on 1920x1080; the limit streams what it reads through memory; with its peak memory"},
        {"filter/",
         "frames a second at 1280x720, and of each stage; the limit streams what it reads; with its peak memory"},
        {"size/", "Mpixel/s of the filter without antialiasing at two sizes; the limit is that at 1280x720"},
        {"mark/",
         "the project's claims on two cores: ms at 1280x720, and times a pixel at other sizes; --check judges them"}};
    MessageLog log;
    const BenchOptions options{.filter = "", .program = "/proc/self/exe", .stop = {}};
    const Bench bench(options, log, {});
    std::vector<BenchEntry> entries;
    for (const Entry& entry : bench.entries())
        for (const auto& [head, what] : kKinds)
            if (entry.name.starts_with(head)) {
                entries.push_back({entry.name, what});
                break;
            }
    return entries;
}

void runBench(const BenchOptions& options, MessageLog& log, const Output& onResult) {
    std::regex filter;
    try {
        filter = std::regex(options.filter);
    } catch (const std::regex_error& error) {
        throwUsage({"not a regular expression", "--filter", "", '"' + options.filter + '"'});
    }
    const Bench bench(options, log, onResult);
    bool any = false;
    for (const Entry& entry : bench.entries()) {
        if (!std::regex_search(entry.name, filter)) continue;
        any = true;
        throwIfStopped(options.stop);
        entry.run(entry.name);
    }
    if (any) return;
    std::string all;
    for (const Entry& entry : bench.entries()) all += (all.empty() ? "" : ", ") + entry.name;
    throwUsage({"nothing to measure has such a name", "--filter", "one of " + all, '"' + options.filter + '"'});
}

}  // namespace lumi

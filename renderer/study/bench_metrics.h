#pragma once
#include <functional>
#include <memory>

#include "math/vector.h"
#include "study/bench.h"
#include "study/bench_timing.h"

namespace lumi {

class ModuleBench;
struct Scene;

using BenchOutput = std::function<void(const BenchResult&)>;

/// One metric, of images or of frames, over a 1920x1080 pair, in Mpixel/s. The limit streams what it reads through
/// memory once, in the same run. `memory/metric/<id>` follows: what the metric allocates at its peak, held against the
/// same bytes.
void benchMetric(const std::string& id, const std::string& name, const std::stop_token& stop,
                 const BenchOutput& output);

/// Modules on one traced frame that comes again and again, with all their history: 1280x720.
class FilterBench {
public:
    FilterBench(MessageLog& log, std::stop_token stop);
    ~FilterBench();

    /// `filter/<module>` in frames a second, then `filter/<module>/<stage>` for each of its stages; the limit streams
    /// the signals that it reads and its image through memory once. `memory/filter/<module>` tells what it holds at its
    /// peak (history, scratch and its image, whichever stage needs most), held against the same bytes. The stage
    /// `filter` is all of a module's stages but antialiasing, which follows the filter as a pass of its own.
    void run(const std::string& module, const BenchOutput& output);
    /// `<name>/640x360` and `<name>/1920x1080`: Mpixel/s of the stage `filter`; the limit is the same at 1280x720 in
    /// the same run.
    void runSizes(const std::string& module, const std::string& name, const BenchOutput& output);

    /// `<name>/1280x720`: milliseconds of a whole frame with antialiasing, at most 120. `<name>/640x360` and so on:
    /// times a pixel of the stage `filter` by those at 1280x720, at most 1.2.
    void runMarks(const std::string& module, const std::string& name, const BenchOutput& output);

private:
    struct Sized {
        Extent2 extent;
        RunTimes own, usual;
    };
    ModuleBench& frame();
    /// Times of the stage `filter` at the other sizes, in turn with the usual one; and of the usual frames as a whole.
    std::vector<Sized> timeSizes(const std::string& module, RunTimes& whole);

    MessageLog& log_;
    std::stop_token stop_;
    std::shared_ptr<const Scene> scene_;
    std::unique_ptr<ModuleBench> frame_;
};

/// Ids that the two know: metrics of the catalogue; modules that filter (all but those that only hand frames on).
std::vector<std::string> benchedMetrics();
std::vector<std::string> benchedModules();

}  // namespace lumi

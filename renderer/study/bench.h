#pragma once
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/messages.h"

namespace lumi {

/// One measurement and what it is held against.
struct BenchResult {
    std::string name;  ///< `trace/path/atrium`
    double value = 0;
    std::string unit;     ///< "Mray/s", "frame/s": more is better; "s", "MiB": less is better
    double medianMs = 0;  ///< of one run; 0 where no time was measured
    double spread = 0;    ///< (slowest - fastest) / median of the runs
    double limit = 0;     ///< in the same unit; 0: there is none
    bool isMark = false;  ///< the project's own claim: the value is at most the limit
    bool holds() const { return !isMark || value <= limit; }
    double ratioToLimit() const { return limit > 0 ? value / limit : 0; }
};

struct BenchOptions {
    std::string filter;   ///< regular expression; only entries in whose name it is found
    std::string program;  ///< our own binary, which memory is measured in; empty: those entries are left out
    std::stop_token stop;
};

/// Names of what this machine can measure, with what that is, in the order of running.
struct BenchEntry {
    std::string name, what;
};
std::vector<BenchEntry> benchEntries();

/// Runs the entries that the filter leaves and hands each result on as it is there. Throws Error(Usage) if the filter
/// is no regular expression or leaves nothing, Error(Interrupted) if stopped. Entries, where this machine has what they
/// need:
///   trace/primary|bounce|shadow/<scene>: our ray functions over the rays that a frame traces, in Mray/s. The limit is
///     single-ray rtcIntersect1 and rtcOccluded1 over the same rays in the same order.
///   trace/path/<scene>: full path tracing, every ray counted; the limit is the same over all rays of the frame.
///   trace/frame/<scene>: frames a second at one sample a pixel and one bounce; the limit is its bare rays.
///   trace/emitters: frames a second of a scene that 100,352 triangles light; the limit is the same lit by ten of its
///   triangles. trace/embree-pathtracer/<scene>: our Mray/s on an OBJ at one sample a pixel; the limit is what Embree's
///   program
///     `pathtracer` reports for the same file, camera, light, size and path length (Debian's embree-tools).
///   load/<scene>, build/<scene>: seconds to read a scene, and to make it ready for rays. memory/<scene>: peak of a
///   program that loads and renders it; the limit is twice what scene and tracer hold. metric/<id>: megapixels a second
///   on a 1920x1080 pair; the limit streams what it reads through memory once. filter/<module>: frames a second at
///   1280x720 on one traced frame with full history, then filter/<module>/<stage>; the
///     limit streams what the module reads and its image through memory once.
///   mark/svgf: what the project claims of it on two cores: milliseconds of a frame at 1280x720 (at most 120), and
///   times a pixel
///     at other sizes by that at 1280x720 (at most 1.2).
///   memory/metric/<id>, memory/filter/<module>: follow these; what they hold at their peak, held against the bytes of
///   the
///     streams. A module's stages share its memory.
/// Traced frames are 640x360, and times are medians of runs that alternate between what is measured and its limit.
void runBench(const BenchOptions& options, MessageLog& log, const std::function<void(const BenchResult&)>& onResult);

}  // namespace lumi

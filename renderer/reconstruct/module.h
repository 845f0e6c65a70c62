#pragma once
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "base/timer.h"
#include "frame/display_range.h"
#include "frame/signals.h"
#include "params/parameter.h"
#include "scene/posed_scene.h"
#include "trace/settings.h"

namespace lumi {

class Tracer;
struct FrameSampling;

using FrameNumber = int64_t;

/// What differs from the previous completed frame. `cut`: there is no previous frame (first frame, teleport, time jump,
/// resize); motion is 0 then. Each module decides what it keeps.
struct Changes {
    bool cut = false;
    bool camera = false;   ///< pose, lens or projection
    bool objects = false;  ///< some instance or deformation moved
    bool lights = false;
    bool materials = false;
    bool sampling = false;  ///< path, sampler or jitter settings
    bool any() const { return cut || camera || objects || lights || materials || sampling; }
};

/// A named intermediate buffer that a module can show.
struct Tap {
    std::string name;      ///< camelCase; files call it <module>-<name>
    const char* channels;  ///< one letter each, as SignalInfo::channels
    const char* unit = "";
    std::optional<ValueRange>
        range{};  ///< of codes, weights and counts: false colour spans it, the same in every frame
    const char* colourMap = "viridis";  ///< "none" for colours shown as they are
    const char* help = "";
};
using TapSet = std::set<std::string>;

struct FrameContext {
    FrameNumber frame = 0;
    const Signals& signals;
    const PosedScene& scene;
    const CameraPose& camera;
    const CameraPose& previousCamera;
    Changes changes;
    const TapSet& wantedTaps;
    Tracer& tracer;  ///< bound to `scene`: for methods that trace samples of their own
    /// What the frame's signals were made with. The keys (x, y, firstSample + s) name their random numbers:
    /// Tracer::shade() with the key of an earlier sample and its surface point shades that sample again as things are
    /// now.
    const FrameSampling& sampling;
    StageTimer& timer;
    std::stop_token stop;
    std::optional<Pixel> inspected{};  ///< whose lineage() is wanted
};

enum class RunResult { Completed, Stopped };

/// Which taps of the history and which neighbours made a pixel, stage by stage.
struct Lineage {
    struct Row {
        std::string stage;    ///< "history", "direct, level 2"
        Pixel at;             ///< what contributed; for history a pixel of the previous frame
        float weight = 0;     ///< its part in the stage's result; those of a stage sum to 1
        std::string verdict;  ///< "kept", "refused: depth", or the factors of the weight
    };
    Pixel pixel{-1, -1};
    std::vector<Row> rows;
};

/// How far a method that converges has come.
struct Convergence {
    uint64_t samples = 0;  ///< a pixel so far; 0: the method does not converge
    uint64_t target = 0;   ///< where it stops; 0: never
    bool done() const { return target > 0 && samples >= target; }
};

/// A reconstruction method. Screen-space methods filter the frame's signals; others may trace samples of their own.
///
/// run() is a transaction keyed by context.frame: history advances only when a run with a new number completes; a run
/// with the same number again (a filter parameter moved) replaces its result from the same previous history; a stopped
/// run changes nothing. NaN and infinity in the input never throw and never spread beyond their pixel's support.
class Module {
public:
    virtual ~Module() = default;
    /// With the present parameters: the tracer writes only what someone reads.
    virtual SignalSet reads() const = 0;
    virtual Jitter preferredJitter() const;
    virtual void describe(ParameterVisitor&) = 0;
    virtual void resize(Extent2) = 0;
    /// Drops history: the next run() equals a fresh instance's.
    virtual void forget() = 0;
    /// `out`: RGB, scene-linear, of the resized extent. A module that keeps history reads the frame's changes itself.
    virtual RunResult run(const FrameContext&, Image& out) = 0;
    virtual std::span<const Tap> taps() const { return {}; }
    /// A tap of the last completed run; empty if it was not wanted then.
    virtual const Image& tap(const std::string& name) const;
    /// Of the pixel that the last completed run was asked about; no rows if none was, or if the method does not tell.
    virtual Lineage lineage() const { return {}; }
    /// Of the last completed run. A frame loop may rest while every module is done().
    virtual Convergence convergence() const { return {}; }
    /// Does history reach across these changes? Where it does not, a replay may begin here.
    virtual bool keepsHistory(const Changes& changes) const { return !changes.cut; }
    /// Of the last completed run: pixels with values that were NaN or infinite, and were dropped.
    virtual int64_t droppedPixels() const { return 0; }
    virtual size_t byteCount() const { return 0; }
};

}  // namespace lumi

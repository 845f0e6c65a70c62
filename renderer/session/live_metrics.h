#pragma once
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "measure/measure.h"
#include "session/reference_spec.h"
#include "session/session.h"

namespace lumi {

/// How far one pane's result is from the reference.
struct PaneMeasurement {
    std::string module;
    std::string settings;                        ///< values of the module's and the light paths' parameters, as text
    std::map<std::string, double> values;        ///< by metric id; NaN where there is no value
    std::map<std::string, std::string> reasons;  ///< by metric id: why a value is NaN or infinite
    int64_t nonFinitePixels = 0;
    std::shared_ptr<const Image8> map;  ///< error map of the metric asked for; null without one
    DisplayInfo mapInfo;
};

/// What was measured of one snapshot.
struct LiveMeasurement {
    uint64_t serial = 0;   ///< Snapshot::serial
    uint64_t samples = 0;  ///< a pixel that the progressive mean had then; 0: nothing accumulates
    FrameNumber frame = 0;
    std::vector<PaneMeasurement> panes;
    std::string problem;  ///< why nothing was measured; empty: it was
    double ms = 0;        ///< what it took
};

/// One point of a curve: samples a pixel, and each metric's value.
struct ConvergencePoint {
    uint64_t samples = 0;
    std::map<std::string, double> values;
};

using ConvergenceCurves = std::vector<std::vector<ConvergencePoint>>;  ///< of each pane

/// What panes are measured against, and how it comes about.
struct ReferenceStatus {
    bool working = false;        ///< it is read or made
    ReferenceProgress progress;  ///< while it is made
    bool present = false;
    std::string name;  ///< a file, or "1024 spp"
    Extent2 extent;
    uint64_t samples = 0;                ///< a pixel; 0: unknown
    double error = 0;                    ///< its own, relative; 0: unknown
    std::shared_ptr<const Image> image;  ///< linear RGB
    bool asShown = false;                ///< a picture file: the scene's exposure and a tone curve are in it
};

/// Measures each pane's result against a reference while frames come, on a thread of its own: always the newest
/// snapshot, never a queue. Its functions may be called from the UI thread and return at once.
class LiveMetrics {
public:
    explicit LiveMetrics(MessageLog& log);
    ~LiveMetrics();

    /// Reads an image file as the reference. Failures are Errors in the log, and the present one stays.
    void loadReference(const std::filesystem::path& file);
    /// What the document shows, converged: from the cache, or traced and kept there. Drops one that is being made.
    void makeReference(const Document& document, uint64_t samples);
    void cancelReference();
    void clearReference();
    ReferenceStatus reference() const;
    /// Is the reference one of what the snapshot shows? A file is, if it has the size.
    bool fits(const Snapshot& snapshot) const;

    /// Which metrics are computed, and whose error map; empty: none.
    void choose(std::vector<std::string> metrics, const std::string& map);
    /// The latest picture; previews and pictures that were seen are left out.
    void offer(std::shared_ptr<const Snapshot> snapshot);
    std::shared_ptr<const LiveMeasurement> latest() const;
    /// How each pane's module came nearer to this reference since it was set, or since the pane has this module with
    /// these parameters; at most a few hundred points; null before the first.
    std::shared_ptr<const ConvergenceCurves> curves() const;

private:
    struct Held;
    struct Made;
    void run(std::stop_token quit);
    bool hasWork() const;
    LiveMeasurement measure(const Snapshot& snapshot, const Held& reference, const std::vector<std::string>& metrics,
                            const std::string& map) const;
    void adopt(Made made);
    void note(const LiveMeasurement& measurement);
    void stopMaking();
    void inBackground(std::function<Made(std::stop_token)> make);

    MessageLog& log_;
    mutable std::mutex mutex_;
    std::condition_variable_any wake_;
    std::shared_ptr<const Held> reference_;
    ReferenceStatus status_;
    std::vector<std::string> metrics_;
    std::string map_;
    bool chosenAnew_ = false;
    std::shared_ptr<const Snapshot> offered_;
    std::shared_ptr<const LiveMeasurement> latest_;
    std::shared_ptr<const ConvergenceCurves> curves_;
    std::vector<std::string> curvesOf_;  ///< module and settings of each
    uint64_t generation_ = 0;            ///< of what was asked for last
    /// What makes or reads a reference; it says when it is done. The last is the one that was asked for last.
    struct Maker {
        std::atomic<bool> done{false};
        std::jthread thread;
    };
    std::list<Maker> makers_;  ///< of the thread that calls
    std::jthread thread_;
};

/// Puts the error maps of several panes into them as pictures over one common range: see MapRange.
void showMaps(const Metric& metric, const std::vector<Image>& maps, std::vector<PaneMeasurement>& panes);

}  // namespace lumi

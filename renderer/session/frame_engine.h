#pragma once
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "base/messages.h"
#include "reconstruct/module.h"
#include "session/changes.h"
#include "session/document.h"
#include "session/signals_check.h"
#include "session/signals_pool.h"
#include "trace/tracer.h"

namespace lumi {

/// One frame as asked for. The instances that run are those of the document's drawn views and those named here, all on
/// the same samples.
struct FrameRequest {
    const Document& document;
    FrameNumber frame = 0;
    bool cut = false;                      ///< nothing before this frame counts: as in a fresh engine
    SignalSet signals;                     ///< wanted beyond what the modules read and the views show
    std::map<std::string, TapSet> taps;    ///< wanted beyond what the views show, by instance
    std::vector<std::string> instances{};  ///< that run besides those of the views
    std::optional<Pixel> inspected{};      ///< whose lineages are wanted

    /// Each once: those of the views first.
    std::vector<std::string> activeInstances() const;
};

/// One completed frame. Images are shared and never change again.
struct FrameOutput {
    FrameNumber number = -1;
    float time = 0;
    Changes changes;              ///< against the frame before
    bool historyDropped = false;  ///< no module kept anything from before this frame
    CameraPose camera;
    std::shared_ptr<const PosedScene> scene;
    std::shared_ptr<const Signals> signals;
    std::map<std::string, std::shared_ptr<const Image>> results;  ///< by instance
    std::map<std::string, std::shared_ptr<const Image>> taps;     ///< "<instance>-<tap>"
    std::map<std::string, size_t> moduleBytes;                    ///< by instance
    std::map<std::string, int64_t> droppedPixels;                 ///< by instance: Module::droppedPixels()
    std::map<std::string, Convergence> convergence;               ///< by instance
    std::map<std::string, Lineage> lineages;                      ///< by instance, of the pixel asked about
    std::vector<std::pair<std::string, double>> stagesMs;
    std::map<std::string, double> runMs;         ///< by instance: its run() as a whole
    std::map<std::string, TraceCounts> runRays;  ///< by instance: those that it traced itself, beside `rays`
    std::map<std::string, bool> readsSignals;    ///< by instance: does it read any of the frame's signals?
    double frameMs = 0;
    TraceCounts rays;

    /// Every module has converged: more frames would not change what is shown.
    bool rests() const;
};

/// Runs frames, one after the other, on the calling thread and the pool: pose, trace what someone reads (nothing, if
/// the modules place their own rays and no view shows a signal), run the modules. Both the interactive session and
/// `render` drive it; what it makes depends only on the requests.
class FrameEngine {
public:
    enum class OnModuleError { Throw, ShowRawFrame };
    explicit FrameEngine(MessageLog& log, OnModuleError onError = OnModuleError::Throw);
    ~FrameEngine();

    /// Draws a frame, or returns nothing if it was stopped; then the same number asked for again is as if it had not
    /// been. A frame with the number of the last completed one replaces it, seen from the same frame before; any other
    /// number but the next is a cut. Building the scene goes on when `stop` is requested, since the next frame needs it
    /// too, and ends with `sceneStop`.
    std::optional<FrameOutput> advance(const FrameRequest& request, std::stop_token stop = {},
                                       std::stop_token sceneStop = {});

    /// Can frame `frame`, the last completed one, be replaced? Not after a frame was stopped when one module had
    /// already run it, nor before the first frame after a cut that was asked for.
    bool canRepeat(FrameNumber frame) const;

    /// A coarse picture of what the document shows, for the while that it keeps changing: one sample a pixel at
    /// `extent`, the raw frame in every module's place. It leaves history and the last completed frame as they are.
    /// Nothing if it was stopped.
    std::optional<FrameOutput> preview(const Document& document, Extent2 extent, std::stop_token stop = {},
                                       std::stop_token sceneStop = {});
    /// Signals of the scene that was traced last, sampled otherwise; nothing if it was stopped. It counts to no frame.
    std::shared_ptr<const Signals> sampleAgain(const FrameSampling& sampling, std::stop_token stop = {});
    /// World position of what `camera` sees through the middle of a pixel, in the scene that was traced last; nothing
    /// on the sky.
    std::optional<Vec3> surfaceAt(const CameraPose& camera, Pixel pixel);
    /// checkFrames() with this engine's tracer. Throws Error(Interrupted) when stopped.
    std::vector<FrameCheck> checkSignals(const Document& document, std::stop_token stop,
                                         std::stop_token sceneStop = {});

    /// Rays of the frame being traced, for a progress bar; from any thread.
    TraceCounts tracedSoFar() const { return tracer_.counts(); }
    /// Bytes of tracer, signals and modules.
    size_t byteCount() const;

private:
    /// A completed frame as the next one sees it.
    struct Completed {
        FrameNumber frame = -1;
        Document document;
        std::vector<std::string> instances;  ///< that ran
        CameraPose camera;
        Jitter jitter = Jitter::Auto;  ///< in effect
        std::shared_ptr<const PosedScene> scene;
        std::shared_ptr<const Signals> signals;
        TraceCounts rays;
        CameraTrack cameraTrack, previousCameraTrack;  ///< over the open shutter; empty: the camera stands still
        FrameState state() const { return {document, camera, jitter}; }
    };
    struct Instance {
        std::unique_ptr<Module> module;
        Extent2 extent;
        FrameNumber firstFrame = -1, lastFrame = -1;  ///< of its history; -1 before the first run
        std::vector<ParameterInfo> parameters;        ///< that it ran with
        bool failed = false;                          ///< it threw; tried again when a parameter changes
    };
    using Instances = std::map<std::string, Instance>;

    /// Instances that cannot go on from their history are made anew in fresh_; they take their place for good only when
    /// the frame is complete.
    /// `previous`: the frame before, null on a cut.
    void prepareInstances(const FrameRequest& request, Extent2 extent, const Completed* previous);
    Instance& running(const std::string& name);
    void adoptFreshInstances(const std::vector<std::string>& active, bool replaces);
    SignalSet wantedSignals(const FrameRequest& request);
    Jitter effectiveJitter(const Document& document);
    FrameSampling sampling(const FrameRequest& request, const Completed& next, const CameraPose& previousCamera);
    /// The document's scene for the tracer; false if it was stopped, and then nothing is bound.
    bool bind(const std::shared_ptr<const PosedScene>& posed, const std::stop_token& stop);
    bool traceSignals(const FrameRequest& request, const CameraPose& previousCamera, bool replaces, Completed& next,
                      StageTimer& timer, std::stop_token stop, const std::stop_token& sceneStop);
    bool runModules(const FrameRequest& request, const Completed& next, const CameraPose& previousCamera,
                    FrameOutput& frame, StageTimer& timer, std::stop_token stop);
    void advise(const std::string& name, const Module& module, const FrameSampling& sampling);
    bool runModule(const std::string& name, const FrameContext& context, Image& out, FrameOutput& frame);

    MessageLog& log_;
    std::map<std::string, std::string> advice_;  ///< last given, by instance
    OnModuleError onError_;
    Tracer tracer_;
    std::shared_ptr<const PosedScene> bound_;
    std::shared_ptr<const PosedScene> previewed_;  ///< of the last preview
    Instances instances_, fresh_;
    SignalsPool pool_, previewPool_;
    std::optional<Completed> before_, current_;
};

}  // namespace lumi

#pragma once
#include <map>
#include <string>
#include <vector>

#include "session/frame_engine.h"
#include "study/run_job.h"

namespace lumi {

/// A method as the frame engine runs it.
struct RunningMethod {
    std::string instance;
    std::vector<StudyValue> set;  ///< of the module
};

/// The methods of a measuring job, with what tuning chose.
std::vector<RunningMethod> methodsOf(const JobContext& context, const StudyJob& job);

/// Does the scene take every value that the job sets? Throws as FrameRunner does; nothing is drawn. Returns the
/// contents of the images that the values name, as digests.
std::string checkJobValues(const JobContext& context, const StudyJob& job);

/// Drives the frame engine over the study's frames, from an empty history on.
class FrameRunner {
public:
    /// Throws Error(BadInput) headed by the study file's position for a value that the scene's document does not take.
    FrameRunner(const JobContext& context, const StudyJob& job, std::vector<RunningMethod> methods);

    /// The next frame, with `signals` beside what the methods read, and buffers by instance. Throws Error(Interrupted).
    FrameOutput advance(const SignalSet& signals, const std::map<std::string, TapSet>& taps = {});
    int64_t next() const { return next_; }
    /// Of the frame that was drawn last; `spp` 0: the study's.
    std::shared_ptr<const StudyReferenceFrame> reference(const StudyReferences::Report& report, int spp = 0);
    /// How what the reference sees of that frame moved since the frame before: StudyReferences::geometry(). Throws
    /// Error(Interrupted).
    std::shared_ptr<const Signals> geometry();
    float exposure() const { return metricExposure(problem_); }
    const std::vector<RunningMethod>& methods() const { return methods_; }

private:
    const JobContext& context_;
    std::vector<RunningMethod> methods_;
    Document document_;  ///< what the methods see
    Document problem_;   ///< what a reference is a rendering of
    Document earlier_;   ///< the same a frame before
    FrameEngine engine_;
    int64_t next_;
};

}  // namespace lumi

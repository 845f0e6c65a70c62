#include "reconstruct/stable/stable.h"

#include <cassert>

#include "base/memory.h"
#include "math/hash.h"
#include "reconstruct/stable/stable_taps.h"
#include "trace/tracer.h"

namespace lumi {

StableModule::StableModule() : taps_(stableTaps()) {}

void StableModule::describe(ParameterVisitor& v) {
    density_.describe(v);
    verification_.describe(v);
    gathering_.describe(v);
    scattered_.describe(v);
    temporal_.describe(v);
}

void StableModule::resize(Extent2 extent) {
    constexpr uint64_t kBytesAPixel = 600;  // three frames of samples at the default density, and what works on them
    checkMemory("the samples of stable ray tracing", kBytesAPixel * static_cast<uint64_t>(extent.area()));
    extent_ = extent;
    forget();
}

void StableModule::forget() {
    history_.clear();
    temporal_.forget();
    taps_.clear();
    counts_ = {};
    filledPixels_ = 0;
    lineage_ = {};
}

RunResult StableModule::run(const FrameContext& context, Image& out) {
    assert(context.camera.extent == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    const auto step = history_.begin(context.frame, context.changes.cut);
    static const SampleSet kNone;
    SampleSet& samples = step.next.samples;
    if (!placeSamples(context, step.previous ? step.previous->samples : kNone, samples)) return RunResult::Stopped;
    VerificationCounts counts;
    {
        const auto measured = context.timer.measure("verification");
        if (!verifySamples(context, verification_, frame_, samples, counts)) return RunResult::Stopped;
    }
    {
        const auto measured = context.timer.measure("shading");
        if (!shadeSamples(context, gathering_, frame_, samples)) return RunResult::Stopped;
    }
    if (!reconstruct(context, samples, out)) return RunResult::Stopped;
    if (!temporal_.run(context, motion_, out)) return RunResult::Stopped;
    step.next.stillFrames = step.previous && !context.changes.any() ? step.previous->stillFrames + 1 : 1;
    keepTaps(context, samples);
    inspect(context, samples);
    counts_ = counts;
    history_.commit();
    temporal_.commit();
    taps_.commit();
    return RunResult::Completed;
}

/// Reprojection and analysis: which samples the frame has.
bool StableModule::placeSamples(const FrameContext& context, const SampleSet& previous, SampleSet& next) {
    {
        const auto measured = context.timer.measure("reprojection");
        if (!reprojectSamples(context, previous, frame_.reprojected)) return false;
    }
    const auto measured = context.timer.measure("analysis");
    const uint32_t random = hashCombine(static_cast<uint32_t>(context.frame), context.sampling.seed);
    if (taps_.wants("density") && localDensity_.extent() != extent_) localDensity_.reset(extent_, 1);
    analyseSamples(frame_.reprojected.words, extent_, density_, random, frame_.changes,
                   taps_.wants("density") ? localDensity_.data() : nullptr, context.stop);
    if (context.stop.stop_requested()) return false;
    next.extent = extent_;
    gatherSamples(previous, density_, random, frame_, next);
    return true;
}

bool StableModule::reconstruct(const FrameContext& context, const SampleSet& samples, Image& out) {
    const auto measured = context.timer.measure("reconstruction");
    const int64_t filled = reconstructScattered({extent_, samples.first, samples.places, frame_.colours, frame_.hidden}, scattered_, out,
                                                weights_, context.stop);
    if (filled < 0) return false;
    filledPixels_ = filled;
    if (motion_.extent() != extent_) motion_.reset(extent_, 2);
    if (temporal_.enabled() || taps_.wants("sampleMotion")) longestMotions(samples.first, frame_.motions, frame_.hidden, motion_);
    taps_.keep("reconstructed", out);
    return true;
}

const Image& StableModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

Convergence StableModule::convergence() const {
    const bool converges = gathering_.converge && !temporal_.enabled() && !history_.empty();
    return {converges ? history_.current().stillFrames : 0, 0};
}

size_t StableModule::byteCount() const {
    return history_.byteCount([](const Kept& kept) { return kept.samples.bytes(); }) + frame_.bytes() + weights_.bytes() + motion_.bytes() +
           localDensity_.bytes() + temporal_.bytes() + taps_.bytes();
}

}  // namespace lumi

#include "reconstruct/stable/stable.h"

#include <cassert>
#include <limits>

#include "base/memory.h"
#include "math/hash.h"
#include "reconstruct/stable/stable_taps.h"
#include "trace/tracer.h"

namespace lumi {
namespace {

/// Names the frame where random numbers are drawn.
uint32_t randomOf(const FrameContext& context) {
    return hashCombine(static_cast<uint32_t>(context.frame), context.sampling.seed);
}

}  // namespace

StableModule::StableModule() : taps_(stableTaps()) {}

void StableModule::describe(ParameterVisitor& v) {
    density_.describe(v);
    verification_.describe(v);
    gathering_.describe(v);
    scattered_.describe(v);
    temporal_.describe(v);
}

void StableModule::resize(Extent2 extent) {
    // Three frames of samples and what works on them. A quarter more than the target are held, most of them occluded;
    // room is made for an eighth more.
    constexpr uint64_t kBytesAPixel = 110;
    constexpr uint64_t kBytesASample = 3 * SampleSet::bytesASample(true) + SampleFrame::kBytesASample;
    const auto samples = static_cast<uint64_t>(1.125 * 1.25 * density_.density * static_cast<double>(extent.area()));
    checkMemory("the samples of stable ray tracing",
                kBytesAPixel * static_cast<uint64_t>(extent.area()) + kBytesASample * samples);
    extent_ = extent;
    forget();
}

void StableModule::forget() {
    history_.clear();
    temporal_.forget();
    taps_.clear();
    counts_ = {};
    lineage_ = {};
}

RunResult StableModule::run(const FrameContext& context, Image& out) {
    assert(context.camera.extent == extent_);
    if (context.stop.stop_requested()) return RunResult::Stopped;
    taps_.begin(context.wantedTaps);
    const auto step = history_.begin(context.frame, context.changes.cut);
    static const SampleSet kNone;
    SampleSet& samples = step.next.samples;
    const GatheringState light = lightState(context, step.previous, step.next);
    const SampleSet& previous = step.previous ? step.previous->samples : kNone;
    if (!placeSamples(context, previous, step.next)) return RunResult::Stopped;
    frame_.newOnly = light.still && step.previous && step.previous->epsilon == verification_.epsilon;
    step.next.epsilon = verification_.epsilon;
    if (!frame_.newOnly) step.next.meanFrames = 1;  // samples that were hidden may be seen now
    VerificationCounts counts;
    if (!trace(context, previous, light, samples, counts)) return RunResult::Stopped;
    if (!reconstruct(context, samples, out)) return RunResult::Stopped;
    if (!temporal_.run(context, motion_, out)) return RunResult::Stopped;
    keepTaps(context, samples);
    inspect(context, samples);
    counts_ = counts;
    history_.commit();
    temporal_.commit();
    taps_.commit();
    return RunResult::Completed;
}

/// What has changed for the light, and since when it has not.
GatheringState StableModule::lightState(const FrameContext& context, const Kept* previous, Kept& next) const {
    const Changes& changes = context.changes;
    GatheringState state;
    state.still = !changes.any();
    next.averaged = state.still && gathering_.converge;
    state.lightsMoved = changes.lights;
    // Without a frame before, all samples are new: nothing in them is old.
    constexpr uint64_t kEver = std::numeric_limits<uint64_t>::max() / 2;
    next.steadyFrames = !previous ? kEver : changes.objects || changes.lights ? 0 : previous->steadyFrames + 1;
    const bool stopped = next.averaged && previous && !previous->averaged;
    const bool holdsOld = static_cast<float>(next.steadyFrames) < 4 / gathering_.indirectAlpha;
    state.restart = changes.materials || changes.sampling || (stopped && holdsOld);
    next.meanFrames = next.averaged && previous && !state.restart ? previous->meanFrames + 1 : 1;
    return state;
}

/// Reprojection and analysis: which samples the frame has.
bool StableModule::placeSamples(const FrameContext& context, const SampleSet& previous, Kept& next) {
    {
        const auto measured = context.timer.measure("reprojection");
        if (!reprojectSamples(context, previous, frame_.reprojected)) return false;
    }
    const auto measured = context.timer.measure("analysis");
    if (taps_.wants("density") && localDensity_.extent() != extent_) localDensity_.reset(extent_, 1);
    const bool changed = analyseSamples(frame_.reprojected.words, extent_, density_, randomOf(context), frame_.changes,
                                        taps_.wants("density") ? localDensity_.data() : nullptr, context.stop);
    if (context.stop.stop_requested()) return false;
    if (changed) next.meanFrames = 1;  // new samples have one path
    next.samples.extent = extent_;
    frame_.wantsMotions = temporal_.enabled() || taps_.wants("sampleMotion");
    // At depth 1 all light is direct.
    numberSamples(frame_, context.sampling.path.maxDepth > 1, next.samples);
    next.samples.scene = context.scene.scene;
    return true;
}

bool StableModule::trace(const FrameContext& context, const SampleSet& previous, const GatheringState& light,
                         SampleSet& samples, VerificationCounts& counts) {
    const auto measured = context.timer.measure("verification/shading");
    return traceSamples(
        {context, previous, density_, verification_, gathering_, light, randomOf(context), frame_, samples, spare_},
        counts);
}

bool StableModule::reconstruct(const FrameContext& context, const SampleSet& samples, Image& out) {
    const auto measured = context.timer.measure("reconstruction");
    if (reconstructScattered({extent_, samples.first, samples.places, coloursOf(samples), frame_.hidden}, scattered_,
                             out, weights_, context.stop) < 0)
        return false;
    if (motion_.extent() != extent_) motion_.reset(extent_, 2);
    if (frame_.wantsMotions) longestMotions(samples.first, frame_.motions, frame_.hidden, motion_);
    taps_.keep("reconstructed", out);
    return true;
}

std::span<const Vec3> StableModule::coloursOf(const SampleSet& samples) const {
    return samples.indirect.empty() ? samples.direct : frame_.colours;
}

std::string StableModule::advice() const {
    if (density_.tolerance >= 0.5f) return "";
    return "a density tolerance below 0.5 never settles: neighbouring pixels undo each other's changes, and samples do "
           "not live long";
}

const Image& StableModule::tap(const std::string& name) const {
    const Image* found = taps_.find(name);
    return found ? *found : Module::tap(name);
}

Convergence StableModule::convergence() const {
    const bool converges = gathering_.converge && !temporal_.enabled() && !history_.empty();
    return {converges ? history_.current().meanFrames : 0, 0};
}

size_t StableModule::byteCount() const {
    // Not what is only for looking at: taps and the densities they show. Nor the threads' scratch: as in the tracer, it
    // is small, and depends on their number.
    return history_.byteCount([](const Kept& kept) { return kept.samples.bytes(); }) + frame_.bytes() +
           weights_.bytes() + motion_.bytes() + temporal_.bytes();
}

}  // namespace lumi

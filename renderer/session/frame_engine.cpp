#include "session/frame_engine.h"

#include <algorithm>
#include <cassert>

#include "base/error.h"
#include "reconstruct/catalog.h"
#include "scene/reach.h"
#include "session/frame_pose.h"
#include "session/view_buffers.h"

namespace lumi {
namespace {

/// Rays since `earlier`.
TraceCounts difference(const TraceCounts& now, const TraceCounts& earlier) {
    return {now.cameraRays - earlier.cameraRays, now.bounceRays - earlier.bounceRays,
            now.shadowRays - earlier.shadowRays, now.nonFinite - earlier.nonFinite};
}

/// The worst that the differences between two lists of one module's parameters invalidate; nothing: none differ.
std::optional<Redo> worstChange(const std::vector<ParameterInfo>& before, const std::vector<ParameterInfo>& now) {
    std::optional<Redo> worst;
    for (size_t i = 0; i < now.size() && i < before.size(); ++i)
        if (before[i].value != now[i].value) worst = std::max(worst.value_or(now[i].redo), now[i].redo);
    return worst;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> FrameRequest::activeInstances() const {
    std::vector<std::string> active = document.activeInstances();
    for (const std::string& name : instances)
        if (!contains(active, name)) active.push_back(name);
    return active;
}

bool FrameOutput::rests() const {
    return !convergence.empty() &&
           std::all_of(convergence.begin(), convergence.end(), [](const auto& entry) { return entry.second.done(); });
}

FrameEngine::FrameEngine(MessageLog& log, OnModuleError onError) : log_(log), onError_(onError) {}
FrameEngine::~FrameEngine() = default;

std::optional<FrameOutput> FrameEngine::advance(const FrameRequest& request, std::stop_token stop,
                                                std::stop_token sceneStop) {
    Timer total;
    StageTimer timer;
    if (request.cut) before_.reset(), current_.reset();
    const bool replaces = current_ && request.frame == current_->frame;
    const std::optional<Completed>& previous = replaces ? before_ : current_;

    Completed next{
        request.frame, request.document, request.activeInstances(), {}, Jitter::Auto, nullptr, nullptr, {}, {}, {}};
    const RenderSettings& render = request.document.render();
    next.camera = poseCamera(request.document.camera(), {render.width, render.height});
    next.cameraTrack = request.document.cameraTrack();
    requireReach(next.camera, request.document.scene()->path);

    FrameOutput frame;
    frame.changes.cut = !previous || previous->frame + 1 != request.frame || isCut(previous->state(), next.state());
    prepareInstances(request, next.camera.extent, frame.changes.cut ? nullptr : &*previous);
    next.jitter = effectiveJitter(next.document);
    {
        const auto measured = timer.measure("pose");
        const float previousTime = frame.changes.cut ? next.document.time() : previous->document.time();
        next.scene = pose(next.document, previousTime, previous ? previous->scene.get() : nullptr,
                          {current_ ? current_->scene : nullptr, previewed_}, sceneStop);
        if (!next.scene) return std::nullopt;
        previewed_ = nullptr;
    }
    if (!frame.changes.cut) frame.changes = differences(previous->state(), next.state(), *next.scene);

    // Without a cut `previous` holds the frame before; a copy, since it is overwritten below.
    const CameraPose previousCamera = frame.changes.cut ? next.camera : previous->camera;
    next.previousCameraTrack = frame.changes.cut ? next.cameraTrack : previous->cameraTrack;
    if (!traceSignals(request, previousCamera, replaces, next, timer, stop, sceneStop)) return std::nullopt;
    if (!runModules(request, next, previousCamera, frame, timer, stop)) return std::nullopt;

    adoptFreshInstances(next.instances, replaces);

    frame.number = request.frame;
    frame.time = next.document.time();
    frame.camera = next.camera;
    frame.scene = next.scene;
    frame.signals = next.signals;
    frame.rays = next.rays;
    frame.stagesMs = timer.stages();
    frame.frameMs = total.elapsedMs();
    if (!replaces) before_ = std::move(current_);
    current_ = std::move(next);
    return frame;
}

FrameEngine::Instance& FrameEngine::running(const std::string& name) {
    const auto fresh = fresh_.find(name);
    return fresh == fresh_.end() ? instances_.at(name) : fresh->second;
}

void FrameEngine::prepareInstances(const FrameRequest& request, Extent2 extent, const Completed* previous) {
    fresh_.clear();
    for (const std::string& name : request.activeInstances()) {
        const std::vector<ParameterInfo> parameters = request.document.list(name + ".");
        const auto old = instances_.find(name);
        bool goesOn = previous && old != instances_.end() && old->second.extent == extent;
        if (goesOn) {
            const Instance& instance = old->second;
            const std::optional<Redo> change = worstChange(instance.parameters, parameters);
            goesOn = (instance.lastFrame == request.frame ||
                      (instance.lastFrame == previous->frame && contains(previous->instances, name))) &&
                     (!change || (*change < Redo::History && !instance.failed));
        }
        if (!goesOn) {
            Instance& instance = fresh_[name];
            instance.module = findModule(name).make();
            instance.extent = extent;
            instance.parameters = parameters;
            request.document.configure(name, *instance.module);
            instance.module->resize(extent);
        } else {
            request.document.configure(name, *old->second.module);
        }
    }
}

void FrameEngine::adoptFreshInstances(const std::vector<std::string>& active, bool replaces) {
    for (auto& [name, instance] : fresh_) instances_[name] = std::move(instance);
    fresh_.clear();
    // What ran in the frame before, or in this one before it was replaced, stays: it may be asked for again.
    if (replaces) return;
    std::erase_if(instances_, [&](const auto& entry) {
        return !contains(active, entry.first) && !(current_ && contains(current_->instances, entry.first));
    });
}

SignalSet FrameEngine::wantedSignals(const FrameRequest& request) {
    SignalSet wanted = request.signals | shownSignals(request.document);
    for (const std::string& name : request.activeInstances()) {
        const SignalSet reads = running(name).module->reads();
        wanted |= reads;
        // What is shown when a module fails; one that places its own rays has not asked for so much before it does.
        if (!reads.empty() || running(name).failed) wanted.add(Signal::Noisy);
    }
    return wanted;
}

Jitter FrameEngine::effectiveJitter(const Document& document) {
    if (document.jitter() != Jitter::Auto) return document.jitter();
    return running(document.view(0).module).module->preferredJitter();
}

FrameSampling FrameEngine::sampling(const FrameRequest& request, const Completed& next,
                                    const CameraPose& previousCamera) {
    const RenderSettings& render = next.document.render();
    FrameSampling sampling;
    sampling.extent = next.camera.extent;
    sampling.camera = next.camera;
    sampling.previousCamera = previousCamera;
    sampling.frame = static_cast<uint32_t>(request.frame);
    sampling.samplesPerPixel = render.samplesPerPixel;
    sampling.firstSample = static_cast<uint64_t>(request.frame) * static_cast<uint64_t>(render.samplesPerPixel);
    sampling.seed = static_cast<uint32_t>(render.seed);
    sampling.jitter = next.jitter;
    sampling.path = next.document.path();
    sampling.shutterOpen = next.camera.shutter > 0;
    sampling.cameraTrack = next.cameraTrack;
    sampling.previousCameraTrack = next.previousCameraTrack;
    sampling.wanted = wantedSignals(request);
    return sampling;
}

bool FrameEngine::bind(const std::shared_ptr<const PosedScene>& posed, const std::stop_token& stop) {
    if (bound_ == posed) return true;
    bound_ = nullptr;  // if building fails, the next frame builds again
    try {
        tracer_.bind(posed, stop);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Interrupted) throw;
        return false;
    }
    bound_ = posed;
    return true;
}

bool FrameEngine::traceSignals(const FrameRequest& request, const CameraPose& previousCamera, bool replaces,
                               Completed& next, StageTimer& timer, std::stop_token stop,
                               const std::stop_token& sceneStop) {
    if (bound_ != next.scene) {
        const auto measured = timer.measure("build");
        if (!bind(next.scene, sceneStop)) return false;
    }
    const FrameSampling asked = sampling(request, next, previousCamera);
    if (replaces && current_->scene == next.scene && current_->camera == next.camera &&
        current_->cameraTrack == next.cameraTrack && current_->signals->available().contains(asked.wanted)) {
        if (!differences(current_->state(), next.state(), *next.scene).sampling) {
            next.signals = current_->signals;
            next.rays = current_->rays;
            return true;
        }
    }
    const std::shared_ptr<Signals> signals = pool_.take();
    tracer_.resetCounts();
    if (asked.wanted.empty()) {
        signals->reset(asked.extent, {}, asked.samplesPerPixel);
        next.signals = signals;
        next.rays = {};
        return true;
    }
    const auto measured = timer.measure("trace");
    if (!tracer_.sample(asked, *signals, stop)) return false;
    next.signals = signals;
    next.rays = tracer_.counts();
    return true;
}

bool FrameEngine::runModules(const FrameRequest& request, const Completed& next, const CameraPose& previousCamera,
                             FrameOutput& frame, StageTimer& timer, std::stop_token stop) {
    frame.historyDropped = true;
    const std::map<std::string, TapSet> shown = shownTaps(next.document);
    const FrameSampling asked = sampling(request, next, previousCamera);
    for (const std::string& name : next.instances) {
        Instance& current = running(name);
        TapSet wanted;
        if (const auto taps = request.taps.find(name); taps != request.taps.end()) wanted = taps->second;
        if (const auto taps = shown.find(name); taps != shown.end())
            wanted.insert(taps->second.begin(), taps->second.end());
        Changes changes = frame.changes;
        changes.cut = changes.cut || current.lastFrame < 0 || current.firstFrame == request.frame;
        frame.historyDropped = frame.historyDropped && !current.module->keepsHistory(changes);

        timer.setPrefix(name + ".");
        const FrameContext context{request.frame,  *next.signals, *next.scene, next.camera,
                                   previousCamera, changes,       wanted,      tracer_,
                                   asked,          timer,         stop,        request.inspected};
        auto out = std::make_shared<Image>();
        const TraceCounts before = tracer_.counts();
        const Timer run;
        if (!runModule(name, context, *out, frame)) return false;
        frame.runMs[name] = run.elapsedMs();
        frame.runRays[name] = difference(tracer_.counts(), before);
        // what failed shows the noisy frame
        frame.readsSignals[name] = current.failed || !current.module->reads().empty();
        frame.moduleBytes[name] = current.module->byteCount();
        frame.droppedPixels[name] = current.failed ? 0 : current.module->droppedPixels();
        advise(name, *current.module, asked);
        if (current.firstFrame < 0) current.firstFrame = request.frame;
        current.lastFrame = request.frame;
        current.parameters = next.document.list(name + ".");
        frame.results[name] = out;
        frame.convergence[name] = current.failed ? Convergence{} : current.module->convergence();
        if (current.failed) continue;
        if (request.inspected) frame.lineages[name] = current.module->lineage();
        for (const std::string& tap : wanted)
            if (const Image& image = current.module->tap(tap); !image.empty())
                frame.taps[name + "-" + tap] = std::make_shared<Image>(image);
    }
    return true;
}

/// What the method says of its parameters and the frame, once as long as it says the same.
void FrameEngine::advise(const std::string& name, const Module& module, const FrameSampling& sampling) {
    const ModuleEntry& entry = findModule(name);
    const std::string advice = entry.advice ? entry.advice(module, sampling) : "";
    if (!advice.empty() && advice_[name] != advice) log_.warning(name + ": " + advice);
    advice_[name] = advice;
}

bool FrameEngine::runModule(const std::string& name, const FrameContext& context, Image& out, FrameOutput& frame) {
    Instance& current = running(name);
    if (!current.failed) {
        try {
            return current.module->run(context, out) == RunResult::Completed;
        } catch (const Error& error) {
            if (onError_ == OnModuleError::Throw || error.kind() == ErrorKind::Interrupted) throw;
            log_.error(name + ": " + error.what() + "; showing the raw frame instead");
        } catch (const std::exception& error) {
            if (onError_ == OnModuleError::Throw) throw;
            log_.error(name + ": failed (" + error.what() + "); showing the raw frame instead");
        }
        current.failed = true;
    }
    if (context.signals.available().has(Signal::Noisy)) {
        out = context.signals[Signal::Noisy];
        return true;
    }
    FrameSampling sampling = context.sampling;
    sampling.wanted = {Signal::Noisy};
    Signals raw;
    if (!tracer_.sample(sampling, raw, context.stop)) return false;
    out = raw[Signal::Noisy];
    return true;
}

bool FrameEngine::canRepeat(FrameNumber frame) const {
    return current_ && current_->frame == frame &&
           std::none_of(instances_.begin(), instances_.end(), [&](const auto& entry) {
               return entry.second.lastFrame > frame && contains(current_->instances, entry.first);
           });
}

size_t FrameEngine::byteCount() const {
    size_t bytes = tracer_.byteCount();
    bytes += pool_.byteCount() + previewPool_.byteCount();
    for (const auto& [name, current] : instances_) bytes += current.module->byteCount();
    return bytes;
}

}  // namespace lumi

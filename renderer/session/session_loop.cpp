#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "session/changes.h"
#include "session/session_impl.h"
#include "session/view_buffers.h"

namespace lumi {
namespace {

std::string paneLabel(const FrameOutput& frame, const ViewSettings& view) {
    std::string label = view.module;
    if (view.buffer != "image") label += " " + view.buffer;
    const auto convergence = frame.convergence.find(view.module);
    uint64_t samples = static_cast<uint64_t>(frame.signals->samplesPerPixel());
    if (convergence != frame.convergence.end() && convergence->second.samples > 0) samples = convergence->second.samples;
    return label + fmt::format(", {} spp, equal samples", samples);
}

}  // namespace

void Session::Impl::loop(std::stop_token quit) {
    flushDenormals();
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 10);
    while (!quit.stop_requested()) {
        Work work;
        {
            std::unique_lock lock(mutex);
            wake.wait(lock, quit, [this] { return hasWork(); });
            if (quit.stop_requested()) break;
            work = takeWork();
        }
        try {
            perform(work);
        } catch (const std::exception& error) {
            log.error(error.what());
            std::lock_guard lock(mutex);
            frameFailed = true;
        }
        std::lock_guard lock(mutex);
        drawing = steppingBack = false;
    }
    finishSaves();
}

bool Session::Impl::hasWork() const {
    if (!document) return false;
    if (pending || stepWanted || stepsBack > 0 || restartWanted || !saves.empty()) return true;
    return rendering && !frameFailed && (!resting || playing);
}

Session::Impl::Work Session::Impl::takeWork() {
    frameStop = std::stop_source();
    Work work;
    work.stop = frameStop.get_token();
    work.inspecting = inspecting;
    work.sceneNumber = sceneNumber;
    const bool idle = (!rendering || resting) && !stepWanted;
    const Redo redo = pending.value_or(Redo::Display);
    if (restartWanted) {
        work.cut = true;
    } else if (stepsBack > 0) {
        work.kind = Work::StepBack;
        work.stepsBack = std::exchange(stepsBack, 0);
        work.revision = revision;
        work.states = states;
        drawing = steppingBack = true;
        heldBack = guarded = false;
        return work;
    } else if (shownDocument && pending && redo == Redo::Display) {
        work.kind = Work::Display;
    } else if (shownDocument && pending && redo == Redo::Filter && idle) {
        work.kind = Work::Redraw;
    } else if (!pending && !saves.empty() && shownDocument) {
        work.kind = Work::SaveView;
        work.save = saves.front();
        work.states = states;
        saves.pop_front();
        return work;
    }
    const bool newFrame = work.kind == Work::Frame;
    const bool timeGoesOn = playing && (rendering || stepWanted) && !timeEdited && !work.cut;
    if (newFrame && timeGoesOn && shownDocument) {
        document->setTime(shownDocument->time() + 1 / document->render().fps);
        ++revision;
    }
    restartWanted = restartWanted && !newFrame;
    stepWanted = stepWanted && !newFrame;
    work.redo = std::exchange(pending, std::nullopt);
    timeEdited = false;
    drawing = newFrame || work.kind == Work::Redraw;
    heldBack = false;
    sinceFrameBegan.restart();
    // Frames of an unchanged document share it: that keeps the log short.
    if (!takenDocument || takenRevision != revision) takenDocument = std::make_shared<Document>(*document);
    takenRevision = revision;
    work.document = takenDocument;
    work.revision = revision;
    return work;
}

void Session::Impl::perform(const Work& work) {
    switch (work.kind) {
        case Work::Frame:
        case Work::Redraw: drawFrame(work); break;
        case Work::StepBack: stepBack(work); break;
        case Work::SaveView: saveView(work); break;
        case Work::Display:
            shownDocument = work.document;
            shownRevision = work.revision;
            {
                std::lock_guard lock(mutex);
                if (work.sceneNumber != sceneNumber) return;
                states.redescribeLast(work.document);
            }
            publish();
            break;
    }
}

void Session::Impl::drawFrame(const Work& work) {
    const bool first = work.cut || shown.number < 0;
    const FrameNumber number = first ? 0 : work.kind == Work::Redraw ? shown.number : shown.number + 1;
    FrameRequest request{*work.document, number, first, {}, {}};
    if (work.inspecting)
        for (const std::string& instance : work.document->activeInstances()) {
            const BufferSelection all = BufferSelection::all(instance);
            request.signals |= all.signals;
            request.taps[instance] = all.taps;
        }
    std::optional<FrameOutput> frame = engine.advance(request, work.stop);
    if (frame) return complete(std::move(*frame), work);
    std::lock_guard lock(mutex);
    guarded = true;
    // What this frame was to show has not been seen; the next takes it up.
    restartWanted = restartWanted || work.cut;
    giveUp(work);
}

/// A frame of `work` was stopped; the caller holds the lock.
void Session::Impl::giveUp(const Work& work) {
    ++abandoned;
    pending = std::max(pending, work.redo);
    // Where a module is ahead of the frame shown, that frame cannot be drawn again: go on to the next.
    if (shown.number >= 0 && !engine.canRepeat(shown.number)) pending = std::max(pending, std::optional(Redo::Samples));
}

void Session::Impl::complete(FrameOutput frame, const Work& work) {
    {
        std::lock_guard lock(mutex);
        if (work.sceneNumber != sceneNumber) return;  // of a scene that is gone
        shown = std::move(frame);
        shownDocument = work.document;
        shownRevision = work.revision;
        states.record(shown, shownDocument);
        resting = shown.rests();
        guarded = false;
    }
    publish();
}

void Session::Impl::stepBack(const Work& work) {
    const StateLog& replayed = work.states;
    if (replayed.size() < 2) return log.info("There is no earlier frame.");
    const size_t target = replayed.size() - 1 - std::min<size_t>(replayed.size() - 1, static_cast<size_t>(work.stepsBack));
    const size_t start = replayed.startOf(target);
    std::optional<FrameOutput> frame;
    size_t reached = start;
    for (size_t i = start; i <= target; ++i) {
        const StateLog::Entry& entry = replayed.entry(i);
        std::optional<FrameOutput> next = engine.advance({*entry.document, entry.frame, i == start, {}, {}}, work.stop);
        if (!next) break;
        next->changes.cut = entry.cut;  // the log keeps what was, not that a replay begins with a cut
        next->historyDropped = entry.historyDropped;
        frame = std::move(next);
        reached = i;
    }
    std::lock_guard lock(mutex);
    if (work.sceneNumber != sceneNumber) return;
    if (frame) {
        states.truncate(reached + 1);
        shown = std::move(*frame);
        shownDocument = replayed.entry(reached).document;
        resting = shown.rests();
    }
    if (!frame || reached < target) giveUp(work);
    if (revision == work.revision) {
        if (frame) document = *shownDocument;
        ++revision;
        pending = std::max(pending, std::optional(Redo::Display));
    } else if (frame) {
        // Edits that came meanwhile stay; the frame takes them up.
        pending = std::max(pending, std::optional(worstDifference(*shownDocument, *document)));
    }
}

void Session::Impl::saveView(const Work& work) {
    const Save& save = work.save;
    if (work.states.empty()) return log.error(save.path.string() + ": the scene that it was to show is gone");
    if (!shown.results.count(shownDocument->view(save.view).module))
        return log.error(save.path.string() + ": this view is not drawn at present");
    const OutputChoice choice{save.view, "all", false};
    const std::string instance = shownDocument->view(save.view).module;
    FrameRequest request{*shownDocument, shown.number, false, {}, {}};
    std::shared_ptr<const FrameOutput> frame;
    if (lowerExtension(save.path) == ".exr") {
        // The same frame once more, with every buffer.
        if (!engine.canRepeat(shown.number)) return log.error(save.path.string() + ": not saved, its frame was given up");
        const BufferSelection all = BufferSelection::all(instance);
        request.signals = all.signals;
        request.taps[instance] = all.taps;
        std::optional<FrameOutput> full = engine.advance(request);
        if (full) frame = std::make_shared<FrameOutput>(std::move(*full));
    } else {
        frame = std::make_shared<FrameOutput>(shown);
    }
    runAside([this, save, choice, frame, states = work.states, from = shownDocument](std::stop_token) {
        try {
            exportView(save.path, *frame, *from, choice, states.json(choice.json()));
            log.info("Saved " + save.path.string());
        } catch (const std::exception& error) {
            log.error(error.what());
        }
    });
}

/// What was asked to be saved before the end.
void Session::Impl::finishSaves() {
    Work work;
    {
        std::lock_guard lock(mutex);
        if (shownDocument) work.states = states;
    }
    for (const Save& save : saves) {
        work.save = save;
        try {
            saveView(work);
        } catch (const std::exception& error) {
            log.error(error.what());
        }
    }
}

void Session::Impl::publish() {
    Timer timer;
    auto next = std::make_shared<Snapshot>();
    next->frame = shown.number;
    next->serial = ++serial;
    next->revision = shownRevision;
    next->time = shown.time;
    next->extent = shown.camera.extent;
    next->camera = shown.camera;
    next->scene = shown.scene;
    next->signals = shown.signals;
    next->results = shown.results;
    next->taps = shown.taps;
    const int count = shownDocument->layout() == Layout::Single ? 1 : kViewCount;
    for (int i = 0; i < count; ++i) {
        const ViewSettings& view = shownDocument->view(i);
        PaneSnapshot& pane = next->panes.emplace_back();
        pane.module = view.module;
        pane.buffer = view.buffer;
        pane.label = paneLabel(shown, view);
        pane.pixels = drawView(shown, view, pane.info);
    }
    for (const auto& [name, convergence] : shown.convergence) {
        if (convergence.samples == 0 || next->accumulatedSamples > 0) continue;
        next->accumulatedSamples = convergence.samples;
        next->targetSamples = convergence.target;
    }
    next->stagesMs = shown.stagesMs;
    next->stagesMs.emplace_back("display", timer.elapsedMs());
    next->frameMs = shown.frameMs + timer.elapsedMs();
    next->rays = shown.rays;
    for (const auto& [stage, ms] : shown.stagesMs)
        if (stage == "trace" && ms > 0) next->raysPerSecond = static_cast<double>(shown.rays.total()) / ms * 1000;
    std::lock_guard lock(mutex);
    snapshot = std::move(next);
}

}  // namespace lumi

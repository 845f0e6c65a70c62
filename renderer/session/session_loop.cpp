#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
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
            if (quit.stop_requested()) return;
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
        drawing = false;
    }
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
    const bool idle = (!rendering || resting) && !stepWanted;
    const Redo redo = pending.value_or(Redo::Display);
    if (restartWanted) {
        work.cut = true;
    } else if (stepsBack > 0) {
        work.kind = Work::StepBack;
        work.stepsBack = std::exchange(stepsBack, 0);
        return work;
    } else if (shownDocument && pending && redo == Redo::Display) {
        work.kind = Work::Display;
    } else if (shownDocument && pending && redo == Redo::Filter && idle) {
        work.kind = Work::Redraw;
    } else if (!pending && !saves.empty() && shownDocument) {
        work.kind = Work::SaveView;
        work.save = saves.front();
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
    ++abandoned;
    guarded = true;
    // What this frame was to show has not been seen; the next takes it up.
    restartWanted = restartWanted || work.cut;
    pending = std::max(pending, work.redo);
}

void Session::Impl::complete(FrameOutput frame, const Work& work) {
    shown = std::move(frame);
    shownDocument = work.document;
    shownRevision = work.revision;
    {
        std::lock_guard lock(mutex);
        states.record(shown, shownDocument);
        resting = shown.rests();
        guarded = false;
    }
    publish();
}

void Session::Impl::stepBack(const Work& work) {
    StateLog replayed;
    {
        std::lock_guard lock(mutex);
        replayed = states;
    }
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
    if (!frame) {
        restartWanted = true;
        return;
    }
    states.truncate(reached + 1);
    shown = std::move(*frame);
    shownDocument = states.entry(reached).document;
    document = *shownDocument;
    ++revision;
    pending = Redo::Display;
    resting = shown.rests();
}

void Session::Impl::saveView(const Work& work) {
    const Save& save = work.save;
    if (!shown.results.count(shownDocument->view(save.view).module))
        return log.error(save.path.string() + ": this view is not drawn at present");
    const OutputChoice choice{save.view, "all", false};
    const std::string instance = shownDocument->view(save.view).module;
    FrameRequest request{*shownDocument, shown.number, false, {}, {}};
    std::shared_ptr<const FrameOutput> frame;
    if (lowerExtension(save.path) == ".exr") {
        // The same frame once more, with every buffer.
        const BufferSelection all = BufferSelection::all(instance);
        request.signals = all.signals;
        request.taps[instance] = all.taps;
        std::optional<FrameOutput> full = engine.advance(request);
        if (full) frame = std::make_shared<FrameOutput>(std::move(*full));
    } else {
        frame = std::make_shared<FrameOutput>(shown);
    }
    StateLog recorded;
    {
        std::lock_guard lock(mutex);
        recorded = states;
    }
    runAside([this, save, choice, frame, recorded, from = shownDocument](std::stop_token) {
        try {
            exportView(save.path, *frame, *from, choice, recorded.json(choice.json()));
            log.info("Saved " + save.path.string());
        } catch (const std::exception& error) {
            log.error(error.what());
        }
    });
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

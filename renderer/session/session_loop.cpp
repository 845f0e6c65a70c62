#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/parallel.h"
#include "session/session_impl.h"

namespace lumi {

void Session::Impl::loop(std::stop_token quit) {
    flushDenormals();
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), 10);
    while (!quit.stop_requested()) {
        Work work;
        {
            std::unique_lock lock(mutex);
            while (!quit.stop_requested() && !hasWork()) {
                if (waitsForStream()) wake.wait_for(lock, quit, std::chrono::milliseconds(10), [] { return false; });
                else wake.wait(lock, quit, [this] { return hasWork() || waitsForStream(); });
            }
            if (quit.stop_requested()) break;
            work = takeWork();
            working = true;
        }
        try {
            perform(work);
        } catch (const std::exception& error) {
            log.error(error.what());
            std::lock_guard lock(mutex);
            frameFailed = true;
        }
        std::lock_guard lock(mutex);
        working = drawing = steppingBack = checking = false;
        replayed.reset();
    }
    finishSaves();
}

bool Session::Impl::hasWork() const {
    if (!document) return false;
    if (stepWanted || stepsBack > 0 || restartWanted) return true;
    if (!questions.empty()) return true;
    if (pending) return !waitsForStream();
    if (!saves.empty()) return true;
    if (checkWanted && shownDocument && sinceChange.elapsedMs() >= kQuietMs) return true;
    return rendering && !frameFailed && (!resting || playing);
}

/// Nothing to do before changes pause, or before nothing changed for a while.
bool Session::Impl::waitsForStream() const {
    if (!document) return false;
    if (!pending) return checkWanted && shownDocument && sinceChange.elapsedMs() < kQuietMs;
    return *pending >= Redo::Samples && previewedRevision == revision && changesStream();
}

/// The size of a preview that is quickly drawn, where a frame of the document is not.
std::optional<Extent2> Session::Impl::previewExtent() const {
    if (!document || !shownDocument || msPerSample <= 0) return std::nullopt;
    const RenderSettings& render = document->render();
    const double pixels = static_cast<double>(render.width) * render.height;
    if (msPerSample * pixels * render.samplesPerPixel < kSmoothMs) return std::nullopt;
    const double scale = std::clamp(std::sqrt(kPreviewMs / (msPerSample * pixels)), 1 / kCoarsest, 1.0);
    const auto side = [&](int full) { return std::max(1, static_cast<int>(std::lround(full * scale))); };
    return Extent2{side(render.width), side(render.height)};
}

/// Is the shown frame what was to be saved, and can it be? Behind a preview the frame that it stands for is yet to
/// come, and a frame of which a part was drawn anew cannot be drawn again with its buffers.
bool Session::Impl::mayBeSaved(const Save& save) const {
    if (!shownDocument) return false;
    const bool followed = pending || restartWanted || stepsBack > 0;
    if (states.empty() || !followed) return true;
    if (snapshot && snapshot->preview) return false;
    const bool isPicture = (save.capture.empty() ? lowerExtension(save.path) : "." + save.capture) == ".png";
    return isPicture || engine.canRepeat(shown.number);
}

/// What is to be saved comes before changes: it is what was seen.
bool Session::Impl::takeSave(Work& work) {
    if (saves.empty() || !mayBeSaved(saves.front())) return false;
    work.kind = Work::SaveView;
    work.save = saves.front();
    work.states = states;
    saves.pop_front();
    return true;
}

/// Work that draws no new frame of the sequence: earlier ones again, a preview, a file, a check. False if there is
/// none.
bool Session::Impl::takeAside(Work& work) {
    if (!questions.empty()) {
        work.kind = Work::Pick;
        work.question = questions.front();
        work.states = states;
        questions.pop_front();
        return true;
    }
    if (takeSave(work)) return true;
    if (restartWanted) return false;
    if (stepsBack > 0) {
        work.kind = Work::StepBack;
        work.stepsBack = std::exchange(stepsBack, 0);
        work.document = std::make_shared<Document>(*document);
        work.revision = revision;
        work.states = states;
        drawing = steppingBack = true;
        heldBack = guarded = false;
        clock.reset();
        return true;
    }
    const bool streams = pending && *pending >= Redo::Samples && !stepWanted && changesStream();
    if (const std::optional<Extent2> coarse = streams ? previewExtent() : std::nullopt; coarse) {
        work.kind = Work::Preview;
        work.coarse = *coarse;
        work.document = std::make_shared<Document>(*document);
        work.revision = previewedRevision = revision;
        return true;
    }
    if (pending || !shownDocument) return false;
    if (checkWanted && !stepWanted && sinceChange.elapsedMs() >= kQuietMs) {
        work.kind = Work::Check;
        work.document = std::make_shared<Document>(*document);
        checkWanted = false;
        drawing = checking = true;
        guarded = false;
        return true;
    }
    return false;
}

/// The document's time for the frame that `work` draws, where time goes on.
void Session::Impl::advanceTime(const Work& work) {
    const bool goesOn = playing && (rendering || stepWanted) && !timeEdited && !work.cut;
    if (!goesOn || !shownDocument) return clock.reset();
    const float fps = document->render().fps;
    // From the first frame on, where that gives the present time too, else from the present frame on.
    if (!clock || pending) clock = Clock{0, 0, fps};
    if (clock->at(shown.number) != shownDocument->time()) clock = Clock{shown.number, shownDocument->time(), fps};
    document->setTime(clock->at(shown.number + 1));
    ++revision;
}

Session::Impl::Work Session::Impl::takeWork() {
    frameStop = std::stop_source();
    Work work;
    work.stop = frameStop.get_token();
    work.sceneStop = sceneStop.get_token();
    work.inspecting = inspecting;
    work.inspectedPixel = inspectedPixel;
    work.sceneNumber = sceneNumber;
    if (takeAside(work)) return work;
    const bool idle = (!rendering || resting) && !stepWanted;
    const Redo redo = pending.value_or(Redo::Display);
    work.cut = restartWanted;
    work.firstFrame = restartFrame;
    if (!work.cut && shownDocument && pending && redo == Redo::Display) work.kind = Work::Display;
    else if (!work.cut && shownDocument && pending && redo == Redo::Filter && idle) work.kind = Work::Redraw;
    const bool newFrame = work.kind == Work::Frame;
    if (newFrame) advanceTime(work);
    restartWanted = restartWanted && !newFrame;
    stepWanted = stepWanted && (!newFrame || work.cut);  // a step asked for after a restart goes on from there
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
        case Work::Pick: answer(work); break;
        case Work::Preview: drawPreview(work); break;
        case Work::Check: checkSignals(work); break;
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

/// A frame with all that is to be told of it.
FrameRequest Session::Impl::requestOf(const Work& work, const Document& drawn, FrameNumber number, bool cut) const {
    FrameRequest request{drawn, number, cut, {}, {}};
    request.inspected = work.inspectedPixel;
    if (!work.inspecting) return request;
    for (const std::string& instance : drawn.activeInstances()) {
        const BufferSelection all = BufferSelection::all(instance);
        request.signals |= all.signals;
        request.taps[instance] = all.taps;
    }
    return request;
}

void Session::Impl::drawFrame(const Work& work) {
    const bool first = work.cut || shown.number < 0;
    const FrameNumber number = first ? work.firstFrame : work.kind == Work::Redraw ? shown.number : shown.number + 1;
    Timer timer;
    std::optional<FrameOutput> frame =
        engine.advance(requestOf(work, *work.document, number, first), work.stop, work.sceneStop);
    if (frame) {
        complete(std::move(*frame), work);
        // The scene before, its loaders' scratch and its frames are gone: their memory goes back to the system.
        if (work.cut && work.firstFrame == 0) malloc_trim(0);
        return;
    }
    const auto traced = static_cast<double>(engine.tracedSoFar().cameraRays);
    std::lock_guard lock(mutex);
    guarded = true;
    // A frame that hardly began says little.
    if (timer.elapsedMs() > kPreviewMs && traced > 1000) learnCost(timer.elapsedMs(), traced);
    // What this frame was to show has not been seen; the next takes it up.
    restartFrame = work.cut ? work.firstFrame : restartFrame;
    restartWanted = restartWanted || work.cut;
    giveUp(work);
}

/// Takes up what a frame, or a part of one, cost; the caller holds the lock.
void Session::Impl::learnCost(double ms, double pixelSamples) { msPerSample = ms / std::max(pixelSamples, 1.0); }

void Session::Impl::drawPreview(const Work& work) {
    const std::optional<FrameOutput> coarse = engine.preview(*work.document, work.coarse, work.stop, work.sceneStop);
    if (!coarse) return;
    {
        std::lock_guard lock(mutex);
        if (work.sceneNumber != sceneNumber) return;
        learnCost(coarse->stagesMs.front().second, static_cast<double>(work.coarse.area()));
    }
    publishPreview(*coarse, work);
}

void Session::Impl::checkSignals(const Work& work) {
    auto result = std::make_shared<SignalCheck>();
    try {
        result->frames = engine.checkSignals(*work.document, work.stop, work.sceneStop);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::Interrupted) {
            std::lock_guard lock(mutex);
            checkWanted = checkWanted || work.sceneNumber == sceneNumber;  // something changed: when it is quiet again
            return;
        }
        result->failure = error.what();
    }
    std::lock_guard lock(mutex);
    if (work.sceneNumber == sceneNumber) signalCheck = std::move(result);
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
        if (resting || !rendering) completedMs.clear();
        shownRate = measuredRate();
        resting = shown.rests();
        guarded = false;
        double tracedMs = 0, builtMs = 0;
        for (const auto& [stage, ms] : shown.stagesMs) (stage == "build" || stage == "pose" ? builtMs : tracedMs) += ms;
        const int samples = shown.signals->samplesPerPixel();
        if (work.kind == Work::Frame) learnCost(tracedMs, static_cast<double>(shown.camera.extent.area()) * samples);
    }
    publish();
}

}  // namespace lumi

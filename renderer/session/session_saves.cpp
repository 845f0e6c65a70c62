#include "base/files.h"
#include "session/session_impl.h"

namespace lumi {

void Session::Impl::saveView(const Work& work) {
    const Save& save = work.save;
    if (work.states.empty()) return log.error(save.path.string() + ": the scene that it was to show is gone");
    const OutputChoice& choice = save.choice;
    const std::string instance = shownDocument->view(choice.view).module;
    if (!shown.results.count(instance)) return log.error(save.path.string() + ": this view is not drawn at present");
    FrameRequest request{*shownDocument, shown.number, false, {}, {}};
    std::shared_ptr<const FrameOutput> frame;
    if (lowerExtension(save.path) == ".exr") {
        // The same frame once more, with the buffers.
        if (!engine.canRepeat(shown.number)) return log.error(save.path.string() + ": not saved, its frame was given up");
        const BufferSelection buffers = BufferSelection::parse(choice.buffers, instance, save.path.string());
        request.signals = buffers.signals;
        request.signals.add(Signal::Depth);
        request.taps[instance] = buffers.taps;
        std::optional<FrameOutput> full = engine.advance(request);
        if (full) frame = std::make_shared<FrameOutput>(std::move(*full));
    } else {
        frame = std::make_shared<FrameOutput>(shown);
    }
    runAside([this, save, frame, states = work.states, from = shownDocument](std::stop_token) {
        try {
            exportView(save.path, *frame, *from, save.choice, states.json(save.choice.json()));
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

}  // namespace lumi

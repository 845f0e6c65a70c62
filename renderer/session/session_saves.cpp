#include <fmt/format.h>

#include "base/files.h"
#include "session/session_impl.h"

namespace lumi {

void Session::Impl::saveView(const Work& work) {
    const OutputChoice& choice = work.save.choice;
    const ViewSettings& view = shownDocument->view(choice.view);
    std::filesystem::path path = work.save.path;
    const bool isCapture = !work.save.capture.empty();
    if (isCapture) path += fmt::format(".{}.{}.{:04}.{}", view.module, view.buffer, shown.number, work.save.capture);
    if (work.states.empty()) return log.error(path.string() + ": the scene that it was to show is gone");
    if (!shown.results.count(view.module)) return log.error(path.string() + ": this view is not drawn at present");
    FrameRequest request{*shownDocument, shown.number, false, {}, {}};
    std::shared_ptr<const FrameOutput> frame;
    if (lowerExtension(path) == ".exr") {
        // The same frame once more, with the buffers.
        if (!engine.canRepeat(shown.number)) return log.error(path.string() + ": not saved, its frame was given up");
        const BufferSelection buffers = BufferSelection::parse(choice.buffers, view.module, path.string());
        request.signals = buffers.signals;
        request.signals.add(Signal::Depth);
        request.taps[view.module] = buffers.taps;
        std::optional<FrameOutput> full = engine.advance(request);
        if (full) frame = std::make_shared<FrameOutput>(std::move(*full));
    } else {
        frame = std::make_shared<FrameOutput>(shown);
    }
    runAside([this, path, isCapture, choice, frame, states = work.states, from = shownDocument](std::stop_token) {
        try {
            const std::string state = states.json(choice.json());
            const Written written = isCapture ? exportNewView(path, *frame, *from, choice, state)
                                              : exportView(path, *frame, *from, choice, state);
            written.warn(log);
            log.info("Saved " + written.path.string());
        } catch (const std::exception& error) {
            log.error(error.what());
        }
    });
}

/// Through the middle of the pixel of the frame that is shown; of a preview, its scene by the camera of the frame.
void Session::Impl::answer(const Work& work) {
    const Pixel pixel = work.question->pixel;
    const Extent2 extent = shown.camera.extent;
    const bool inside = pixel.x >= 0 && pixel.y >= 0 && pixel.x < extent.width && pixel.y < extent.height;
    const bool ofPresent = shownDocument && !work.states.empty();
    work.question->answer.set_value(inside && ofPresent ? engine.surfaceAt(shown.camera, pixel) : std::nullopt);
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

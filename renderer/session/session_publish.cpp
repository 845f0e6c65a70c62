#include <fmt/format.h>

#include <cstring>

#include "session/ray_rate.h"
#include "session/session_impl.h"
#include "session/view_buffers.h"

namespace lumi {
namespace {

/// Does the view show what a method that places its own rays made of them?
bool showsOwnRays(const FrameOutput& frame, const ViewSettings& view) {
    const auto reads = frame.readsSignals.find(view.module);
    return reads != frame.readsSignals.end() && !reads->second && signalByName(view.buffer) == Signal::Count;
}

/// `equal`: all panes show what is made of the same samples.
std::string paneLabel(const FrameOutput& frame, const ViewSettings& view, bool equal) {
    std::string label = view.module;
    if (view.buffer != "image") label += " " + view.buffer;
    const auto convergence = frame.convergence.find(view.module);
    if (showsOwnRays(frame, view)) {
        // A method that places its own rays has neither the frame's samples nor as many as other methods.
        if (convergence != frame.convergence.end() && convergence->second.samples > 1)
            return label + fmt::format(", {} paths a sample", convergence->second.samples);
        const auto rays = frame.runRays.find(view.module);
        const auto bytes = frame.moduleBytes.find(view.module);
        if (rays == frame.runRays.end() || bytes == frame.moduleBytes.end()) return label;
        const auto pixels = static_cast<double>(std::max<int64_t>(frame.camera.extent.area(), 1));
        return label + fmt::format(", {:.3g} camera rays/px of its own, {:.0f} bytes/px",
                                   static_cast<double>(rays->second.cameraRays) / pixels,
                                   static_cast<double>(bytes->second) / pixels);
    }
    uint64_t samples = static_cast<uint64_t>(frame.signals->samplesPerPixel());
    if (convergence != frame.convergence.end() && convergence->second.samples > 0)
        samples = convergence->second.samples;
    return label + fmt::format(", {} spp", samples) + (equal ? ", equal samples" : "");
}

/// The picture with each pixel as many times as it takes to fill `extent`.
std::shared_ptr<const Image8> enlarged(const Image8& coarse, Extent2 extent) {
    auto full = std::make_shared<Image8>();
    full->extent = extent;
    const auto width = static_cast<size_t>(extent.width), height = static_cast<size_t>(extent.height);
    const auto coarseWidth = static_cast<size_t>(coarse.extent.width),
               coarseHeight = static_cast<size_t>(coarse.extent.height);
    full->rgba.resize(4 * width * height);
    size_t drawn = coarseHeight;  // the coarse row in the row above
    for (size_t y = 0; y < height; ++y) {
        uint8_t* row = &full->rgba[4 * width * y];
        const size_t from = y * coarseHeight / height;
        if (from == drawn) {
            std::memcpy(row, row - 4 * width, 4 * width);
            continue;
        }
        drawn = from;
        for (size_t x = 0; x < width; ++x)
            std::memcpy(row + 4 * x, &coarse.rgba[4 * (from * coarseWidth + x * coarseWidth / width)], 4);
    }
    return full;
}

}  // namespace

/// Frames a second, from those that followed each other without a rest within the last seconds.
double Session::Impl::measuredRate() {
    constexpr double kWindowMs = 3000;
    constexpr size_t kMost = 64;
    const double now = sinceStart.elapsedMs();
    completedMs.push_back(now);
    // Two are kept however long a frame takes.
    while (completedMs.size() > 2 && (completedMs.size() > kMost || now - completedMs.front() > kWindowMs))
        completedMs.pop_front();
    const double spanMs = now - completedMs.front();
    return spanMs > 0 ? 1000 * static_cast<double>(completedMs.size() - 1) / spanMs : 0;
}

void Session::Impl::publish() {
    Timer timer;
    auto next = std::make_shared<Snapshot>();
    next->frame = shown.number;
    next->serial = ++serial;
    next->revision = shownRevision;
    next->time = shown.time;
    next->extent = next->traced = shown.camera.extent;
    next->camera = shown.camera;
    next->scene = shown.scene;
    next->document = shownDocument;
    next->signals = shown.signals;
    next->results = shown.results;
    next->taps = shown.taps;
    next->lineages = shown.lineages;
    const int count = shownDocument->layout() == Layout::Single ? 1 : kViewCount;
    bool equal = count > 1;
    for (int i = 0; i < count; ++i) equal &= !showsOwnRays(shown, shownDocument->view(i));
    for (int i = 0; i < count; ++i) {
        const ViewSettings& view = shownDocument->view(i);
        PaneSnapshot& pane = next->panes.emplace_back();
        pane.module = view.module;
        pane.buffer = view.buffer;
        pane.label = paneLabel(shown, view, equal);
        pane.pixels = drawView(shown, view, pane.info);
        if (const auto dropped = shown.droppedPixels.find(view.module); dropped != shown.droppedPixels.end())
            pane.droppedPixels = dropped->second;
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
    next->raysPerSecond = rayRate(shown).perSecond();
    next->framesPerSecond = shownRate;
    std::lock_guard lock(mutex);
    snapshot = std::move(next);
}

void Session::Impl::publishPreview(const FrameOutput& coarse, const Work& work) {
    Timer timer;
    auto next = std::make_shared<Snapshot>();
    const Document& moving = *work.document;
    next->preview = true;
    next->frame = shown.number;
    next->serial = ++serial;
    next->revision = shownRevision;
    next->time = coarse.time;
    next->extent = {moving.render().width, moving.render().height};
    next->traced = coarse.camera.extent;
    next->camera = poseCamera(moving.camera(), next->extent);
    next->scene = coarse.scene;
    next->document = work.document;
    const int count = moving.layout() == Layout::Single ? 1 : kViewCount;
    for (int i = 0; i < count; ++i) {
        const ViewSettings& view = moving.view(i);
        PaneSnapshot& pane = next->panes.emplace_back();
        pane.module = view.module;
        pane.buffer = view.buffer;
        pane.label = fmt::format("{}, preview, {} x {}", view.module, next->traced.width, next->traced.height);
        pane.pixels = enlarged(*drawView(coarse, view, pane.info), next->extent);
    }
    next->stagesMs = coarse.stagesMs;
    next->frameMs = coarse.frameMs + timer.elapsedMs();
    next->rays = coarse.rays;
    next->raysPerSecond = rayRate(coarse).perSecond();
    next->framesPerSecond = measuredRate();
    std::lock_guard lock(mutex);
    if (work.sceneNumber == sceneNumber) snapshot = std::move(next);
}

}  // namespace lumi

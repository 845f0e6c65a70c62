#include "session/session.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/parallel.h"
#include "reconstruct/catalog.h"
#include "session/changes.h"
#include "session/session_impl.h"
#include "session/view_buffers.h"

namespace lumi {

Session::Impl::Impl(MessageLog& log_) : log(log_), engine(log_, FrameEngine::OnModuleError::ShowRawFrame) {
    lowerWorkerPriority();
    thread = std::jthread([this](std::stop_token quit) { loop(quit); });
    watcher = std::jthread([this](std::stop_token quit) { watch(quit); });
}

Session::Impl::~Impl() {
    {
        std::lock_guard lock(mutex);
        thread.request_stop();
        frameStop.request_stop();
        sceneStop.request_stop();
        loadStop.request_stop();
    }
    wake.notify_all();
    thread.join();  // it may yet write what was to be saved
    reapThreads(true);
}

Document& Session::Impl::requireDocument() {
    if (!document) throwUsage({"no scene is open", "", "", ""});
    return *document;
}

void Session::Impl::noteChange(Redo redo) {
    ++revision;
    pending = std::max(pending.value_or(redo), redo);
    if (redo >= Redo::Samples) signalCheck = nullptr;  // what was checked is not what is drawn any more
    frameFailed = false;
    if (redo >= Redo::Filter) abandonFrame();
    wake.notify_all();
}

void Session::Impl::abandonFrame() {
    const bool streams = changesStream();
    sinceChange.restart();
    if (!drawing || frameStop.stop_requested()) return;
    if (guarded && streams && !previewExtent() && sinceFrameBegan.elapsedMs() < kShortMs) {
        heldBack = true;
        wake.notify_all();
    } else {
        frameStop.request_stop();
    }
}

void Session::Impl::watch(std::stop_token quit) {
    std::unique_lock lock(mutex);
    while (!quit.stop_requested()) {
        wake.wait(lock, quit, [this] { return heldBack; });
        wake.wait_for(lock, quit, std::chrono::milliseconds(10), [] { return false; });
        if (heldBack && (sinceChange.elapsedMs() >= kStreamMs || sinceFrameBegan.elapsedMs() >= kShortMs)) {
            heldBack = false;
            if (drawing) frameStop.request_stop();
        }
    }
}

/// More of the shown frame is asked for than it has. If no frame follows that has it, it is drawn again; nothing that
/// is being drawn is given up for that.
void Session::Impl::lookCloser() {
    if (!document || (rendering && !resting)) return;
    ++revision;  // what is shown is not all that is asked for
    pending = std::max(pending.value_or(Redo::Filter), Redo::Filter);
    frameFailed = false;
    wake.notify_all();
}

/// Puts a whole document in the present one's place; what that invalidates follows from what differs.
void Session::Impl::replaceDocument(const Document& next) {
    const Redo worst = worstDifference(*document, next);
    timeEdited = timeEdited || document->time() != next.time();
    document = next;
    ++environmentGeneration;  // a sky on its way would undo what was just put back
    noteChange(worst);
}

Session::Session(MessageLog& log) : impl_(std::make_unique<Impl>(log)) {}
Session::~Session() = default;

void Session::setInspecting(bool on) {
    std::lock_guard lock(impl_->mutex);
    if (impl_->inspecting == on) return;
    impl_->inspecting = on;
    if (on) impl_->lookCloser();
}

void Session::setInspectedPixel(std::optional<Pixel> pixel) {
    std::lock_guard lock(impl_->mutex);
    if (impl_->inspectedPixel == pixel) return;
    impl_->inspectedPixel = pixel;
    if (pixel) impl_->lookCloser();
}

void Session::open(const std::filesystem::path& scene, const SceneChoice& choice,
                   std::vector<std::pair<std::string, std::string>> set) {
    impl_->startLoading({scene, choice, std::move(set)});
}

bool Session::hasScene() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->document.has_value();
}

void Session::reload() {
    Impl::Origin origin;
    {
        std::lock_guard lock(impl_->mutex);
        origin = impl_->origin;
    }
    if (!origin.path.empty()) impl_->startLoading(origin);
}

void Session::cancelLoading() {
    std::lock_guard lock(impl_->mutex);
    impl_->loadStop.request_stop();
    ++impl_->loadGeneration;
    impl_->loading = {};
}

LoadStatus Session::loadStatus() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->loading;
}

void Session::set(const std::string& id, const ParameterValue& value) { setAll({{id, value}}); }

void Session::setText(const std::string& id, const std::string& text) {
    ParameterValue value;
    {
        std::lock_guard lock(impl_->mutex);
        Document copy = impl_->requireDocument();
        if (id == "environment.file") value = text;
        else {
            copy.setText(id, text);
            value = copy.get(id);
        }
    }
    set(id, value);
}

void Session::setAll(const std::vector<std::pair<std::string, ParameterValue>>& values) {
    std::unique_lock lock(impl_->mutex);
    Document next = impl_->requireDocument();
    Redo worst = Redo::Display;
    bool timeEdited = false, skyEdited = false;
    std::string ids;
    std::optional<std::string> environmentFile;
    for (const auto& [id, value] : values) {
        ids += id + ' ';
        const std::string* file = std::get_if<std::string>(&value);
        if (id == "environment.file" && file && !file->empty()) environmentFile = *file;
        else worst = std::max(worst, next.set(id, value));
        timeEdited = timeEdited || id == "time";
        skyEdited = skyEdited || id == "environment.file";
    }
    impl_->timeEdited = impl_->timeEdited || timeEdited;
    const uint64_t environment = skyEdited ? ++impl_->environmentGeneration : 0;
    const bool reload = next.sceneChoice() != impl_->document->sceneChoice();
    Impl::Origin origin = impl_->origin;
    if (!reload) {
        impl_->history.begin(*impl_->document, ids);
        impl_->document = std::move(next);
        impl_->noteChange(worst);
    } else {
        origin.choice = next.sceneChoice();
    }
    lock.unlock();
    if (reload) impl_->startLoading(origin);
    if (environmentFile) impl_->loadEnvironment(*environmentFile, environment);
}

void Session::reset(const std::vector<std::string>& ids) {
    std::unique_lock lock(impl_->mutex);
    const Document& present = impl_->requireDocument();
    Document next = present;
    const Redo worst = next.reset(ids);
    std::string all;
    for (const std::string& id : ids) {
        all += id + ' ';
        if (id == "environment.file") ++impl_->environmentGeneration;  // a sky on its way would undo this
    }
    if (next.sceneChoice() != present.sceneChoice()) {
        Impl::Origin origin = impl_->origin;
        origin.choice = next.sceneChoice();
        lock.unlock();
        return impl_->startLoading(origin, ids);
    }
    impl_->timeEdited = impl_->timeEdited || next.time() != present.time();
    impl_->history.begin(present, all);
    impl_->document = std::move(next);
    impl_->noteChange(worst);
}

void Session::endEdit() {
    std::lock_guard lock(impl_->mutex);
    impl_->history.end();
}

Document Session::document() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->requireDocument();
}

uint64_t Session::revision() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->revision;
}

bool Session::undo() {
    std::lock_guard lock(impl_->mutex);
    if (!impl_->document) return false;
    std::optional<Document> before = impl_->history.undo(*impl_->document);
    if (before) impl_->replaceDocument(*before);
    return before.has_value();
}

bool Session::redo() {
    std::lock_guard lock(impl_->mutex);
    if (!impl_->document) return false;
    std::optional<Document> after = impl_->history.redo(*impl_->document);
    if (after) impl_->replaceDocument(*after);
    return after.has_value();
}

void Session::setRendering(bool on) {
    std::lock_guard lock(impl_->mutex);
    impl_->rendering = on;
    impl_->wake.notify_all();
}

bool Session::rendering() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->rendering;
}

void Session::setPlaying(bool on) {
    std::lock_guard lock(impl_->mutex);
    impl_->playing = on;
    impl_->wake.notify_all();
}

bool Session::playing() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->playing;
}

void Session::step() {
    std::lock_guard lock(impl_->mutex);
    impl_->rendering = false;
    impl_->stepWanted = true;
    impl_->wake.notify_all();
}

void Session::stepBack() {
    std::lock_guard lock(impl_->mutex);
    impl_->rendering = false;
    ++impl_->stepsBack;
    // Steps back that are under way are let finish: this one goes on from there.
    if (impl_->drawing && !impl_->steppingBack) impl_->frameStop.request_stop();
    impl_->wake.notify_all();
}

void Session::restart(FrameNumber first) {
    std::lock_guard lock(impl_->mutex);
    impl_->restartWanted = true;
    impl_->restartFrame = first;
    impl_->stepWanted = false;
    impl_->frameStop.request_stop();
    impl_->wake.notify_all();
}

bool Session::busy() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->working || impl_->hasWork() || impl_->waitsForStream();
}

uint64_t Session::abandonedFrames() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->abandoned;
}

std::shared_ptr<const Snapshot> Session::snapshot() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->snapshot;
}

std::optional<float> Session::steppingBack() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->replayed;
}

}  // namespace lumi

#include "ui/app_state.h"

#include <algorithm>

#include "base/error.h"

namespace lumi {

void AppState::beginFrame() {
    document.refresh(session);
    activePane = std::min(activePane, paneCount() - 1);
    const auto latest = session.snapshot();
    if (latest && (!snapshot || latest->serial != snapshot->serial)) snapshot = latest;
    metrics.offer(snapshot);
    followReference();
    convertReference();
    takeOrbitTarget();
    if (snapshot && pinned && (pinned->x >= snapshot->extent.width || pinned->y >= snapshot->extent.height))
        pinned.reset();
}

void AppState::makeReference(uint64_t samples) {
    metrics.makeReference(document.document(), samples);
    referenceOf_ = document.document().loadedScene();
    makesReference_ = true;
    // Two tracers at once would be slower than one after the other.
    resumeAfterReference = resumeAfterReference || session.rendering();
    session.setRendering(false);
}

/// A reference of the scene before serves nothing once another is open; what waited for one goes on.
void AppState::followReference() {
    const bool stale = document.present() && referenceOf_.lock() != document.document().loadedScene();
    if (makesReference_ && stale) metrics.cancelReference();
    if (metrics.reference().working) return;
    makesReference_ = false;
    if (resumeAfterReference) setRendering(true);
}

/// The reference goes through each view's display; where a view shows another buffer, its map and range are not the
/// image's.
void AppState::convertReference() {
    ReferencePictures::Source source;
    std::array<DisplaySettings, kViewCount> displays;
    if (showReference && document.present()) {
        const ReferenceStatus status = metrics.reference();
        source.image = status.image;
        if (status.asShown) source.bakedExposureEv = sceneExposureEv();
        for (int i = 0; i < kViewCount; ++i) {
            const ViewSettings& shown = document.document().view(i);
            DisplaySettings& display = displays[static_cast<size_t>(i)];
            if (shown.buffer == "image") display = shown.display;
            else display.exposureEv = shown.display.exposureEv, display.curve = shown.display.curve;
        }
    }
    referencePictures.show(source, displays);
}

/// Makes the surface that was asked for what the camera orbits around: a point straight ahead, as far away.
void AppState::takeOrbitTarget() {
    if (!orbitTarget.valid() || orbitTarget.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    std::optional<Vec3> point;
    try {
        point = orbitTarget.get();
    } catch (const std::future_error&) {  // it could not be looked for: that is a message
    }
    if (!point || !document.present()) return;
    Camera camera = document.camera();
    const Vec3 forward = glm::normalize(camera.target - camera.eye);
    camera.target = camera.eye + forward * std::max(glm::dot(*point - camera.eye, forward), 1e-3f);
    setCamera(camera);
    session.endEdit();
}

bool AppState::showsReference() const {
    return showReference && snapshot && referencePictures.picture(0) && metrics.fits(*snapshot);
}

std::shared_ptr<const PaneMeasurement> AppState::shownMap(int index) const {
    if (errorMap.empty() || !snapshot || snapshot->preview || showsReference()) return nullptr;
    const auto measured = metrics.latest();
    if (!measured || static_cast<size_t>(index) >= measured->panes.size()) return nullptr;
    const PaneMeasurement& pane = measured->panes[static_cast<size_t>(index)];
    if (!pane.map || pane.map->extent != snapshot->extent || pane.module != module(index)) return nullptr;
    return {measured, &pane};  // held with what it is a part of
}

std::shared_ptr<const Image8> AppState::picture(int index) const {
    if (showsReference()) return referencePictures.picture(index);
    if (const auto measured = shownMap(index)) return measured->map;
    const PaneSnapshot* shown = pane(index);
    return shown ? shown->pixels : nullptr;
}

void AppState::setLayout(Layout layout) {
    const ParameterInfo* info = document.find("view.layout");
    if (info) setOnce("view.layout", info->options[static_cast<size_t>(layout)]);
}

AppState::Bookmarks& AppState::bookmarks() {
    return bookmarksByScene[document.scene() ? document.scene()->path : std::string()];
}

std::string AppState::viewId(int pane, const char* name) const { return "view." + std::to_string(pane) + "." + name; }

const PaneSnapshot* AppState::pane(int index) const {
    if (!snapshot || static_cast<size_t>(index) >= snapshot->panes.size()) return nullptr;
    return &snapshot->panes[static_cast<size_t>(index)];
}

const Image* AppState::bufferImage(int index) const {
    const PaneSnapshot* shown = pane(index);
    if (!shown) return nullptr;
    const auto found = [](const auto& map, const std::string& key) -> const Image* {
        const auto entry = map.find(key);
        return entry == map.end() || !entry->second || entry->second->empty() ? nullptr : entry->second.get();
    };
    if (shown->buffer == "image") return found(snapshot->results, shown->module);
    const Signal signal = signalByName(shown->buffer);
    if (signal == Signal::Count) return found(snapshot->taps, shown->module + "-" + shown->buffer);
    if (signalInfo(signal).isId || !snapshot->signals || !snapshot->signals->available().has(signal)) return nullptr;
    const Image& image = (*snapshot->signals)[signal];
    return image.empty() ? nullptr : &image;
}

const std::vector<BufferEntry>& AppState::buffers(int pane) {
    const std::string name = module(pane);
    const std::shared_ptr<const PosedScene> scene = snapshot ? snapshot->scene : nullptr;
    if (scene != buffersOf_) buffers_.clear();
    buffersOf_ = scene;
    auto entry = buffers_.find(name);
    if (entry == buffers_.end()) entry = buffers_.emplace(name, session.buffers(name)).first;
    return entry->second;
}

void AppState::set(const std::string& id, const ParameterValue& value) {
    try {
        session.set(id, value);
    } catch (const Error& error) {
        log.error(error.what());
    }
}

void AppState::setOnce(const std::string& id, const ParameterValue& value) {
    set(id, value);
    session.endEdit();
}

void AppState::setCamera(const Camera& camera) {
    try {
        session.setAll({{"camera.eye", camera.eye}, {"camera.look-at", camera.target}});
    } catch (const Error& error) {
        log.error(error.what());
    }
}

void AppState::reset(const std::vector<std::string>& ids) {
    try {
        session.reset(ids);
    } catch (const Error& error) {
        log.error(error.what());
    }
    session.endEdit();
}

void AppState::setRendering(bool on) {
    resumeAfterReference = false;
    session.setRendering(on);
}

void AppState::open(const std::filesystem::path& path) {
    session.open(path);
    std::erase(recentScenes, path);
    recentScenes.insert(recentScenes.begin(), path);
    if (recentScenes.size() > 8) recentScenes.resize(8);
    browserOpen = false;
    pinned.reset();
    view.fit();
}

}  // namespace lumi

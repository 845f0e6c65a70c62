#include "ui/commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "reconstruct/catalog.h"
#include "ui/bookmark.h"
#include "ui/panels/panels.h"

namespace lumi {

namespace {

/// `<folder>/<scene>`: what the names of captures begin with.
std::filesystem::path captureStem(const AppState& state) {
    const Scene* scene = state.document.scene();
    const std::filesystem::path name = scene ? std::filesystem::path(scene->path).stem() : std::filesystem::path();
    return state.captures / (name.empty() ? "scene" : name);
}

void cycleModule(AppState& state, int by) {
    const auto catalog = moduleCatalog();
    const std::string now = state.module(state.activePane);
    const auto count = static_cast<int>(catalog.size());
    int index = 0;
    while (index < count && now != catalog[static_cast<size_t>(index)].id) ++index;
    const int next = index == count ? 0 : (index + by + count) % count;
    state.setOnce(state.viewId(state.activePane, "module"), std::string(catalog[static_cast<size_t>(next)].id));
}

void showBuffer(AppState& state, int index) {
    const auto& list = state.buffers(state.activePane);
    if (static_cast<size_t>(index) < list.size())
        state.setOnce(state.viewId(state.activePane, "buffer"), list[static_cast<size_t>(index)].name);
}

void changeExposure(AppState& state, float byEv) {
    std::vector<std::pair<std::string, ParameterValue>> values;
    for (int pane = 0; pane < kViewCount; ++pane) {
        const std::string id = state.viewId(pane, "exposure");
        const ParameterInfo* info = state.document.find(id);
        if (!info) continue;
        const auto low = static_cast<float>(info->min), high = static_cast<float>(info->max);
        values.emplace_back(id, std::clamp(state.document.number(id, 0) + byEv, low, high));
    }
    state.session.setAll(values);
    state.session.endEdit();
}

void swapPanes(AppState& state) {
    const auto first = state.document.group("view.0.");
    std::vector<std::pair<std::string, ParameterValue>> values;
    for (const ParameterInfo* info : first) {
        const std::string otherId = "view.1." + info->id.substr(7);
        const ParameterInfo* other = state.document.find(otherId);
        if (!other) continue;
        values.emplace_back(info->id, other->value);
        values.emplace_back(otherId, info->value);
    }
    state.session.setAll(values);
    state.session.endEdit();
}

void resetAll(AppState& state) {
    std::vector<std::string> ids;
    for (const std::string& id : state.document.changedIds())
        if (id != "time") ids.push_back(id);  // a moment that is looked at is no setting
    state.reset(ids);
}

void recallBookmark(AppState& state, int index) {
    const auto& bookmark = state.bookmarks()[static_cast<size_t>(index)];
    if (!bookmark) {
        state.log.info(fmt::format("Bookmark {} is empty; Ctrl+{} stores the camera there.", index + 1, index + 1));
        return;
    }
    state.session.setAll(valuesOf(*bookmark, state.document));
    state.session.endEdit();
}

void closeTopmost(AppState& state) {
    if (state.helpOpen) state.helpOpen = false;
    else if (state.browserOpen) state.browserOpen = false;
    else if (state.session.loadStatus().loading) state.session.cancelLoading();
    else if (state.uiHidden) state.uiHidden = false;
    else if (state.pinned) state.pinned.reset();
    else if (state.messagesOpen || state.signalsOpen) state.messagesOpen = state.signalsOpen = false;
    else state.quit = true;
}

void runPictureCommand(AppState& state, UiCommand command, int index) {
    switch (command) {
        case UiCommand::ShowBuffer: showBuffer(state, index); break;
        case UiCommand::PickBuffer: state.bufferPickerWanted = true; break;
        case UiCommand::NextModule: cycleModule(state, 1); break;
        case UiCommand::PreviousModule: cycleModule(state, -1); break;
        case UiCommand::CycleLayout:
            state.setLayout(static_cast<Layout>((static_cast<int>(state.layout()) + 1) % 3));
            break;
        case UiCommand::SwapPanes: swapPanes(state); break;
        case UiCommand::ExposureDown: changeExposure(state, -0.25f); break;
        case UiCommand::ExposureUp: changeExposure(state, 0.25f); break;
        case UiCommand::Fit: state.view.fit(); break;
        case UiCommand::ActualSize: state.view.setZoom(1); break;
        case UiCommand::Loupe: state.loupe = !state.loupe; break;
        default: break;
    }
}

void makeReference(AppState& state) {
    state.makeReference(referenceSamples(state));
    state.tab = PanelTab::Measure;
}

/// The map stands where the reference does, so it takes its place.
void toggleErrorMap(AppState& state, bool present) {
    const bool hidden = state.showReference && !state.errorMap.empty();
    state.showReference = false;
    if (!hidden) state.errorMap = state.errorMap.empty() && present ? "flip" : "";
}

void runMeasureCommand(AppState& state, UiCommand command) {
    const bool present = state.metrics.reference().present;
    switch (command) {
        case UiCommand::MakeReference: makeReference(state); break;
        case UiCommand::ShowReference: state.showReference = present && !state.showReference; break;
        case UiCommand::ToggleErrorMap: toggleErrorMap(state, present); break;
        default: return;
    }
    const bool wanted = state.showReference || !state.errorMap.empty();
    if (!present && command != UiCommand::MakeReference)
        state.log.info("There is no reference yet; " + shortcutText(UiCommand::MakeReference) + " makes one.");
    else if (present && wanted && state.snapshot && !state.metrics.fits(*state.snapshot))
        state.log.warning("The reference is of something else than what is shown now; " +
                          shortcutText(UiCommand::MakeReference) + " makes one of this.");
}

/// What was paused by hand or after a step goes on when its time is to play.
void playTime(AppState& state) {
    const bool plays = state.timePlays();
    state.session.setPlaying(!plays);
    if (!plays) state.setRendering(true);
}

void runTimeCommand(AppState& state, UiCommand command) {
    Session& session = state.session;
    switch (command) {
        case UiCommand::PlayTime: playTime(state); break;
        case UiCommand::PauseRendering: state.setRendering(!session.rendering()); break;
        case UiCommand::Step:
            state.setRendering(false);
            session.step();
            break;
        case UiCommand::StepBack:
            state.setRendering(false);
            session.stepBack();
            break;
        case UiCommand::Restart:
            if (state.document.number("time", 0) != 0) state.setOnce("time", 0.0f);
            session.restart();
            break;
        case UiCommand::ReloadScene: session.reload(); break;
        case UiCommand::Undo: session.undo(); break;
        case UiCommand::Redo: session.redo(); break;
        default: break;
    }
}

/// The view as it stands in the window; of a reference or an error map there is no state to keep with it.
void savePicture(AppState& state) {
    const int pane = state.activePane;
    const bool reference = state.showsReference();
    if (!reference && !state.shownMap(pane)) return state.session.captureView(pane, captureStem(state), "png");
    std::filesystem::path path = captureStem(state);
    path += fmt::format(".{}.{}.{:04}.png", state.module(pane), reference ? "reference" : "error-" + state.errorMap,
                        state.snapshot->frame);
    state.pictureWriter.write(*state.picture(pane), path);
}

void runWindowCommand(AppState& state, UiCommand command, int index) {
    switch (command) {
        case UiCommand::ToggleOrbit: state.leftDragOrbits = !state.leftDragOrbits; break;
        case UiCommand::StoreBookmark:
            state.bookmarks()[static_cast<size_t>(index)] = bookmarkOf(state.document);
            state.log.info(fmt::format("Camera stored as bookmark {}.", index + 1));
            break;
        case UiCommand::RecallBookmark: recallBookmark(state, index); break;
        case UiCommand::CopyCamera:
            state.clipboard = cameraAsCommandLine(state.document);
            state.log.info("Camera copied: " + state.clipboard);
            break;
        case UiCommand::OpenScene: state.browserOpen = !state.browserOpen; break;
        case UiCommand::SavePicture: savePicture(state); break;
        case UiCommand::SaveBuffers: state.session.captureView(state.activePane, captureStem(state), "exr"); break;
        case UiCommand::SaveWindow: state.windowShotWanted = true; break;
        case UiCommand::ResetAll: resetAll(state); break;
        case UiCommand::ToggleUi: state.uiHidden = !state.uiHidden; break;
        case UiCommand::TogglePanel: state.panelHidden = !state.panelHidden; break;
        case UiCommand::ToggleMessages:
            state.messagesOpen = !state.messagesOpen;
            state.signalsOpen = false;
            break;
        case UiCommand::ToggleSignals:
            state.signalsOpen = !state.signalsOpen;
            state.messagesOpen = false;
            if (state.signalsOpen && !state.session.signalCheck()) state.session.checkSignals();
            break;
        case UiCommand::CheckSignals: state.session.checkSignals(); break;
        case UiCommand::Help: state.helpOpen = !state.helpOpen; break;
        case UiCommand::Close: closeTopmost(state); break;
        case UiCommand::Quit: state.quit = true; break;
        default: break;
    }
}

bool worksWithoutScene(UiCommand command) {
    return command == UiCommand::OpenScene || command == UiCommand::Help || command == UiCommand::Close ||
           command == UiCommand::Quit || command == UiCommand::ToggleUi || command == UiCommand::ToggleMessages ||
           command == UiCommand::TogglePanel || command == UiCommand::SaveWindow || command == UiCommand::ReloadScene;
}

}  // namespace

void runCommand(AppState& state, UiCommand command, int index) {
    if (!state.document.present() && !worksWithoutScene(command)) return;
    try {
        runPictureCommand(state, command, index);
        runTimeCommand(state, command);
        runMeasureCommand(state, command);
        runWindowCommand(state, command, index);
    } catch (const std::exception& error) {
        state.log.error(error.what());
    }
}

std::filesystem::path windowShotPath(const AppState& state) {
    std::filesystem::path path = captureStem(state);
    return path += ".window.png";
}

}  // namespace lumi

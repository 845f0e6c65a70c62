#pragma once
#include <array>
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "session/live_metrics.h"
#include "session/reference_pictures.h"
#include "session/session.h"
#include "ui/bookmark.h"
#include "ui/document_mirror.h"
#include "ui/picture_writer.h"
#include "ui/timing.h"
#include "ui/view_transform.h"

namespace lumi {

enum class PanelTab { View, Render, Scene, Measure, Profile };

/// What the window shows beside the document: never part of an image, so neither undone nor saved with it.
struct AppState {
    AppState(Session& session_, MessageLog& log_) : session(session_), log(log_), metrics(log_), pictureWriter(log_) {}

    Session& session;
    MessageLog& log;
    DocumentMirror document;
    std::shared_ptr<const Snapshot> snapshot;  ///< of this frame; null before the first

    int activePane = 0;
    float wipe = 0.5f;  ///< of the pane's width
    ViewTransform view;
    bool loupe = false;
    bool leftDragOrbits = true;
    float flySpeed = 1;
    bool flying = false;                           ///< by keys, in the last frame
    std::future<std::optional<Vec3>> orbitTarget;  ///< asked for: what the camera is to orbit around
    std::optional<Pixel> hovered, pinned;
    Vec2 hoveredPaneSize{1};

    PanelTab tab = PanelTab::View;
    bool uiHidden = false, panelHidden = false, helpOpen = false, browserOpen = false, messagesOpen = false,
         signalsOpen = false, bufferPickerWanted = false, modulePickerWanted = false;
    std::string parameterSearch;
    bool checkScenes = true;  ///< the signals of each scene are checked when it opens

    LiveMetrics metrics;
    ReferencePictures referencePictures;
    int referenceTarget = 1;    ///< which of the numbers of samples that the panel offers
    std::string referenceFile;  ///< as typed
    bool allMetrics = false, showReference = false, resumeAfterReference = false;
    std::string errorMap;  ///< metric whose map stands in the pictures' place; empty: none

    using Bookmarks = std::array<std::optional<CameraBookmark>, 9>;
    std::map<std::string, Bookmarks> bookmarksByScene;  ///< by the scene's path
    std::vector<std::filesystem::path> recentScenes;
    std::filesystem::path captures;  ///< folder for screenshots; empty: the current one

    UiTiming timing;
    PictureWriter pictureWriter;
    std::string clipboard;  ///< text for the system's clipboard, taken by the window
    bool windowShotWanted = false, quit = false;

    /// Takes the session's present state. Once a frame, before anything is drawn.
    void beginFrame();

    Layout layout() const { return document.present() ? document.document().layout() : Layout::Single; }
    void setLayout(Layout layout);
    int paneCount() const { return layout() == Layout::Single ? 1 : 2; }
    Bookmarks& bookmarks();
    /// "view.0.exposure".
    std::string viewId(int pane, const char* name) const;
    std::string module(int pane) const { return document.text(viewId(pane, "module")); }
    std::string buffer(int pane) const { return document.text(viewId(pane, "buffer")); }
    const PaneSnapshot* pane(int index) const;
    /// The picture of a pane before display conversion; null if it is an id buffer or not there.
    const Image* bufferImage(int pane) const;
    const std::vector<BufferEntry>& buffers(int pane);
    /// What a pane shows: its picture, its error map or the reference; null before there is one.
    std::shared_ptr<const Image8> picture(int pane) const;
    /// The error map that a pane shows; null if it shows something else.
    std::shared_ptr<const PaneMeasurement> shownMap(int pane) const;
    bool showsReference() const;
    /// Does time go on: is it played, and not held by paused rendering?
    bool timePlays() const { return session.playing() && session.rendering(); }
    float sceneExposureEv() const {
        return document.present() ? document.document().loadedScene()->render.exposureEv : 0;
    }

    /// Changes the document; what the session refuses is a message. endEdit() closes the step of undo.
    void set(const std::string& id, const ParameterValue& value);
    void setOnce(const std::string& id, const ParameterValue& value);
    void setCamera(const Camera& camera);
    void reset(const std::vector<std::string>& ids);
    /// Pauses or goes on as the user says: what waits for a reference waits no more.
    void setRendering(bool on);
    void makeReference(uint64_t samples);
    void open(const std::filesystem::path& path);

private:
    void takeOrbitTarget();
    void followReference();
    void convertReference();
    std::weak_ptr<const Scene> referenceOf_;  ///< as loaded: what a reference is made of
    bool makesReference_ = false;
    std::map<std::string, std::vector<BufferEntry>> buffers_;
    std::shared_ptr<const PosedScene> buffersOf_;
};

}  // namespace lumi

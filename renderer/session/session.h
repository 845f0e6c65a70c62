#pragma once
#include <array>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/messages.h"
#include "frame/display.h"
#include "image/image.h"
#include "reconstruct/module.h"
#include "session/document.h"
#include "session/signals_check.h"
#include "trace/tracer.h"

namespace lumi {

/// One view, ready for the screen.
struct PaneSnapshot {
    std::string module, buffer;  ///< what it shows
    std::string label;           ///< "accumulate, 132 spp, equal samples"
    std::shared_ptr<const Image8> pixels;
    DisplayInfo info;
    int64_t droppedPixels = 0;  ///< that the module dropped from its input: NaN or infinite
};

/// What the engine publishes after each frame: immutable, shared with the UI.
struct Snapshot {
    FrameNumber frame = -1;
    uint64_t serial = 0;    ///< grows with each publication
    uint64_t revision = 0;  ///< of the document that the last whole frame shows: Session::revision() then
    bool preview = false;   ///< coarse, while changes keep coming: pictures alone, neither results nor signals
    Extent2 traced;         ///< pixels that were traced: `extent`, or fewer in a preview
    float time = 0;
    uint64_t accumulatedSamples = 0;  ///< per pixel, of the progressive mean; 0 if no module accumulates
    uint64_t targetSamples = 0;       ///< where the progressive mean stops and the engine rests; 0: never
    Extent2 extent;
    CameraPose camera;
    std::shared_ptr<const PosedScene> scene;
    std::shared_ptr<const Document> document;  ///< that it was drawn from
    std::shared_ptr<const Signals> signals;
    std::map<std::string, std::shared_ptr<const Image>> results;  ///< by instance name
    std::map<std::string, std::shared_ptr<const Image>> taps;     ///< "<instance>-<tap>"
    std::map<std::string, Lineage> lineages;                      ///< by instance name, of the pixel asked about
    std::vector<PaneSnapshot> panes;
    std::vector<std::pair<std::string, double>> stagesMs;
    double frameMs = 0;
    double framesPerSecond = 0;  ///< that were completed one after the other until this one; 0: it is the first
    TraceCounts rays;            ///< of this frame
    double raysPerSecond = 0;
};

/// A buffer a view can show, for the selector.
struct BufferEntry {
    std::string name;   ///< as ViewSettings::buffer
    std::string group;  ///< "Result", "Lighting", "Geometry", module title
    std::string channels, unit, help;
};

/// A value under the cursor, for the inspector: one row a buffer.
struct PixelValue {
    std::string buffer, channels;
    std::vector<float> values;
    bool isId = false;
    std::vector<uint32_t> ids;
};

struct LoadStatus {
    bool loading = false;
    float fraction = 0;
    std::string step, path;
};

/// What the signals' contract made of the present scene.
struct SignalCheck {
    std::vector<FrameCheck> frames;
    std::string failure;  ///< why it could not be checked; empty: it was
    int brokenRules() const;
    bool holds() const { return failure.empty() && brokenRules() == 0; }
};

/// The running engine: a render thread that owns the modules and draws frame after frame of one Document. All public
/// functions may be called from the UI thread and return at once; none waits for a frame.
class Session {
public:
    explicit Session(MessageLog& log);
    ~Session();

    /// Loads aside and swaps when done. A failure is an Error in the log, and the present scene stays.
    /// `set`: parameters (id, text) of the new document before its first frame; one that fails is an Error in the log.
    void open(const std::filesystem::path& scene, const SceneChoice& choice = {},
              std::vector<std::pair<std::string, std::string>> set = {});
    /// Is there a document to show and change; false before the first scene is loaded.
    bool hasScene() const;
    void reload();
    void cancelLoading();
    LoadStatus loadStatus() const;

    /// Values take effect before the next frame; a frame in flight that they invalidate is abandoned.
    /// Throws Error(Usage) for an unknown id or a value out of range.
    void set(const std::string& id, const ParameterValue& value);
    void setText(const std::string& id, const std::string& text);
    /// Several values that belong together (eye and look-at): no frame sees a part of them. One step of undo.
    void setAll(const std::vector<std::pair<std::string, ParameterValue>>& values);
    /// Back to what the scene has, one step of undo: see Document::reset().
    void reset(const std::vector<std::string>& ids);
    /// Changes of the same ids in a row (a slider dragged, a camera flown) are one step of undo until this is called.
    void endEdit();
    /// The document as last set (not as last drawn).
    Document document() const;
    /// Grows with each change of the document, new scenes included: what was read from document() is still true while
    /// this stands.
    uint64_t revision() const;
    bool undo();
    bool redo();

    // Time and frames.
    /// Is a frame, an earlier one, a file or a check being made, or due? While not, the snapshot is the last one until
    /// something is asked for.
    bool busy() const;
    void setRendering(bool on);  ///< pause or go on
    bool rendering() const;
    void setPlaying(bool on);  ///< does time advance by 1/fps a frame
    bool playing() const;
    void step();                          ///< one frame, then pause
    void stepBack();                      ///< draws the previous frame again, bit for bit, then pause
    void restart(FrameNumber first = 0);  ///< begins at that frame, history forgotten
    /// How far a step back that draws earlier frames again has come, 0 to 1; nothing while none is under way.
    std::optional<float> steppingBack() const;

    /// Frames that were begun and given up because something changed.
    uint64_t abandonedFrames() const;

    /// Latest published snapshot; never null after the first frame, null before.
    std::shared_ptr<const Snapshot> snapshot() const;

    std::vector<BufferEntry> buffers(const std::string& module) const;
    /// While on, every frame has all signals and taps, shown or not, for inspect(); the pictures stay the same.
    void setInspecting(bool on);
    /// While there is one, every frame tells which neighbours and which taps of the history made this pixel.
    void setInspectedPixel(std::optional<Pixel> pixel);
    /// All buffers present in the snapshot at a pixel.
    std::vector<PixelValue> inspect(const Snapshot& snapshot, Pixel pixel) const;
    /// World position of what is seen through the middle of a pixel of the last frame; nothing where that is the sky,
    /// or before there is a frame. The answer comes between frames; abandoned (std::future_error) when the session
    /// ends.
    std::future<std::optional<Vec3>> surfaceAt(Pixel pixel);

    /// Writes the view's picture (.png: as shown; .exr: linear with the buffers as layers, colours as half if asked
    /// for), state embedded. It is what is seen now; changes that come later wait for it. Runs in the background;
    /// success and failure arrive in the log.
    void saveView(int view, const std::filesystem::path& path, const std::string& buffers = "all", bool half = false);
    /// The same with all buffers as `<stem>.<instance>.<buffer>.<frame:04>.<extension>`, a name that is not taken;
    /// instance, buffer and frame are those of the picture that is written.
    void captureView(int view, const std::filesystem::path& stem, const std::string& extension);
    /// Checks the signals of each scene after its first frames.
    void setCheckingScenes(bool on);
    /// Checks the signals of the document as it is, when nothing else is to be done.
    void checkSignals();
    bool checkingSignals() const;
    /// Of the present scene as it is; null before it was checked, and after a change to what is traced.
    std::shared_ptr<const SignalCheck> signalCheck() const;

    /// The log from which `render --replay` makes the present frame again.
    std::string stateJson() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lumi

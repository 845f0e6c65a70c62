#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <list>
#include <mutex>
#include <optional>
#include <thread>

#include "base/timer.h"
#include "scene/load.h"
#include "session/edit_history.h"
#include "session/export.h"
#include "session/frame_engine.h"
#include "session/session.h"
#include "session/state_log.h"

namespace lumi {

/// The engine's two sides: public functions and loaders change what `mutex` guards and wake the render thread; the
/// render thread takes what is to be done next under the lock, does it without, and publishes.
struct Session::Impl {
    explicit Impl(MessageLog& log_);
    ~Impl();

    struct Save {
        std::filesystem::path path;  ///< of a capture: what its name begins with
        OutputChoice choice;
        std::string capture{};  ///< extension of a capture; empty: it is none
    };
    /// What surface is seen in a pixel.
    struct Question {
        Pixel pixel;
        std::promise<std::optional<Vec3>> answer;
    };
    /// What the render thread does next.
    struct Work {
        enum Kind { Frame, Redraw, Display, Preview, StepBack, SaveView, Pick, Check } kind = Frame;
        std::shared_ptr<const Document> document;
        bool cut = false;
        FrameNumber firstFrame = 0;  ///< after a cut
        Extent2 coarse;              ///< of a preview
        std::optional<Redo> redo;    ///< what the changes that it takes up invalidate
        int stepsBack = 0;
        bool inspecting = false;  ///< every buffer is wanted
        std::optional<Pixel> inspectedPixel;
        uint64_t revision = 0;     ///< of the document
        uint64_t sceneNumber = 0;  ///< of the scene that this work is about
        StateLog states;           ///< as it was then, for StepBack and SaveView
        Save save;
        std::shared_ptr<Question> question;
        std::stop_token stop, sceneStop;
    };
    /// Where the present scene came from, to load it again.
    struct Origin {
        std::filesystem::path path;
        SceneChoice choice;
        std::vector<std::pair<std::string, std::string>> set;
    };

    // session.cpp: callers hold the lock.
    Document& requireDocument();
    void noteChange(Redo redo);
    void lookCloser();
    void replaceDocument(const Document& next);
    void abandonFrame();
    void watch(std::stop_token quit);
    bool changesStream() const { return sinceChange.elapsedMs() < kStreamMs; }
    std::optional<Extent2> previewExtent() const;
    bool waitsForStream() const;

    // session_load.cpp
    void startLoading(const Origin& origin, const std::vector<std::string>& reset = {});
    void load(const Origin& origin, const std::vector<std::string>& reset, uint64_t generation, std::stop_token stop);
    void loadEnvironment(const std::string& file, uint64_t generation);
    void reapThreads(bool all);
    void runAside(std::function<void(std::stop_token)> body);

    // session_loop.cpp: the render thread.
    void loop(std::stop_token quit);
    bool hasWork() const;
    Work takeWork();
    bool takeAside(Work& work);
    bool takeSave(Work& work);
    bool mayBeSaved(const Save& save) const;
    void advanceTime(const Work& work);
    void perform(const Work& work);
    void drawFrame(const Work& work);
    void drawPreview(const Work& work);
    void checkSignals(const Work& work);
    void learnCost(double ms, double pixelSamples);
    void stepBack(const Work& work);
    void giveUp(const Work& work);
    void saveView(const Work& work);
    void answer(const Work& work);
    FrameRequest requestOf(const Work& work, const Document& drawn, FrameNumber number, bool cut) const;
    void finishSaves();
    void complete(FrameOutput frame, const Work& work);
    void adoptSteppedBack(const Work& work);

    // session_publish.cpp
    void publish();
    void publishPreview(const FrameOutput& coarse, const Work& work);
    double measuredRate();

    MessageLog& log;
    mutable std::mutex mutex;
    std::condition_variable_any wake;

    // Guarded by the mutex.
    std::optional<Document> document;
    uint64_t revision = 0;
    EditHistory history;
    std::optional<Redo> pending;  ///< the worst of the changes that no frame has seen
    bool rendering = true, playing = false, timeEdited = false;
    bool inspecting = false;  ///< frames have every buffer
    std::optional<Pixel> inspectedPixel;
    bool stepWanted = false, restartWanted = false;
    FrameNumber restartFrame = 0;
    int stepsBack = 0;
    std::optional<float> replayed;  ///< how far a step back has come
    bool checkingScenes = false, checkWanted = false, checking = false;
    std::shared_ptr<const SignalCheck> signalCheck;
    std::deque<Save> saves;
    std::deque<std::shared_ptr<Question>> questions;
    bool resting = false;      ///< the shown frame has converged
    bool frameFailed = false;  ///< drawing failed: wait for a change
    std::stop_source frameStop;
    std::stop_source sceneStop;  ///< of building the scene, which changes let go on: another scene took its place
    bool working = false;        ///< something was taken up and is not done
    bool drawing = false;        ///< it is a frame that changes may abandon
    bool steppingBack = false;   ///< it is one of those that a step back runs
    bool heldBack = false;       ///< a change came in a stream of changes: see kStreamMs
    bool guarded = false;        ///< the frame before was abandoned
    Timer sinceFrameBegan, sinceChange;
    double msPerSample = 0;          ///< of one sample of one pixel, as last measured; 0: not yet
    uint64_t previewedRevision = 0;  ///< of the document that the last preview showed
    std::optional<Clock> clock;      ///< by which time goes on while it plays
    uint64_t abandoned = 0;
    std::shared_ptr<const Snapshot> snapshot;
    LoadStatus loading;
    uint64_t loadGeneration = 0;
    uint64_t environmentGeneration = 0;  ///< of the sky asked for last
    uint64_t sceneNumber = 0;            ///< grows when a loaded scene takes the present one's place
    std::stop_source loadStop;
    Origin origin;
    StateLog states;
    std::shared_ptr<const Document> takenDocument;  ///< what the last frame was begun with, at takenRevision
    uint64_t takenRevision = 0;

    // Of the render thread alone.
    FrameEngine engine;
    FrameOutput shown;
    std::shared_ptr<const Document> shownDocument;
    uint64_t serial = 0;
    uint64_t shownRevision = 0;
    Timer sinceStart;
    std::deque<double> completedMs;  ///< when the last frames were complete, one after the other
    double shownRate = 0;            ///< frames a second, when the shown one was complete

    // Loaders and writers; each says when it is done.
    struct Aside {
        std::atomic<bool> done{false};
        std::jthread thread;
    };
    std::mutex asideMutex;
    std::list<Aside> asides;
    std::jthread thread, watcher;

    /// While changes keep coming (a camera is flown), less than kStreamMs apart, a frame that follows an abandoned one
    /// may finish if it takes less than kShortMs, else nothing would ever be seen. Any other frame is given up at once,
    /// and such a one as soon as the changes pause.
    static constexpr double kStreamMs = 120, kShortMs = 1000;
    /// Frames that take longer than kSmoothMs have a coarse preview of about kPreviewMs in their place while changes
    /// keep coming; a side of it is at least 1/kCoarsest of theirs.
    static constexpr double kSmoothMs = 150, kPreviewMs = 70;
    static constexpr double kCoarsest = 8;
    /// A check of the signals waits until nothing changed for so long.
    static constexpr double kQuietMs = 600;
};

}  // namespace lumi

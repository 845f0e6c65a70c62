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
        int view = 0;
        std::filesystem::path path;
    };
    /// What the render thread does next.
    struct Work {
        enum Kind { Frame, Redraw, Display, StepBack, SaveView } kind = Frame;
        std::shared_ptr<const Document> document;
        bool cut = false;
        std::optional<Redo> redo;  ///< what the changes that it takes up invalidate
        int stepsBack = 0;
        bool inspecting = false;  ///< every buffer is wanted
        uint64_t revision = 0;    ///< of the document
        uint64_t sceneNumber = 0; ///< of the scene that this work is about
        StateLog states;          ///< as it was then, for StepBack and SaveView
        Save save;
        std::stop_token stop;
    };
    /// Where the present scene came from, to load it again.
    struct Origin {
        std::filesystem::path path;
        int index = -1;
        std::string variant;
        std::vector<std::pair<std::string, std::string>> set;
    };

    // session.cpp: callers hold the lock.
    Document& requireDocument();
    void noteChange(Redo redo);
    void replaceDocument(const Document& next);
    void abandonFrame();
    void watch(std::stop_token quit);

    // session_load.cpp
    void startLoading(const Origin& origin);
    void load(const Origin& origin, uint64_t generation, std::stop_token stop);
    void loadEnvironment(const std::string& file, uint64_t generation);
    void reapThreads(bool all);
    void runAside(std::function<void(std::stop_token)> body);

    // session_loop.cpp: the render thread.
    void loop(std::stop_token quit);
    bool hasWork() const;
    Work takeWork();
    void perform(const Work& work);
    void drawFrame(const Work& work);
    void stepBack(const Work& work);
    void giveUp(const Work& work);
    void saveView(const Work& work);
    void finishSaves();
    void complete(FrameOutput frame, const Work& work);
    void publish();

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
    bool stepWanted = false, restartWanted = false;
    int stepsBack = 0;
    std::deque<Save> saves;
    bool resting = false;    ///< the shown frame has converged
    bool frameFailed = false;  ///< drawing failed: wait for a change
    std::stop_source frameStop;
    bool drawing = false;  ///< a frame that changes may abandon
    bool steppingBack = false;  ///< it is one of those that a step back runs
    bool heldBack = false;  ///< a change came in a stream of changes: see kStreamMs
    bool guarded = false;  ///< the frame before was abandoned
    Timer sinceFrameBegan, sinceChange;
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
};

}  // namespace lumi

#pragma once
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "session/clock.h"
#include "session/document.h"
#include "session/frame_engine.h"

namespace lumi {

/// Which scene a state speaks of. The digest tells whether it is still the same.
struct SceneReference {
    std::string name;    ///< as the user gave it: a built-in name or a path
    std::string digest;  ///< Scene::contentDigest
};

/// What was done, frame by frame: enough to draw any of the frames again, bit for bit. The state that goes into files
/// begins where the frame's history began. It holds no thread count, time of day, host or output path, so the same
/// work gives the same text anywhere. Frames that differ from the one before in nothing, or in a time that a clock
/// tells, are kept and told as one run: neither memory nor text grows with them.
class StateLog {
public:
    struct Entry {
        FrameNumber frame = -1;
        std::shared_ptr<const Document> document;
        bool cut = false, historyDropped = false;
    };

    StateLog() = default;
    explicit StateLog(SceneReference scene) : scene_(std::move(scene)) {}

    /// Adds a completed frame drawn from `document`; a frame of the last one's number takes its place.
    void record(const FrameOutput& frame, std::shared_ptr<const Document> document);
    /// The last frame is shown otherwise: `document` differs from its own in that alone.
    void redescribeLast(std::shared_ptr<const Document> document);
    bool empty() const { return runs_.empty(); }
    size_t size() const;
    Entry entry(size_t index) const;
    /// From which entry on frames have to run to draw entry `index` again.
    size_t startOf(size_t index) const;
    /// Keeps the first `count` entries, or all if there are fewer.
    void truncate(size_t count);
    /// Pieces that are kept, each one or many frames.
    size_t runCount() const { return runs_.size(); }

    /// The state of the last entry; `output` says what was written.
    std::string json(const nlohmann::json& output = nlohmann::json::object()) const;

private:
    /// Consecutive frames: the first as told by `document`, the others equal to it or, with clocks, but for the time.
    struct Run {
        Entry head;           ///< the first frame
        uint64_t number = 0;  ///< of its entry, counted from the first entry ever
        uint64_t count = 1;
        uint64_t start = 0;                         ///< startOf(), counted likewise, of the first
        bool restDropped = false;                   ///< historyDropped of the others
        bool moves = false;                         ///< the others' time is what the clocks tell; else all are equal
        std::vector<Clock> clocks;                  ///< all that agree with every frame of the run
        std::shared_ptr<const nlohmann::json> set;  ///< what turns the entry before into the first; null: nothing

        FrameNumber lastFrame() const { return head.frame + static_cast<FrameNumber>(count) - 1; }
    };

    const Run& runOf(size_t index) const;
    Entry last() const { return entry(size() - 1); }
    void add(Entry entry);
    bool extend(Run& run, const Entry& before, const Entry& entry, const nlohmann::json& set);
    void dropLast();
    void forgetOldest();
    nlohmann::json framesFrom(uint64_t first) const;

    SceneReference scene_;
    std::deque<Run> runs_;
    uint64_t forgotten_ = 0;  ///< entries that were there before the present first
};

}  // namespace lumi

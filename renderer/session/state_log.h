#pragma once
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "session/document.h"
#include "session/frame_engine.h"

namespace lumi {

/// Which scene a state speaks of. The digest tells whether it is still the same.
struct SceneReference {
    std::string name;    ///< as the user gave it: a built-in name or a path
    std::string digest;  ///< Scene::contentDigest
};

/// Frames to run, one after the other: document values to apply before each.
struct Replay {
    SceneReference scene;
    std::string isa;
    FrameNumber first = 0, last = 0;
    nlohmann::json start;                                      ///< values before frame `first`, which is a cut
    std::vector<std::pair<FrameNumber, nlohmann::json>> sets;  ///< ascending, after `first`
    nlohmann::json output;                                     ///< what was written: see OutputChoice

    /// Values for frame `frame`; null if there are none.
    const nlohmann::json* valuesOf(FrameNumber frame) const;
};

/// The state inside a .exr, .png or .json that lumiscope wrote, all of which is read: a damaged file throws
/// Error(BadInput), as does one without a state.
std::string stateTextOf(const std::filesystem::path& file);

/// Reads what StateLog::json() wrote. Throws Error(BadInput) headed by `where`.
Replay parseReplay(const std::string& text, const std::string& where);
/// From the state embedded in a .exr or .png, or a .json that holds the state alone.
Replay readReplay(const std::filesystem::path& file);

/// What was done, frame by frame: enough to draw any of the frames again, bit for bit. The state that goes into files
/// begins where the frame's history began. It holds no thread count, time of day, host or output path, so the same
/// work gives the same text anywhere.
class StateLog {
public:
    struct Entry {
        FrameNumber frame = -1;
        std::shared_ptr<const Document> document;
        bool cut = false, historyDropped = false;
        std::shared_ptr<const nlohmann::json> set;  ///< what turns the entry before into this one; null: nothing
        uint64_t start = 0;                         ///< startOf(), counted from the first entry ever
    };

    StateLog() = default;
    explicit StateLog(SceneReference scene) : scene_(std::move(scene)) {}

    /// Adds a completed frame drawn from `document`; a frame of the last one's number takes its place.
    void record(const FrameOutput& frame, std::shared_ptr<const Document> document);
    /// The last frame is shown otherwise: `document` differs from its own in that alone.
    void redescribeLast(std::shared_ptr<const Document> document);
    bool empty() const { return entries_.empty(); }
    size_t size() const { return entries_.size(); }
    const Entry& entry(size_t index) const { return entries_[index]; }
    /// From which entry on frames have to run to draw entry `index` again.
    size_t startOf(size_t index) const;
    /// Keeps the first `count` entries, or all if there are fewer.
    void truncate(size_t count) {
        if (count < entries_.size()) entries_.resize(count);
    }

    /// The state of the last entry; `output` says what was written.
    std::string json(const nlohmann::json& output = nlohmann::json::object()) const;

private:
    void describeLast();
    void forgetOldest();

    SceneReference scene_;
    std::deque<Entry> entries_;
    uint64_t forgotten_ = 0;  ///< entries that were there before the present first
};

}  // namespace lumi

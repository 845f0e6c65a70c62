#pragma once
#include <filesystem>
#include <optional>

#include "scene/scene_choice.h"
#include "session/state_log.h"

namespace lumi {

/// Frames to run, one after the other: document values to apply before each.
struct Replay {
    /// Frames whose time a clock tells.
    struct Ticks {
        FrameNumber first = 0, last = 0;
        Clock clock;
    };
    SceneReference scene;
    std::string isa;
    FrameNumber first = 0, last = 0;
    SceneChoice choice;                                        ///< among `start`
    nlohmann::json start;                                      ///< values before frame `first`, which is a cut
    std::vector<std::pair<FrameNumber, nlohmann::json>> sets;  ///< ascending, after `first`
    std::vector<Ticks> ticks;                                  ///< ascending, after `first`
    nlohmann::json output;                                     ///< what was written: see OutputChoice

    /// Values for frame `frame`, if there are any.
    std::optional<nlohmann::json> valuesOf(FrameNumber frame) const;
};

/// The state inside a .exr, .png or .json that lumiscope wrote, all of which is read: a damaged file throws
/// Error(BadInput), as does one without a state.
std::string stateTextOf(const std::filesystem::path& file);

/// Stops at which the picture of a state was shown, the scene's own unless somebody changed them: what metrics on
/// tone-mapped images take. Nothing if the text is no state or tells none.
std::optional<float> exposureOfState(const std::string& text);

/// Reads what StateLog::json() wrote. Throws Error(BadInput) headed by `where`.
Replay parseReplay(const std::string& text, const std::string& where);
/// From the state embedded in a .exr or .png, or a .json that holds the state alone.
Replay readReplay(const std::filesystem::path& file);

}  // namespace lumi

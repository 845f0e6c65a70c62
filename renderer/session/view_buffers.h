#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "session/document.h"
#include "session/frame_engine.h"

namespace lumi {

/// Signals and taps that the drawn views show.
SignalSet shownSignals(const Document& document);
std::map<std::string, TapSet> shownTaps(const Document& document);

/// A buffer of a frame, by the name that views use. One of the two images is there, or neither if the frame lacks it.
struct BufferView {
    const Image* image = nullptr;
    const IdImage* ids = nullptr;
    std::string channels;
    std::string colourMap;            ///< what "auto" means for it
    std::optional<ValueRange> range;  ///< Tap::range
};
BufferView findBuffer(const FrameOutput& frame, const std::string& instance, const std::string& buffer);

/// The view as pixels. A buffer that the frame lacks gives the module's result.
std::shared_ptr<const Image8> drawView(const FrameOutput& frame, const ViewSettings& view, DisplayInfo& info);

/// The colour map that shows a signal best; "none" for colours and directions.
const char* defaultColourMap(Signal signal);

}  // namespace lumi

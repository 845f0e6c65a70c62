#pragma once
#include <stop_token>
#include <string>
#include <vector>

#include "session/document.h"
#include "trace/contract_check.h"

namespace lumi {

/// What the signals' contract made of one frame.
struct FrameCheck {
    int frame = 0;
    std::string what;  ///< how it was made
    std::vector<ContractFinding> findings;
    bool holds() const;
};

/// Traces two small frames of the document, the second with the camera moved on a small orbit around what it looks at,
/// unless it moves by itself while its shutter is open, and, where something is animated, one frame later; verifies
/// both. `tracer` is bound to other moments afterwards. Throws Error(Interrupted) when stopped; building the scene ends
/// with `sceneStop` alone.
std::vector<FrameCheck> checkFrames(Document document, Tracer& tracer, std::stop_token stop, std::stop_token sceneStop);

}  // namespace lumi

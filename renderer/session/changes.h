#pragma once
#include <memory>

#include "reconstruct/module.h"
#include "session/document.h"

namespace lumi {

/// What decides whether a frame continues the one before.
struct FrameState {
    const Document& document;
    const CameraPose& camera;
    Jitter jitter = Jitter::Auto;  ///< in effect
};

/// Is there no way from `before` to `now`: another scene or image size, time that goes back or forward by more than
/// one and a half frames, another camera, or a camera that jumped (over a quarter of the scene's size, or turned by
/// more than a right angle)?
bool isCut(const FrameState& before, const FrameState& now);

/// The worst that the differences between two documents of one scene invalidate.
Redo worstDifference(const Document& before, const Document& now);

/// What differs, a cut excluded. `posed` is the scene of `now`, whose previous moment is that of `before`.
Changes differences(const FrameState& before, const FrameState& now, const PosedScene& posed);

}  // namespace lumi

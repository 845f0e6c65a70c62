#pragma once
#include "reconstruct/module.h"

namespace lumi {

/// When frames are while time goes on by 1/fps with each: a closed form of the frame's number, so that no rounding adds
/// up and a run of frames is told by its ends.
struct Clock {
    FrameNumber frame = 0;  ///< some frame,
    float time = 0;         ///< its time in seconds,
    float fps = 60;         ///< and the frames a second from there on

    float at(FrameNumber number) const {
        return static_cast<float>(static_cast<double>(time) +
                                  static_cast<double>(number - frame) / static_cast<double>(fps));
    }
    bool operator==(const Clock&) const = default;
};

}  // namespace lumi

#pragma once
#include "session/frame_engine.h"

namespace lumi {

/// The rays that made a frame's results and the time that tracing them took. `ms` of modules that trace their own rays
/// is that of their run() as a whole.
struct RayRate {
    uint64_t rays = 0;
    double ms = 0;
    double perSecond() const { return ms > 0 ? static_cast<double>(rays) / ms * 1000 : 0; }
};

/// The frame's own rays where a module reads its signals, and those of each module that reads none; neither the few
/// that a filter traces beside the frame's, nor those of signals that are only shown or stored beside such modules. A
/// preview's are all its rays.
RayRate rayRate(const FrameOutput& frame);

}  // namespace lumi

#pragma once
#include <string>
#include <vector>

#include "trace/tracer.h"

namespace lumi {

/// One rule of the signals' contract (frame/signals.h) and what a frame made of it.
struct ContractFinding {
    std::string rule;        ///< "normals are unit vectors"
    int64_t violations = 0;  ///< pixels
    int64_t checked = 0;     ///< pixels the rule applies to
    Pixel worst;             ///< where it is broken most
    double value = 0;        ///< what was found there
    double limit = 0;        ///< what is allowed
    std::string unit;
    bool holds() const { return violations == 0; }
    /// "normals are unit vectors: nothing to check" or ": holds in 57600 pixels" or ": broken in 12 of 57600 pixels; at
    /// (31, 7) 1.02, allowed 0.001"
    std::string text() const;
};

/// What checkSignals() needs; ask the tracer for all of it.
SignalSet contractSignals();

/// Verifies what every filter assumes of its input: finite values, unit normals, albedo in [0,1], the lighting identity
/// and its sums, a variance that samples can have, depth, its gradient and position that agree with the camera, motion
/// vectors that lead to where and how deep the surface or the sky was, the jitter that `sampling.jitter` says (through
/// a pinhole: a lens leaves nothing to check), ids that exist, an empty sky. `signals` was made by
/// tracer.sample(sampling); the tracer is still bound to the same pose, and `before` to the previous frame's, posed by
/// itself: where it has a surface, the surface was. Where nothing moves it may be `tracer`.
std::vector<ContractFinding> checkSignals(const Signals& signals, const FrameSampling& sampling, const Tracer& tracer,
                                          const Tracer& before);

}  // namespace lumi

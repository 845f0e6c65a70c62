#pragma once
#include <stop_token>

#include "frame/signals.h"

namespace lumi {

/// Edge-avoiding à-trous wavelets with fixed edge-stopping functions [Dammertz10, sec. 3]: one level of the 5x5 B3
/// spline with weights
///
///     w = exp(-|c_p - c_q|^2 / (sigma_rt 2^-i)^2) exp(-|n_p - n_q|^2 / (4^i sigma_n^2)) exp(-|x_p - x_q|^2 /
///     sigma_x^2)
///
/// at level i (from 0): colour is trusted more with each level, normals less.
///
/// Differs from the paper: all norms are squared and sigmas enter as squares, as in its own shader; positions are
/// divided by the pixel's depth, so that sigma_x is an angle and no scene's unit matters.
struct EdgeAvoidingSettings {
    float sigmaColour = 1;
    float sigmaNormal = 0.35f;
    float sigmaPosition = 0.1f;  ///< of the depth
};

/// `in` and `out` are RGB and must not overlap; `level` from 0. Reads Normal, Position and InverseDepth. The sky keeps
/// its value. Returns false if stopped.
bool edgeAvoidingLevel(const Signals& signals, const EdgeAvoidingSettings& settings, int level, const Image& in,
                       Image& out, std::stop_token stop);

}  // namespace lumi

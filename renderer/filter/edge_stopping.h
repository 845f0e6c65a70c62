#pragma once

namespace lumi {

/// The edge-stopping functions of SVGF [Schied17, sec. 4.4] and their strengths.
///
///     w_z = exp(-|z(p) - z(q)| / (sigma_z |grad z(p) . (p - q)| + epsilon))      (3)
///     w_n = max(0, n(p) . n(q))^sigma_n                                          (4)
///     w_l = exp(-|l(p) - l(q)| / (sigma_l sqrt(g3x3(Var(l(p))) + epsilon)))      (5)
///
/// z is 1/depth, which is affine on a plane in screen space as clip-space depth is. The epsilon of eq. 3 is a
/// thousandth of z(p); that of eq. 5 stands inside the root, as printed, and is 1e-10.
struct EdgeStopping {
    float sigmaDepth = 1;
    float sigmaNormal = 128;
    float sigmaLuminance = 4;
    /// Measures |z(p) - z(q) - grad z(p).(p - q)|, the distance from p's plane, in place of eq. 3's numerator, which
    /// gives every neighbour on a perfect plane exp(-1/sigma_z).
    bool planeDistance = false;
};

constexpr float kDepthEpsilon = 1e-3f;      ///< eq. 3, relative to z(p)
constexpr float kVarianceEpsilon = 1e-10f;  ///< eq. 5

}  // namespace lumi

#pragma once

/// Numbers of the tone curves, shared by the scalar definition and the kernels. Matrices are row by row.
namespace lumi {

/// ACES by S. Hill's fit of the reference and output transforms (RRT and ODT of ACES 1.x for a 48-nit sRGB display):
/// a matrix into a rendering space, the rational curve (x (x + a) - b) / (x (c x + d) + e), a matrix back.
/// The exposure factor is the customary one that keeps middle grey about where it was.
inline constexpr float kAcesExposure = 1 / 0.6f;
inline constexpr float kAcesIn[9] = {0.59719f, 0.35458f, 0.04823f, 0.07600f, 0.90834f,
                                     0.01566f, 0.02840f, 0.13383f, 0.83777f};
inline constexpr float kAcesOut[9] = {1.60475f,  -0.53108f, -0.07367f, -0.10208f, 1.10813f,
                                      -0.00605f, -0.00327f, -0.07276f, 1.07602f};
inline constexpr float kAcesCurve[5] = {0.0245786f, 0.000090537f, 0.983729f, 0.4329510f, 0.238081f};

/// AgX of T. Sobotka, base look, in B. Wrensch's approximation: inset matrix, 16.5 stops of log2 around 0.18, a
/// sixth-order polynomial for the sigmoid (highest power first), outset matrix, and a display gamma of 2.2.
inline constexpr float kAgxInset[9] = {0.842479062253094f,  0.0784335999999992f, 0.0792237451477643f,
                                       0.0423282422610123f, 0.878468636469772f,  0.0791661274605434f,
                                       0.0423756549057051f, 0.0784336f,          0.879142973793104f};
inline constexpr float kAgxOutset[9] = {1.19687900512017f,    -0.0980208811401368f, -0.0990297440797205f,
                                        -0.0528968517574562f, 1.15190312990417f,    -0.0989611768448433f,
                                        -0.0529716355144438f, -0.0980434501171241f, 1.15107367264116f};
inline constexpr float kAgxMinEv = -12.47393f, kAgxMaxEv = 4.026069f;
inline constexpr float kAgxCurve[7] = {15.5f, -40.14f, 31.96f, -6.868f, 0.4298f, 0.1191f, -0.00232f};
inline constexpr float kAgxGamma = 2.2f;

/// Brighter values are shown as this one; keeps the curves' squares finite.
inline constexpr float kBrightest = 1e8f;

}  // namespace lumi

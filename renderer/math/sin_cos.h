#pragma once

namespace lumi {

struct SinCos {
    float sine = 0, cosine = 1;
};

/// Sine and cosine of 2 pi `turns`, for |turns| below 2^20; off by less than 2e-7. Own polynomials: the same bits on
/// every machine, and no call (kernels of each instruction set have their own). By Taylor up to an eighth of a turn;
/// the rest is symmetry.
[[gnu::always_inline]] inline SinCos sinCosTurns(float turns) {
    const int quarter = static_cast<int>(turns * 4 + (turns >= 0 ? 0.5f : -0.5f));
    const float x = (turns - 0.25f * static_cast<float>(quarter)) * 6.28318530717958647692f, x2 = x * x;
    const float sine = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
    const float cosine = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
    const bool swapped = (quarter & 1) != 0;
    const float s = swapped ? cosine : sine, c = swapped ? sine : cosine;
    return {(quarter & 2) != 0 ? -s : s, ((quarter + 1) & 2) != 0 ? -c : c};
}

}  // namespace lumi

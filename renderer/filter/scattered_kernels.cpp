#include "filter/scattered_kernels.h"

#include <cmath>
#include <cstddef>

#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr float kLargest = 3.402823466e38f;
constexpr float kLeast = 1e-30f;  ///< sums of weights below it have lost bits of their colours

inline float luminanceOf(float r, float g, float b) { return 0.2126f * r + 0.7152f * g + 0.0722f * b; }

/// Weights of a sample along one axis for the pixels before, at and behind its own; `f` in [0, 1) is its place there.
inline void axisWeights(const ScatteredRows& rows, float f, float out[3]) {
    const float d = f - 0.5f;
    for (int i = 0; i < 3; ++i) {
        const float distance = d - static_cast<float>(i - 1);
        out[i] = kernelExp(-rows.falloff * distance * distance);
    }
    if (rows.box) out[0] = out[2] = 0, out[1] = 1;
}

/// A sample's colour times its weight, and the weight; false if it plays no part. To filter c / (1 + y) and to expand
/// the mean m by 1 / (1 - luminance(m)) is to filter c with weights w / (1 + y), which cancels nothing at any radiance.
inline bool colourOf(const ScatteredRows& rows, uint32_t i, float out[4]) {
    const float* c = rows.colours + 3 * static_cast<std::ptrdiff_t>(i);
    const float r = c[0], g = c[1], b = c[2];
    if (!(std::fabs(r) <= kLargest) || !(std::fabs(g) <= kLargest) || !(std::fabs(b) <= kLargest)) return false;
    const float y = luminanceOf(r, g, b);
    const float scale = rows.toneMapped ? 1.0f / (1.0f + (y > 0.0f ? y : 0.0f)) : 1.0f;
    out[0] = r * scale, out[1] = g * scale, out[2] = b * scale, out[3] = scale;
    return true;
}

void splat(const ScatteredRows& rows) {
    const std::ptrdiff_t stride = 4 * (static_cast<std::ptrdiff_t>(rows.width) + 2);
    const int begin = rows.top > 0 ? rows.top - 1 : 0, end = rows.bottom < rows.height ? rows.bottom + 1 : rows.height;
    for (int y = begin; y < end; ++y) {
        const uint32_t* first = rows.first + static_cast<std::ptrdiff_t>(y) * rows.width;
        for (int x = 0; x < rows.width; ++x)
            for (uint32_t i = first[x]; i < first[x + 1]; ++i) {
                float colour[4], wx[3], wy[3];
                if ((rows.hidden && rows.hidden[i]) || !colourOf(rows, i, colour)) continue;
                axisWeights(rows, rows.places[2 * static_cast<std::ptrdiff_t>(i)] - static_cast<float>(x), wx);
                axisWeights(rows, rows.places[2 * static_cast<std::ptrdiff_t>(i) + 1] - static_cast<float>(y), wy);
                for (int dy = -1; dy <= 1; ++dy) {
                    const int row = y + dy;
                    if (row < rows.top || row >= rows.bottom) continue;
                    float* sum = rows.sums + (row - rows.top) * stride + 4 * static_cast<std::ptrdiff_t>(x);
                    for (int dx = 0; dx < 3; ++dx) {
                        const float w = wx[dx] * wy[dy + 1];
                        for (int c = 0; c < 4; ++c) sum[4 * dx + c] += w * colour[c];
                    }
                }
            }
    }
}

void resolve(const float* sums, int width, float* const out[3], float* weight) {
    for (int x = 0; x < width; ++x) {
        const float* sum = sums + 4 * (static_cast<std::ptrdiff_t>(x) + 1);
        const float w = sum[3] > kLeast ? sum[3] : 0.0f, inverse = w > 0.0f ? 1.0f / w : 0.0f;
        out[0][x] = sum[0] * inverse, out[1][x] = sum[1] * inverse, out[2][x] = sum[2] * inverse;
        weight[x] = w;
    }
}

}  // namespace

const ScatteredKernels& scatteredTable() {
    static const ScatteredKernels table{splat, resolve};
    return table;
}

}  // namespace lumi::LUMI_ISA

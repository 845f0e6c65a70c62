#include "filter/edge_avoiding_kernels.h"

#include "filter/atrous_taps.h"
#include "math/kernel_math.h"

namespace lumi::LUMI_ISA {
namespace {

struct Sums {
    alignas(64) float weight[kBlock], r[kBlock], g[kBlock], b[kBlock];
};

inline float squaredDistance(const float* const plane[3], std::ptrdiff_t p, std::ptrdiff_t q) {
    const float x = plane[0][p] - plane[0][q], y = plane[1][p] - plane[1][q], z = plane[2][p] - plane[2][q];
    return x * x + y * y + z * z;
}

inline void addTap(const EdgeAvoidingRow& row, const TapSpan& tap, int first, float h, Sums& sums) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    const float* const rgb[3] = {row.rgb[0] + at, row.rgb[1] + at, row.rgb[2] + at};
    const float* const normal[3] = {row.normal[0] + at, row.normal[1] + at, row.normal[2] + at};
    const float* const position[3] = {row.position[0] + at, row.position[1] + at, row.position[2] + at};
    const float* __restrict z = row.inverseDepth + at;
    float* __restrict weight = sums.weight;
    float* __restrict r = sums.r;
    float* __restrict g = sums.g;
    float* __restrict b = sums.b;
    for (int x = tap.begin; x < tap.end; ++x) {
        const std::ptrdiff_t q = x + tap.offset;
        const float angle = squaredDistance(position, x, q) * z[x] * z[x];
        const float exponent = -(row.colourScale * squaredDistance(rgb, x, q) +
                                 row.normalScale * squaredDistance(normal, x, q) + row.positionScale * angle);
        // The sky neither gives nor takes.
        const float surface = z[x] > 0.0f && z[q] > 0.0f ? h : 0.0f;
        const float w = surface * kernelExp2(exponent);
        const int k = x - first;
        weight[k] += w;
        r[k] += w * rgb[0][q];
        g[k] += w * rgb[1][q];
        b[k] += w * rgb[2][q];
    }
}

void filterRow(const EdgeAvoidingRow& row) {
    Sums sums;
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width;
    float* const planes[3] = {sums.r, sums.g, sums.b};
    constexpr float h0 = kSpline[2] * kSpline[2];
    for (int first = 0; first < row.width; first += kBlock) {
        const int last = first + kBlock < row.width ? first + kBlock : row.width;
        for (int x = first; x < last; ++x) sums.weight[x - first] = h0;
        for (int c = 0; c < 3; ++c)
            for (int x = first; x < last; ++x) planes[c][x - first] = h0 * row.rgb[c][at + x];
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                if (i == 0 && j == 0) continue;
                const TapSpan tap = tapSpan(row.width, row.height, row.y, i * row.step, j * row.step, first, last);
                if (tap.begin < tap.end) addTap(row, tap, first, kSpline[i + 2] * kSpline[j + 2], sums);
            }
        for (int c = 0; c < 3; ++c)
            for (int x = first; x < last; ++x) row.out[c][at + x] = planes[c][x - first] / sums.weight[x - first];
    }
}

}  // namespace

const EdgeAvoidingKernels& edgeAvoidingTable() {
    static const EdgeAvoidingKernels table{filterRow};
    return table;
}

}  // namespace lumi::LUMI_ISA

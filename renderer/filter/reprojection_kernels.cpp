#include "filter/reprojection_kernels.h"

#include <cmath>

#include "filter/index_runs.h"
#include "filter/tap_refusal.h"
#include "filter/whole_pixel.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr int kBlock = 256;

/// Where a block's points were, and what the previous frame should have seen there.
struct Points {
    alignas(64) int32_t x0[kBlock], y0[kBlock];
    alignas(64) float fx[kBlock], fy[kBlock];
    alignas(64) float inverseDepth[kBlock], allowed[kBlock];
    alignas(64) int32_t absent[kBlock];  ///< 1: the sky, or far off the image
};

void findPoints(const ReprojectionRow& row, int first, int last, Points& points) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width + first;
    const float* __restrict mx = row.motion[0] + at;
    const float* __restrict my = row.motion[1] + at;
    const float* __restrict mz = row.motion[2] + at;
    const float* __restrict depth = row.depth + at;
    const float* __restrict sx = row.slope[0] + at;
    const float* __restrict sy = row.slope[1] + at;
    const uint32_t* __restrict object = row.object + at;
    const float right = static_cast<float>(row.width) + 1, bottom = static_cast<float>(row.height) + 1;
    const float fy0 = static_cast<float>(row.y), tolerance = row.depthTolerance;
    for (int k = 0; k < last - first; ++k) {
        float px = static_cast<float>(first + k) + mx[k], py = fy0 + my[k];
        // Written so that NaN is far.
        const bool near = (px > -2.0f) & (py > -2.0f) & (px < right) & (py < bottom);
        px = wholePixel(near ? px : 0.0f);
        py = wholePixel(near ? py : 0.0f);
        points.absent[k] = (near & (object[k] != 0)) ? 0 : 1;
        const int32_t x0 = wholeBelow(px), y0 = wholeBelow(py);
        points.x0[k] = x0;
        points.y0[k] = y0;
        points.fx[k] = px - static_cast<float>(x0);
        points.fy[k] = py - static_cast<float>(y0);
        const float expected = 1.0f / (depth[k] + mz[k]);
        points.inverseDepth[k] = expected;
        points.allowed[k] = tolerance * expected + 2.0f * (std::fabs(sx[k]) + std::fabs(sy[k]));
    }
}

/// Points [from, to) of a block that begins at pixel `first`. InARow: they are whole pixels apart and inside the image.
template <bool InARow>
void testTap(const ReprojectionRow& row, int tap, int first, int from, int to, const Points& points) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(row.y) * row.width + first;
    const int dx = tap & 1, dy = tap >> 1, width = row.width, height = row.height;
    const float* __restrict nx = row.objectNormal[0] + at;
    const float* __restrict ny = row.objectNormal[1] + at;
    const float* __restrict nz = row.objectNormal[2] + at;
    const uint32_t* __restrict object = row.object + at;
    const float* __restrict z = row.previousInverseDepth;
    const float* __restrict px = row.previousNormal[0];
    const float* __restrict py = row.previousNormal[1];
    const float* __restrict pz = row.previousNormal[2];
    const uint32_t* __restrict previousObject = row.previousObject;
    int32_t* __restrict index = row.index[tap] + (first - row.begin);
    float* __restrict weight = row.weight[tap] + (first - row.begin);
    int32_t* __restrict refusals = row.refusals[tap] + (first - row.begin);
    const float leastCosine = row.normalCosine;
    const int32_t base = (points.y0[from] + dy) * width + points.x0[from] + dx - from;
    for (int k = from; k < to; ++k) {
        bool outside = false;
        int32_t q = base + k;
        if constexpr (!InARow) {
            const int32_t x = points.x0[k] + dx, y = points.y0[k] + dy;
            outside = (x < 0) | (y < 0) | (x >= width) | (y >= height);
            q = outside ? 0 : y * width + x;
        }
        const float wx = dx != 0 ? points.fx[k] : 1.0f - points.fx[k],
                    wy = dy != 0 ? points.fy[k] : 1.0f - points.fy[k];
        const float bilinear = wx * wy;
        const float difference = std::fabs(z[q] - points.inverseDepth[k]);
        const float cosine = px[q] * nx[k] + py[q] * ny[k] + pz[q] * nz[k];
        // Written so that NaN in any of the inputs refuses the tap.
        int32_t refused = (previousObject[q] != object[k] ? int32_t(kTapOtherObject) : 0) |
                          (difference <= points.allowed[k] ? 0 : int32_t(kTapDepth)) |
                          (cosine >= leastCosine ? 0 : int32_t(kTapNormal));
        refused = (outside | (points.absent[k] != 0)) ? int32_t(kTapOffScreen) : refused;
        refused = ((points.absent[k] == 0) & !(bilinear > 0.0f)) ? int32_t(kTapUnused) : refused;
        index[k] = q;
        weight[k] = bilinear;
        refusals[k] = refused;
    }
}

/// A refused tap's weight is spread uniformly over the others [Schied17, sec. 4.1]. Returns how many pixels have none.
int shareOut(const ReprojectionRow& row) {
    float* __restrict w0 = row.weight[0];
    float* __restrict w1 = row.weight[1];
    float* __restrict w2 = row.weight[2];
    float* __restrict w3 = row.weight[3];
    const int32_t* __restrict r0 = row.refusals[0];
    const int32_t* __restrict r1 = row.refusals[1];
    const int32_t* __restrict r2 = row.refusals[2];
    const int32_t* __restrict r3 = row.refusals[3];
    int without = 0;
    for (int k = 0; k < row.end - row.begin; ++k) {
        const float k0 = r0[k] == 0 ? 1.0f : 0.0f, k1 = r1[k] == 0 ? 1.0f : 0.0f;
        const float k2 = r2[k] == 0 ? 1.0f : 0.0f, k3 = r3[k] == 0 ? 1.0f : 0.0f;
        const float kept = k0 + k1 + k2 + k3;
        const float lost = (1.0f - k0) * w0[k] + (1.0f - k1) * w1[k] + (1.0f - k2) * w2[k] + (1.0f - k3) * w3[k];
        const float share = lost / (kept > 0.0f ? kept : 1.0f);
        w0[k] = k0 * (w0[k] + share);
        w1[k] = k1 * (w1[k] + share);
        w2[k] = k2 * (w2[k] + share);
        w3[k] = k3 * (w3[k] + share);
        without += kept > 0.0f ? 0 : 1;
    }
    return without;
}

bool inARow(const int32_t* __restrict numbers, int count) {
    int32_t differing = 0;
    for (int k = 0; k < count; ++k) differing |= numbers[k] ^ (numbers[0] + k);
    return differing == 0;
}

bool areOne(const int32_t* __restrict numbers, int count) {
    int32_t differing = 0;
    for (int k = 0; k < count; ++k) differing |= numbers[k] ^ numbers[0];
    return differing == 0;
}

int tapRow(const ReprojectionRow& row) {
    Points points;
    for (int first = row.begin; first < row.end; first += kBlock) {
        const int last = first + kBlock < row.end ? first + kBlock : row.end;
        findPoints(row, first, last, points);
        const auto follows = [&](int k) {
            return points.x0[k] == points.x0[k - 1] + 1 && points.y0[k] == points.y0[k - 1];
        };
        const auto test = [&](int from, int to, bool inARow) {
            const bool inside = points.x0[from] >= 0 && points.x0[to - 1] + 1 < row.width && points.y0[from] >= 0 &&
                                points.y0[from] + 1 < row.height;
            for (int tap = 0; tap < 4; ++tap)
                inARow&& inside ? testTap<true>(row, tap, first, from, to, points)
                                : testTap<false>(row, tap, first, from, to, points);
        };
        const int count = last - first;
        if (inARow(points.x0, count) && areOne(points.y0, count)) test(0, count, true);
        else forIndexRuns(0, count, follows, test);
    }
    return shareOut(row);
}

}  // namespace

const ReprojectionKernels& reprojectionTable() {
    static const ReprojectionKernels table{tapRow, inARow};
    return table;
}

}  // namespace lumi::LUMI_ISA

#pragma once
#include <cstddef>

#include "filter/spline.h"

/// The taps of à-trous kernels over rows of planes. Include only from kernel files: each instruction set compiles its
/// own.
namespace lumi {
namespace {

constexpr int kBlock = 256;  ///< pixels of a row whose sums stay in the first-level cache

/// One tap of a window: its offset in pixels and in memory, and the part of the row whose neighbour lies in the image.
struct TapSpan {
    float dx, dy;
    std::ptrdiff_t offset;
    int begin, end;
};

/// Of the tap (dx, dy) for pixels [begin, end) of row y.
inline TapSpan tapSpan(int width, int height, int y, int dx, int dy, int begin, int end) {
    TapSpan tap{static_cast<float>(dx), static_cast<float>(dy), static_cast<std::ptrdiff_t>(dy) * width + dx, begin,
                end};
    if (tap.begin < -dx) tap.begin = -dx;
    if (tap.end > width - dx) tap.end = width - dx;
    if (y + dy < 0 || y + dy >= height) tap.end = tap.begin;
    return tap;
}

}  // namespace
}  // namespace lumi

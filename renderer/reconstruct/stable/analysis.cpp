#include "reconstruct/stable/analysis.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "math/hash.h"
#include "reconstruct/stable/analysis_kernels.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;

DensityRow rowOf(const std::vector<uint32_t>& words, Extent2 extent, int y, float* density) {
    const uint32_t* here = words.data() + static_cast<ptrdiff_t>(y) * extent.width;
    return {y > 0 ? here - extent.width : nullptr, here, y + 1 < extent.height ? here + extent.width : nullptr,
            extent.width, density};
}

/// From which difference on eq. 1 acts.
float leastDifference(const DensitySettings& settings) { return std::min(settings.tolerance, settings.density); }

/// Drawn among the strata whose score is greatest; -1 if that is negative.
int greatest(const int (&scores)[subpixel::kStrata], uint32_t random) {
    const int most = *std::max_element(std::begin(scores), std::end(scores));
    if (most < 0) return -1;
    const auto ties = static_cast<uint32_t>(std::count(std::begin(scores), std::end(scores), most));
    uint32_t drawn = random % ties;
    for (int s = 0;; ++s)
        if (scores[s] == most && drawn-- == 0) return s;
}

/// Drawn among the bits that are set.
uint32_t anyBit(uint32_t bits, uint32_t random) {
    for (uint32_t skip = random % static_cast<uint32_t>(std::popcount(bits)); skip > 0; --skip) bits &= bits - 1;
    return bits & (~bits + 1);
}

}  // namespace

void DensitySettings::describe(ParameterVisitor& v) {
    v.number("density", density,
             {.label = "Target density",
              .min = 0.5,
              .max = 8,
              .scale = Scale::Log,
              .unit = "samples/px",
              .help = "d_target: visible samples a pixel that the analysis aims at (eq. 1)"});
    v.number(
        "tolerance", tolerance,
        {.label = "Density tolerance",
         .min = 0.1,
         .max = 4,
         .scale = Scale::Log,
         .unit = "samples/px",
         .help =
             "d_tolerance: how far the local density may be off before samples are added or removed (eq. 1); below 0.5 "
             "neighbours undo each other's changes and it never settles"});
    v.number("jitter", jitter,
             {.label = "Jitter of new samples",
              .min = 0,
              .max = 1,
              .unit = "sub-pixels",
              .help = "How far a new sample may lie off the middle of its stratum (sec. 4.2)"});
}

float localDensity(const std::vector<uint32_t>& words, Extent2 extent, int x, int y) {
    int count = 0;
    for (int sy = -2; sy < 6; ++sy)
        for (int sx = -2; sx < 6; ++sx) {
            const int column = 4 * x + sx, line = 4 * y + sy;
            if (column < 0 || line < 0 || column >= 4 * extent.width || line >= 4 * extent.height) continue;
            const uint32_t word = words[static_cast<size_t>(line / 4) * static_cast<size_t>(extent.width) +
                                        static_cast<size_t>(column / 4)];
            count += (subpixel::visible(word) >> (line % 4 * 4 + column % 4)) & 1u;
        }
    const auto inside = [](int at, int size) { return 1 + (at > 0 ? 0.5f : 0.0f) + (at + 1 < size ? 0.5f : 0.0f); };
    return static_cast<float>(count) / (inside(x, extent.width) * inside(y, extent.height));
}

int sampleChange(float density, const DensitySettings& settings) {
    const float missing = settings.density - density;
    if (std::fabs(missing) < leastDifference(settings)) return 0;
    const int change = static_cast<int>(std::ceil(std::fabs(missing)));
    return missing > 0 ? change : -change;
}

PixelChange changePixel(uint32_t word, int change, uint32_t random) {
    PixelChange result;
    for (int step = 0; step < std::abs(change); ++step) {
        random = pcgHash(random);
        const uint32_t visible = (subpixel::visible(word) | result.added) & ~result.removed;
        int scores[subpixel::kStrata];
        for (int s = 0; s < subpixel::kStrata; ++s) {
            const int count = static_cast<int>(subpixel::count(visible & subpixel::kStratum[s]));
            scores[s] = change > 0 ? (count < 4 ? 4 - count : -1) : (count > 0 ? count : -1);
        }
        const int stratum = greatest(scores, random);
        if (stratum < 0) break;
        const uint32_t members = subpixel::kStratum[stratum];
        if (change < 0) {
            result.removed |= anyBit(visible & members, random >> 8);
            continue;
        }
        const uint32_t free = members & ~subpixel::occupied(word) & ~result.added;
        result.added |= anyBit(free ? free : members & ~visible, random >> 8);
    }
    return result;
}

Vec2 newSamplePlace(int index, float jitter, uint32_t random) {
    constexpr float kLeast = 0.02f;  // of a sub-pixel, so that rounding does not move it into the next one
    const auto along = [&](int sub, uint32_t bits) {
        const float middle = sub < 2 ? 0.25f : 0.75f, side = sub % 2 == 0 ? -1.0f : 1.0f;
        return middle + side * (kLeast + (1 - 2 * kLeast) * jitter * unitFloat(bits)) / subpixel::kSide;
    };
    const uint32_t x = pcgHash(random + static_cast<uint32_t>(index)), y = pcgHash(x);
    return {along(index % subpixel::kSide, x), along(index / subpixel::kSide, y)};
}

uint32_t pixelRandom(int64_t pixel, uint32_t frame) {
    return hashCombine(static_cast<uint32_t>(pixel), frame, 0x57ab1eu);
}

bool analyseSamples(const std::vector<uint32_t>& words, Extent2 extent, const DensitySettings& settings, uint32_t frame,
                    std::vector<PixelChange>& changes, float* density, std::stop_token stop) {
    changes.resize(words.size());
    std::atomic<bool> any{false};
    const float acts = leastDifference(settings);
    parallelRanges(
        extent.height, kRows,
        [&](int64_t begin, int64_t end) {
            std::vector<float> scratch(static_cast<size_t>(extent.width));
            bool here = false;
            for (int64_t y = begin; y < end; ++y) {
                float* line = density ? density + y * extent.width : scratch.data();
                analysisKernels().densityRow(rowOf(words, extent, static_cast<int>(y), line));
                std::fill_n(changes.begin() + y * extent.width, extent.width, PixelChange());
                for (int x = 0; x < extent.width; ++x) {
                    if (std::fabs(settings.density - line[x]) < acts) continue;
                    const int change = sampleChange(line[x], settings);
                    const int64_t pixel = y * extent.width + x;
                    PixelChange& decided = changes[static_cast<size_t>(pixel)];
                    decided = changePixel(words[static_cast<size_t>(pixel)], change, pixelRandom(pixel, frame));
                    here |= (decided.added | decided.removed) != 0;
                }
            }
            if (here) any = true;
        },
        stop);
    return any;
}

}  // namespace lumi

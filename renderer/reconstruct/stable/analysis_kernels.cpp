#include "reconstruct/stable/analysis_kernels.h"

namespace lumi::LUMI_ISA {
namespace {

constexpr uint32_t kLeft = 0xCCCC, kRight = 0x3333, kAbove = 0xFF00, kBelow = 0x00FF, kWhole = 0xFFFF;

inline uint32_t visible(uint32_t word) { return word & ~(word >> 16) & kWhole; }

/// Bits set in both halves of a word, together.
inline uint32_t countBits(uint32_t v) {
    v = v - ((v >> 1) & 0x55555555u);
    v = (v & 0x33333333u) + ((v >> 2) & 0x33333333u);
    v = (v + (v >> 4)) & 0x0F0F0F0Fu;
    return (v * 0x01010101u) >> 24;
}

/// Visible samples in the window's part of a line: half of the pixels left and right, the whole of the middle one.
inline uint32_t countLine(const uint32_t* line, int x, int left, int right, uint32_t half) {
    const uint32_t sides = (visible(line[x + left]) & kLeft & half) | (visible(line[x + right]) & kRight & half) << 16;
    return countBits((left ? sides & kWhole : 0) | (right ? sides & ~kWhole : 0)) + countBits(visible(line[x]) & half);
}

/// `left` and `right`: -1 and 1 where the row goes on there, else 0.
inline float densityAt(const DensityRow& row, int x, int left, int right) {
    uint32_t count = countLine(row.here, x, left, right, kWhole);
    float height = 1;
    if (row.above) count += countLine(row.above, x, left, right, kAbove), height += 0.5f;
    if (row.below) count += countLine(row.below, x, left, right, kBelow), height += 0.5f;
    const float width = 1 + (left ? 0.5f : 0.0f) + (right ? 0.5f : 0.0f);
    return static_cast<float>(static_cast<int32_t>(count)) / (width * height);
}

/// The window's left and right columns of a line, which take different bits, and above these the pixel in the middle.
inline uint32_t gatherLine(const uint32_t* line, int x, uint32_t half) {
    const uint32_t sides = (visible(line[x - 1]) & kLeft) | (visible(line[x + 1]) & kRight);
    return (sides & half) | (visible(line[x]) & half) << 16;
}

/// Bits set in both words. As one sum: a compiler that finds a single word's count here makes it an instruction that
/// takes one pixel at a time.
inline uint32_t countBits(uint32_t a, uint32_t b) {
    a = a - ((a >> 1) & 0x55555555u), b = b - ((b >> 1) & 0x55555555u);
    const uint32_t fours = (a & 0x33333333u) + ((a >> 2) & 0x33333333u) + (b & 0x33333333u) + ((b >> 2) & 0x33333333u);
    return (((fours & 0x0F0F0F0Fu) + ((fours >> 4) & 0x0F0F0F0Fu)) * 0x01010101u) >> 24;
}

template <bool Above, bool Below>
void inner(const DensityRow& row) {
    const uint32_t *above = row.above, *here = row.here, *below = row.below;
    float* const density = row.density;
    const int last = row.width - 1;
    constexpr float kArea = 2 * (1 + (Above ? 0.5f : 0.0f) + (Below ? 0.5f : 0.0f));
    for (int x = 1; x < last; ++x) {
        uint32_t others = 0;  // halves of the two lines: different bits again
        if (Above) others |= gatherLine(above, x, kAbove);
        if (Below) others |= gatherLine(below, x, kBelow);
        const uint32_t count = countBits(gatherLine(here, x, kWhole), others);
        density[x] = static_cast<float>(static_cast<int32_t>(count)) / kArea;
    }
}

void densityRow(const DensityRow& row) {
    const int last = row.width - 1;
    row.density[0] = densityAt(row, 0, 0, last > 0 ? 1 : 0);
    if (last > 0) row.density[last] = densityAt(row, last, -1, 0);
    if (row.above) row.below ? inner<true, true>(row) : inner<true, false>(row);
    else row.below ? inner<false, true>(row) : inner<false, false>(row);
}

}  // namespace

const AnalysisKernels& analysisTable() {
    static const AnalysisKernels table{densityRow};
    return table;
}

}  // namespace lumi::LUMI_ISA

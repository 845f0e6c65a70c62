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

template <bool Above, bool Below>
void inner(const DensityRow& row) {
    DensityRow known = row;
    for (int x = 1; x < row.width - 1; ++x) {
        uint32_t count = countLine(known.here, x, -1, 1, kWhole);
        if (Above) count += countLine(known.above, x, -1, 1, kAbove);
        if (Below) count += countLine(known.below, x, -1, 1, kBelow);
        const float area = 2 * (1 + (Above ? 0.5f : 0.0f) + (Below ? 0.5f : 0.0f));
        known.density[x] = static_cast<float>(static_cast<int32_t>(count)) / area;
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

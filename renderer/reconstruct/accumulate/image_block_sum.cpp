#include "reconstruct/accumulate/image_block_sum.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 15;

/// a += b
void addTo(ImageOf<double>& a, const ImageOf<double>& b) {
    parallelRanges(static_cast<int64_t>(a.size()), kGrain, [&](int64_t begin, int64_t end) {
        double* target = a.data();
        const double* source = b.data();
        for (int64_t i = begin; i < end; ++i) target[i] += source[i];
    });
}

/// Do the two, neighbours in this order, fill an aligned block of twice their size?
bool pairUp(uint64_t first, uint64_t count, uint64_t nextFirst, uint64_t nextCount) {
    return count == nextCount && std::has_single_bit(count) && first % (2 * count) == 0 && first + count == nextFirst;
}

}  // namespace

void ImageBlockSum::add(uint64_t first, uint64_t count, ImageOf<double> sum) {
    while (!blocks_.empty() && pairUp(blocks_.back().first, blocks_.back().count, first, count)) {
        Block& left = blocks_.back();
        addTo(left.sum, sum);
        sum = std::move(left.sum);
        first = left.first;
        count *= 2;
        blocks_.pop_back();
    }
    blocks_.push_back({first, count, std::move(sum)});
}

void ImageBlockSum::scaledTotal(const ImageOf<double>& last, double scale, Image& out) const {
    // add() joins neighbours from the newest to the oldest, and what is left is summed from small to large: both walk
    // the blocks from the back with one running sum. A row of values at a time stays in the first-level cache.
    parallelRanges(static_cast<int64_t>(last.size()), 1 << 14, [&](int64_t begin, int64_t end) {
        constexpr int64_t kRow = 1024;
        double row[kRow];
        for (int64_t first = begin; first < end; first += kRow) {
            const int64_t count = std::min(kRow, end - first);
            std::copy_n(last.data() + first, count, row);
            for (size_t b = blocks_.size(); b-- > 0;) {
                const double* block = blocks_[b].sum.data() + first;
                for (int64_t i = 0; i < count; ++i) row[i] += block[i];
            }
            for (int64_t i = 0; i < count; ++i) out.data()[first + i] = static_cast<float>(row[i] * scale);
        }
    });
}

size_t ImageBlockSum::bytes() const {
    size_t sum = 0;
    for (const Block& block : blocks_) sum += block.sum.bytes();
    return sum;
}

}  // namespace lumi

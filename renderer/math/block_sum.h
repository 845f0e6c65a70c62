#pragma once
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

namespace lumi {

/// Adds values that belong to consecutive indices pairwise over aligned power-of-two blocks: block [k 2^n, (k+1) 2^n)
/// is the sum of its two halves. Any split of the indices into aligned blocks, added up by another BlockSum, gives the
/// same bits. `Value` has operator+.
template <class Value, int kCapacity = 96>
class BlockSum {
public:
    /// Adds the sum of the aligned block [first, first + count); `count` is a power of two that divides `first`, and
    /// `first` follows the last block.
    void add(uint64_t first, uint64_t count, Value sum) {
        assert(std::has_single_bit(count) && first % count == 0);
        // A finished right half joins its left half, again and again.
        while (depth_ > 0 && top().count == count && top().first + count == first && (first & count) != 0) {
            sum = top().sum + sum;
            first -= count;
            count *= 2;
            --depth_;
        }
        blocks_[depth_++] = {first, count, sum};
    }
    void add(uint64_t index, Value value) { add(index, 1, value); }

    /// Sum of everything added; blocks that wait for their other half are added from the latest to the earliest.
    Value total() const {
        assert(depth_ > 0);
        Value sum = blocks_[depth_ - 1].sum;
        for (int i = depth_ - 2; i >= 0; --i) sum = blocks_[i].sum + sum;
        return sum;
    }
    bool empty() const { return depth_ == 0; }
    void clear() { depth_ = 0; }

    /// Calls visit(first, count, sum) for the blocks as they stand, earliest first.
    template <class Visit>
    void forEachBlock(Visit&& visit) const {
        for (int i = 0; i < depth_; ++i) visit(blocks_[i].first, blocks_[i].count, blocks_[i].sum);
    }

private:
    struct Block {
        uint64_t first, count;
        Value sum;
    };
    const Block& top() const { return blocks_[depth_ - 1]; }

    // Ascending then descending block sizes: at most two blocks of each power of two, so 2 log2(n) + 2 for n values.
    std::array<Block, kCapacity> blocks_;
    int depth_ = 0;
};

}  // namespace lumi

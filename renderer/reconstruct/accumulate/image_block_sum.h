#pragma once
#include <vector>

#include "image/image.h"

namespace lumi {

/// math/block_sum.h for images: sums of a growing sequence of steps, kept as a binary counter. Two neighbouring sums
/// that together make an aligned power-of-two block become one; the total is the sum over the aligned binary tree, so
/// it does not depend on how the sequence was cut into aligned steps.
///
/// Cost: one image for each set bit of the number of steps, plus those that an unaligned start leaves.
class ImageBlockSum {
public:
    void clear() { blocks_.clear(); }
    /// Adds the sum of steps [first, first + count); `first` is where the sequence has come to (or anything, if empty).
    void add(uint64_t first, uint64_t count, ImageOf<double> sum);
    /// out = scale * (all blocks + `last`), the smaller added first: what add() would make of them. `last` is the step
    /// after the last block; `out` has its shape.
    void scaledTotal(const ImageOf<double>& last, double scale, Image& out) const;
    size_t bytes() const;

private:
    struct Block {
        uint64_t first = 0, count = 0;
        ImageOf<double> sum;
    };
    std::vector<Block> blocks_;
};

}  // namespace lumi

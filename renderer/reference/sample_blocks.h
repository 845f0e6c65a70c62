#pragma once
#include <cstdint>
#include <vector>

#include "image/image.h"

namespace lumi {

/// Samples in the smallest block that is kept: sums of fewer exist only at the end of a reference.
constexpr uint64_t kLeafSamples = 16;

/// Half-open range of samples.
struct SampleRange {
    uint64_t begin = 0, end = 0;
    uint64_t count() const { return end - begin; }
    bool operator==(const SampleRange&) const = default;
};

/// Sum of an aligned block of samples, a power of two times kLeafSamples of them, and how its parts scatter.
struct SampleBlock {
    /// Depths below a block at which the scatter of its parts is known: 2, 4, 8 and 16 parts.
    static constexpr int kScatterDepths = 4;

    uint64_t first = 0, count = 0;
    ImageOf<double> sum;  ///< RGB radiance
    Image left;           ///< RGB sum of the first half; empty in a leaf
    /// Channel d - 1: squared deviations of the luminance sums of 2^d equal parts from their mean, added up. As many
    /// channels as there are levels below, kScatterDepths at most.
    Image scatter;

    /// A block of zeros with the planes that one of this range has.
    static SampleBlock shaped(SampleRange range, Extent2 extent);

    uint64_t end() const { return first + count; }
    int level() const;  ///< 0 for a leaf
    size_t bytes() const { return sum.bytes() + left.bytes() + scatter.bytes(); }
};

/// Bytes of one block of an image of `extent`, and of all that a reference of `samples` may hold at a time.
uint64_t sampleBlockBytes(Extent2 extent);
uint64_t sampleBlocksBytes(Extent2 extent, uint64_t samples);

/// The largest aligned block that begins at `begin` and does not pass `end`, both multiples of kLeafSamples.
SampleRange alignedBlock(uint64_t begin, uint64_t end, uint64_t mostSamples = ~uint64_t(0));

/// Consecutive aligned blocks as the nodes of one binary tree over all samples: two that make an aligned block of twice
/// their size become one. What is held depends on the range alone, not on how it was cut, in which order of sessions it
/// came or who traced it; so do all bits of its sums (math/block_sum.h is the same for numbers).
class SampleBlocks {
public:
    /// `block` begins where the last one ended (anywhere, if there is none).
    void add(SampleBlock block);
    const std::vector<SampleBlock>& blocks() const { return blocks_; }
    /// Hands out the only block.
    SampleBlock release();
    bool empty() const { return blocks_.empty(); }
    SampleRange range() const;
    size_t bytes() const;

    /// Mean of all blocks and `tail` (the sum of the `tailCount` samples after them; may be empty), as float RGB.
    Image mean(const ImageOf<double>& tail, uint64_t tailCount) const;
    /// Mean of the blocks' first (`second` false) or second halves, without leaves; empty if there are only leaves.
    Image half(bool second) const;
    /// Standard error of the luminance of mean(), from 16 to 31 equal parts; `samples` are all that the mean has. Empty
    /// if the blocks hold fewer than 16 leaves.
    Image standardError(uint64_t samples) const;

private:
    std::vector<SampleBlock> blocks_;
};

/// Root of the mean over pixels of standardError^2 / (luminance(mean)^2 + 0.001); NaN without a standard error.
double relativeError(const Image& mean, const Image& standardError);

}  // namespace lumi

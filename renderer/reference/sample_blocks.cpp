#include "reference/sample_blocks.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"

namespace lumi {
namespace {

constexpr int64_t kGrain = 1 << 14;

double luminanceOf(const ImageOf<double>& sum, int64_t i) {
    const int64_t area = sum.extent().area();
    const double* v = sum.data();
    return 0.2126 * v[i] + 0.7152 * v[area + i] + 0.0722 * v[2 * area + i];
}

/// Squared deviations of the parts of two neighbours together, at every depth below their common block [Chan 1979].
Image joinedScatter(const SampleBlock& left, const SampleBlock& right, int depths) {
    const int64_t area = left.sum.extent().area();
    Image scatter(left.sum.extent(), depths);
    parallelRanges(area, kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            const double difference = luminanceOf(left.sum, i) - luminanceOf(right.sum, i);
            double between = difference * difference;
            for (int d = 1; d <= depths; ++d) {
                between /= 2;  // difference^2 / 2^d
                double within = 0;
                if (d > 1) {
                    const int64_t below = (d - 2) * area + i;
                    within = static_cast<double>(left.scatter.data()[below]) + right.scatter.data()[below];
                }
                scatter.data()[(d - 1) * area + i] = static_cast<float>(within + between);
            }
        }
    });
    return scatter;
}

/// The parent of two neighbours of one size.
SampleBlock joined(SampleBlock left, const SampleBlock& right) {
    SampleBlock parent;
    parent.first = left.first;
    parent.count = 2 * left.count;
    parent.scatter = joinedScatter(left, right, std::min(left.level() + 1, SampleBlock::kScatterDepths));
    parent.left.reset(left.sum.extent(), 3);
    parallelRanges(static_cast<int64_t>(left.sum.size()), kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            parent.left.data()[i] = static_cast<float>(left.sum.data()[i]);
            left.sum.data()[i] += right.sum.data()[i];
        }
    });
    parent.sum = std::move(left.sum);
    return parent;
}

/// Running mean and squared deviations of equal parts, joined block by block [Chan 1979].
struct Scatter {
    double parts = 0, mean = 0, squares = 0;
    void join(double otherParts, double otherMean, double otherSquares) {
        const double all = parts + otherParts, difference = otherMean - mean;
        squares += otherSquares + difference * difference * parts * otherParts / all;
        mean += difference * otherParts / all;
        parts = all;
    }
};

}  // namespace

int SampleBlock::level() const { return std::countr_zero(count / kLeafSamples); }

SampleBlock SampleBlock::shaped(SampleRange range, Extent2 extent) {
    SampleBlock block{range.begin, range.count(), ImageOf<double>(extent, 3), {}, {}};
    if (block.level() > 0) block.left.reset(extent, 3);
    block.scatter.reset(extent, std::min(block.level(), kScatterDepths));
    return block;
}

uint64_t sampleBlockBytes(Extent2 extent) {
    return static_cast<uint64_t>(extent.area()) *
           (3 * sizeof(double) + 3 * sizeof(float) + SampleBlock::kScatterDepths * sizeof(float));
}

uint64_t sampleBlocksBytes(Extent2 extent, uint64_t samples) {
    // One block of each size, and the one that is being traced or joined.
    return sampleBlockBytes(extent) * (static_cast<uint64_t>(std::bit_width(samples / kLeafSamples)) + 2);
}

SampleRange alignedBlock(uint64_t begin, uint64_t end, uint64_t mostSamples) {
    assert(begin % kLeafSamples == 0 && end % kLeafSamples == 0 && begin < end);
    uint64_t size = kLeafSamples;
    while (begin % (2 * size) == 0 && begin + 2 * size <= end && 2 * size <= mostSamples) size *= 2;
    return {begin, begin + size};
}

void SampleBlocks::add(SampleBlock block) {
    assert(std::has_single_bit(block.count / kLeafSamples) && block.first % block.count == 0);
    assert(blocks_.empty() || blocks_.back().end() == block.first);
    while (!blocks_.empty() && blocks_.back().count == block.count && blocks_.back().first % (2 * block.count) == 0) {
        block = joined(std::move(blocks_.back()), block);
        blocks_.pop_back();
    }
    blocks_.push_back(std::move(block));
}

SampleBlock SampleBlocks::release() {
    assert(blocks_.size() == 1);
    SampleBlock block = std::move(blocks_.front());
    blocks_.clear();
    return block;
}

SampleRange SampleBlocks::range() const {
    return blocks_.empty() ? SampleRange() : SampleRange{blocks_.front().first, blocks_.back().end()};
}

size_t SampleBlocks::bytes() const {
    size_t sum = 0;
    for (const SampleBlock& block : blocks_) sum += block.bytes();
    return sum;
}

Image SampleBlocks::mean(const ImageOf<double>& tail, uint64_t tailCount) const {
    assert(!blocks_.empty() || tailCount > 0);
    const Extent2 extent = blocks_.empty() ? tail.extent() : blocks_.front().sum.extent();
    const double scale = 1 / static_cast<double>(range().count() + tailCount);
    Image out(extent, 3);
    parallelRanges(static_cast<int64_t>(out.size()), kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            // From the latest block to the earliest, as BlockSum::total().
            size_t b = blocks_.size();
            double sum = tailCount > 0 ? tail.data()[i] : blocks_[--b].sum.data()[i];
            while (b-- > 0) sum = blocks_[b].sum.data()[i] + sum;
            out.data()[i] = static_cast<float>(sum * scale);
        }
    });
    return out;
}

Image SampleBlocks::half(bool second) const {
    uint64_t samples = 0;
    for (const SampleBlock& block : blocks_)
        if (!block.left.empty()) samples += block.count / 2;
    if (samples == 0) return {};
    Image out(blocks_.front().sum.extent(), 3);
    const double scale = 1 / static_cast<double>(samples);
    parallelRanges(static_cast<int64_t>(out.size()), kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            double sum = 0;
            for (const SampleBlock& block : blocks_) {
                if (block.left.empty()) continue;
                const double left = block.left.data()[i];
                sum += second ? block.sum.data()[i] - left : left;
            }
            out.data()[i] = static_cast<float>(sum * scale);
        }
    });
    return out;
}

Image SampleBlocks::standardError(uint64_t samples) const {
    const uint64_t leaves = range().count() / kLeafSamples;
    if (leaves < 16) return {};
    const int partLevel = std::bit_width(leaves) - 1 - SampleBlock::kScatterDepths;
    const double partSamples = static_cast<double>(kLeafSamples << partLevel);
    const int64_t area = blocks_.front().sum.extent().area();
    Image out(blocks_.front().sum.extent(), 1);
    parallelRanges(area, kGrain, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            Scatter all;
            for (const SampleBlock& block : blocks_) {
                const int depth = block.level() - partLevel;
                if (depth < 0) continue;
                const double parts = static_cast<double>(1 << depth);
                const double squares = depth > 0 ? block.scatter.data()[(depth - 1) * area + i] : 0;
                all.join(parts, luminanceOf(block.sum, i) / parts, squares);
            }
            const double covered = all.parts * partSamples / static_cast<double>(samples);
            const double meanVariance = all.squares / (all.parts - 1) / all.parts * covered;
            out.data()[i] = static_cast<float>(std::sqrt(meanVariance) / partSamples);
        }
    });
    return out;
}

double relativeError(const Image& mean, const Image& standardError) {
    if (standardError.empty()) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (int y = 0; y < mean.height(); ++y) {
        double row = 0;
        for (int x = 0; x < mean.width(); ++x) {
            const double light = luminance(Vec3(mean.at(0, x, y), mean.at(1, x, y), mean.at(2, x, y)));
            const double error = standardError.at(0, x, y);
            row += error * error / (light * light + 0.001);
        }
        sum += row;
    }
    return std::sqrt(sum / static_cast<double>(mean.extent().area()));
}

}  // namespace lumi

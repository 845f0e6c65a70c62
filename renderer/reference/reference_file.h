#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "reference/sample_blocks.h"

namespace lumi {

/// What is kept of a reference between sessions: block sums, so that it can go on, be split and be merged.
struct ReferenceState {
    std::string key;  ///< referenceKeyText() of what was traced
    Extent2 extent;
    SampleBlocks blocks;
    ImageOf<double> tail;  ///< sum of the samples after the blocks, fewer than a leaf; may be empty
    uint64_t tailCount = 0;
    Image depth;  ///< of the first sample; 1 channel
    /// Reference::error at each step of the ladder that the blocks have passed, ascending by samples.
    std::vector<std::pair<uint64_t, double>> ladder;
    bool goal = false;  ///< somebody asked for just this many samples; else it may make way for more
    std::string note;   ///< the caller's own text, kept as it is

    uint64_t samples() const { return blocks.range().count() + tailCount; }
};

/// Writes beside `path`, to the disk, then renames: after a crash at any moment there is the old file or the new one.
/// Throws Error(Resources) if the disk is full, Error(Usage) if the place cannot be written.
void writeReferenceFile(const std::filesystem::path& path, const ReferenceState& state);

/// Throws Error(BadInput) naming the file: no such file, another kind of file or version, truncated, damaged (every
/// byte is covered by a digest). Error(Resources) if it passes the memory limit.
ReferenceState readReferenceFile(const std::filesystem::path& path);

/// Only key, extent, length of the tail, ladder, goal and note, and into `range` (may be null) which samples the blocks
/// hold; the rest of the file is not looked at.
ReferenceState readReferenceHead(const std::filesystem::path& path, SampleRange* range = nullptr);

}  // namespace lumi

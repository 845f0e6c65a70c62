#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "reference/reference.h"
#include "reference/reference_file.h"

namespace lumi {

/// Traces the samples of `range` (multiples of kLeafSamples) of a reference and writes their block sums to `file`, with
/// `note` for whoever merges. Goes on from `<file>.partial`, where an interrupted call left what it had; that is
/// removed in the end. A `file` that is there already and holds just this is left alone. Throws Error(Usage) if it
/// holds something else, otherwise as makeReference().
void makeReferencePart(const ReferenceSpec& spec, SampleRange range, const std::filesystem::path& file,
                       const std::string& note, const ReferenceOptions& options);

/// Adds up the blocks of parts in order of their samples. Throws Error(BadInput) if they do not follow each other
/// without gap or overlap or are not of one image, naming both files.
ReferenceState mergeParts(std::span<const std::filesystem::path> files);

}  // namespace lumi

#include "reference/reference_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "reference/block_runner.h"
#include "reference/reference_key.h"

namespace lumi {
namespace fs = std::filesystem;
namespace {

std::string rangeText(SampleRange range) { return fmt::format("{}..{}", range.begin, range.end); }

/// What an interrupted call left, if it is of this image and begins where it should.
bool resume(const fs::path& partial, const std::string& key, SampleRange range, ReferenceState& state,
            MessageLog* log) {
    std::error_code failure;
    if (!fs::exists(partial, failure)) return false;
    try {
        ReferenceState kept = readReferenceFile(partial);
        if (kept.key == key && kept.blocks.range().begin == range.begin && kept.blocks.range().end <= range.end) {
            state = std::move(kept);
            return true;
        }
        if (log) log->warning(partial.string() + ": belongs to another image or other samples; it is not used");
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::BadInput) throw;
        if (log) log->warning(std::string(error.what()) + "; it is not used");
    }
    return false;
}

struct Part {
    fs::path file;
    SampleRange range;
    ReferenceState head;
};

/// Heads of the files in order of their samples, each beginning where the one before ends, all of one image.
std::vector<Part> orderedParts(std::span<const fs::path> files) {
    std::vector<Part> parts;
    for (const fs::path& file : files) {
        Part part{file, {}, {}};
        part.head = readReferenceHead(file, &part.range);
        if (part.head.tailCount > 0 || part.range.count() == 0)
            throwBadInput(
                {"is not a part", file.string(), fmt::format("samples in multiples of {}", kLeafSamples), ""});
        parts.push_back(std::move(part));
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& a, const Part& b) { return a.range.begin < b.range.begin; });
    for (size_t i = 1; i < parts.size(); ++i) {
        const Part &before = parts[i - 1], &part = parts[i];
        if (part.head.key != before.head.key)
            throwBadInput({"belongs to another image than " + before.file.string(), part.file.string(),
                           "one key for all parts", keyDifference(before.head.key, part.head.key)});
        if (part.range.begin != before.range.end)
            throwBadInput({part.range.begin < before.range.end ? "overlaps " + before.file.string()
                                                               : "samples are missing after " + before.file.string(),
                           part.file.string(), fmt::format("samples from {} on", before.range.end),
                           rangeText(part.range)});
    }
    return parts;
}

/// Is the part there already? Throws Error(Usage) if something else has its name.
bool partThere(const fs::path& file, const std::string& key, SampleRange range, const std::string& note) {
    std::error_code failure;
    if (!fs::exists(file, failure)) return false;
    SampleRange present;
    const ReferenceState head = readReferenceHead(file, &present);
    if (head.key == key && present == range && head.note == note) return true;
    throwUsage({"exists already", file.string(), "a new file, or one of the same samples of the same image",
                "samples " + rangeText(present)});
}

}  // namespace

void makeReferencePart(const ReferenceSpec& spec, SampleRange range, const fs::path& file, const std::string& note,
                       const ReferenceOptions& options) {
    const std::string key = referenceKeyText(spec);
    if (partThere(file, key, range, note)) return;
    const fs::path partial = file.string() + ".partial";
    ReferenceState state;
    if (!resume(partial, key, range, state, options.log)) {
        state.key = key;
        state.extent = spec.camera.extent;
    }
    state.goal = true;
    state.note = note;
    BlockTracer tracer(spec);
    BlockRunner runner(tracer, options, state, [&] { writeReferenceFile(partial, state); });
    runner.checkMemoryFor(range.end);
    if (state.depth.empty()) state.depth = tracer.traceDepth();
    const uint64_t resumed = state.blocks.range().count();
    if (resumed < range.count()) runner.advanceTo(range.begin, range.end, {0, range.count(), resumed, 0, false});
    // Another process may have taken the name meanwhile: what it wrote is not written over.
    if (!partThere(file, key, range, note)) writeReferenceFile(file, state);
    std::error_code failure;
    fs::remove(partial, failure);
}

ReferenceState mergeParts(std::span<const fs::path> files) {
    ReferenceState merged;
    for (const Part& part : orderedParts(files)) {
        ReferenceState state = readReferenceFile(part.file);
        if (merged.blocks.empty()) {
            merged = std::move(state);
            continue;
        }
        for (const SampleBlock& block : state.blocks.blocks()) merged.blocks.add(block);
    }
    merged.ladder.clear();
    return merged;
}

}  // namespace lumi

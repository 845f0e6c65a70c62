#include "reference/block_runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/memory.h"

namespace lumi {
namespace {

constexpr double kSaveMs = 2000;     ///< at least between two saves
constexpr double kSaveShare = 0.05;  ///< of the time may go into saving
/// Samples that a member of a team traces at a time: what it sends is then small against what it traces.
constexpr uint64_t kTeamSamples = 4 * kLeafSamples;
/// Bytes a pixel besides the sums: the noisy frame and its sum, the mean, its halves and its error.
constexpr uint64_t kOtherBytes = 128;

}  // namespace

BlockRunner::BlockRunner(BlockTracer& tracer, const ReferenceOptions& options, ReferenceState& state,
                         std::function<void()> save)
    : tracer_(tracer), options_(options), state_(state), save_(std::move(save)) {}

std::vector<SampleRange> BlockRunner::nextRanges(uint64_t begin, uint64_t end) const {
    const auto members = static_cast<uint64_t>(options_.team->size());
    uint64_t most = kTeamSamples;
    while (most > kLeafSamples && most * members > end - begin) most /= 2;
    std::vector<SampleRange> ranges;
    while (begin < end && ranges.size() < members) {
        ranges.push_back(alignedBlock(begin, end, most));
        begin = ranges.back().end;
    }
    return ranges;
}

void BlockRunner::checkMemoryFor(uint64_t end) const {
    const uint64_t needed =
        sampleBlocksBytes(state_.extent, end) + kOtherBytes * static_cast<uint64_t>(state_.extent.area());
    const uint64_t held = state_.blocks.bytes();
    checkMemory(fmt::format("a reference of {}x{}", state_.extent.width, state_.extent.height),
                needed > held ? needed - held : 0);
}

void BlockRunner::advanceTo(uint64_t begin, uint64_t end, const ReferenceProgress& progress) {
    const auto position = [&] { return state_.blocks.empty() ? begin : state_.blocks.range().end; };
    checkMemoryFor(end);
    const auto take = [&](SampleBlock block) {
        state_.blocks.add(std::move(block));
        unsaved_ = traced_ = true;
        if (!options_.progress) return;
        ReferenceProgress now = progress;
        now.samples = state_.blocks.range().count();
        options_.progress(now);
    };
    while (position() < end) {
        bool whole = true;
        if (options_.team) {
            whole = options_.team->trace(tracer_, nextRanges(position(), end), take, options_.stop);
        } else {
            SampleBlock leaf;
            whole = tracer_.traceLeaf(position(), leaf, options_.stop);
            if (whole) take(std::move(leaf));
        }
        if (!whole) interrupted();
        if (sinceSave_.elapsedMs() > std::max(kSaveMs, saveMs_ / kSaveShare)) save();
    }
}

void BlockRunner::save() {
    if (save_ && unsaved_) {
        const Timer timer;
        save_();
        saveMs_ = timer.elapsedMs();
    }
    unsaved_ = false;
    sinceSave_.restart();
}

void BlockRunner::interrupted() {
    save();
    const uint64_t samples = state_.blocks.range().count();
    throw Error(ErrorKind::Interrupted,
                {save_ ? fmt::format("interrupted; {} samples a pixel are kept", samples) : "interrupted", "", "", ""});
}

}  // namespace lumi

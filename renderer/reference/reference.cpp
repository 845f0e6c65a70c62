#include "reference/reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "base/error.h"
#include "reference/block_runner.h"
#include "reference/finished_reference.h"
#include "reference/reference_cache.h"
#include "reference/reference_key.h"

namespace lumi {
namespace {

constexpr uint64_t kFirstStep = 256;

uint64_t wholeLeaves(uint64_t samples) { return samples - samples % kLeafSamples; }

/// The ladder has 4, 5, 6 and 7 times each power of two, from kFirstStep on.
bool isStep(uint64_t samples) {
    return samples >= kFirstStep && samples % std::max<uint64_t>(std::bit_floor(samples) / 4, 1) == 0;
}
uint64_t nextStep(uint64_t samples) {
    if (samples < kFirstStep) return kFirstStep;
    const uint64_t quarter = std::bit_floor(samples) / 4;
    return samples - samples % quarter + quarter;
}

/// One call of makeReference().
class ReferenceRun {
public:
    ReferenceRun(const ReferenceSpec& spec, const ReferenceGoal& goal, const ReferenceOptions& options)
        : spec_(spec), goal_(goal), options_(options), keyText_(referenceKeyText(spec)), tracer_(spec) {
        if (!options.cache.empty()) cache_.emplace(options.cache / referenceKey(spec), keyText_, options.log);
    }

    Reference run() {
        if (cache_) {
            if (auto kept = keptGoal()) return result(*kept, true);
            lock();
            if (auto kept = keptGoal()) return result(*kept, true);  // another process made it meanwhile
            if (cache_) begin();
        }
        if (!cache_) fresh();
        BlockRunner runner(tracer_, options_, state_, cache_ ? [this] { save(); } : std::function<void()>());
        climb(runner);
        addTail(runner);
        state_.goal = true;
        if (cache_) save();
        return result(state_, !runner.traced() && state_.tailCount == 0);
    }

private:
    /// How many samples are wanted; 0 while only the error is known.
    uint64_t target() const {
        if (goal_.error <= 0) return goal_.samples;
        for (const auto& [samples, error] : cache_ ? cache_->ladder() : state_.ladder)
            if (error <= goal_.error) return samples;
        return 0;
    }

    std::optional<ReferenceState> keptGoal() {
        if (!cache_) return std::nullopt;
        target_ = target();
        std::error_code failure;
        if (target_ == 0 || !std::filesystem::exists(cache_->fileOf(target_), failure)) return std::nullopt;
        std::optional<ReferenceState> kept = cache_->best(target_, true);
        if (!kept || kept->samples() != target_ || !kept->goal) return std::nullopt;
        return kept;
    }

    void lock() {
        try {
            lock_.emplace(cache_->lockFile(), options_.stop, [this] {
                if (options_.progress) options_.progress({0, target_, 0, 0, true});
            });
            cache_->removeLeftovers();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::Usage) throw;
            if (options_.log) options_.log->warning(std::string(error.what()) + "; the reference is not kept");
            cache_.reset();
        }
    }

    void fresh() {
        target_ = goal_.error > 0 ? 0 : goal_.samples;
        state_ = {};
        state_.key = keyText_;
        state_.extent = spec_.camera.extent;
    }

    void begin() {
        std::optional<ReferenceState> kept =
            cache_->best(target_ > 0 ? target_ : ReferenceGoal::kMostSamples, target_ > 0);
        if (!kept) return fresh();
        state_ = std::move(*kept);
        state_.goal = false;
        saved_ = resumed_ = state_.samples();
    }

    void climb(BlockRunner& runner) {
        runner.checkMemoryFor(std::max(target_, kLeafSamples));
        if (state_.depth.empty()) state_.depth = tracer_.traceDepth();
        if (target_ > 0 && state_.samples() == target_) return;
        for (;;) {
            const uint64_t samples = state_.blocks.range().end;
            if (isStep(samples)) measureStep(samples);
            const double error = state_.ladder.empty() ? std::nan("") : state_.ladder.back().second;
            if (target_ == 0 && isStep(samples) && error <= goal_.error) target_ = samples;
            if (target_ == 0 && samples >= ReferenceGoal::kMostSamples) giveUp(samples, error);
            if (target_ > 0 && samples == wholeLeaves(target_)) return;
            const uint64_t most = target_ > 0 ? wholeLeaves(target_) : ReferenceGoal::kMostSamples;
            runner.advanceTo(0, std::min(nextStep(samples), most), {0, target_, resumed_, error, false});
        }
    }

    void measureStep(uint64_t samples) {
        if (!state_.ladder.empty() && state_.ladder.back().first >= samples) return;
        const double error = relativeError(state_.blocks.mean({}, 0), state_.blocks.standardError(samples));
        if (std::isfinite(error)) state_.ladder.emplace_back(samples, error);
    }

    void giveUp(uint64_t samples, double error) {
        target_ = samples;
        if (options_.log)
            options_.log->warning(
                fmt::format("the error is still {:.3g} at {} samples a pixel, the most there are", error, samples));
    }

    void addTail(BlockRunner& runner) {
        const uint64_t first = wholeLeaves(target_);
        if (first == target_ || state_.tailCount > 0) return;
        if (!tracer_.traceSum({first, target_}, state_.tail, options_.stop)) {
            runner.save();
            throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
        }
        state_.tailCount = target_ - first;
    }

    void save() {
        cache_->save(state_, saved_);
        saved_ = state_.samples();
    }

    Reference result(const ReferenceState& state, bool cached) const {
        Reference reference = finishedReference(state);
        reference.cached = cached;
        if (cache_) reference.file = cache_->fileOf(state.samples());
        return reference;
    }

    const ReferenceSpec& spec_;
    const ReferenceGoal goal_;
    const ReferenceOptions& options_;
    const std::string keyText_;
    BlockTracer tracer_;
    std::optional<ReferenceCache> cache_;
    std::optional<FileLock> lock_;
    ReferenceState state_;
    uint64_t target_ = 0, resumed_ = 0;
    uint64_t saved_ = 0;  ///< samples of the file that this run resumed from or wrote last
};

}  // namespace

Reference finishedReference(const ReferenceState& state) {
    Reference reference;
    reference.samples = state.samples();
    reference.image = state.blocks.mean(state.tail, state.tailCount);
    reference.halves[0] = state.blocks.half(false);
    reference.halves[1] = state.blocks.half(true);
    reference.standardError = state.blocks.standardError(reference.samples);
    reference.error = relativeError(reference.image, reference.standardError);
    reference.depth = state.depth;
    return reference;
}

Reference makeReference(const ReferenceSpec& spec, const ReferenceGoal& goal, const ReferenceOptions& options) {
    return ReferenceRun(spec, goal, options).run();
}

}  // namespace lumi

#include "reconstruct/stable/sample_pass.h"

#include <algorithm>
#include <atomic>

#include "base/parallel.h"
#include "reconstruct/stable/sample_rays.h"
#include "trace/path_state.h"

namespace lumi {
namespace {

// A block is as wide as at density 1 as many rays as the tracer keeps together allow: samples lie in rows, and memory
// is read ahead.
constexpr int kRun = 16, kMostColumns = 16 * kRun, kRows = 4;
static_assert(SampleBatch::kMost <= PathBatch::kMost);  // a judge is asked for all starts of a batch at once
constexpr uint32_t kStream = 0x57ab1e00u;               ///< second word of the samples' keys

/// One block at a time, by one thread.
class BlockTracer {
public:
    /// `columns`: of a block.
    BlockTracer(const SamplePass& pass, int columns, const SampleRays& rays, const SampleGatherer& gatherer,
                SampleBatch& batch, VerificationCounts& counts)
        : pass_(pass), columns_(columns), rays_(rays), gatherer_(gatherer), batch_(batch), counts_(counts) {}

    /// Pixels from `left` and `top` on; false if stopped.
    bool run(int left, int top) {
        const Extent2 extent = pass_.next.extent;
        const int right = std::min(left + columns_, extent.width), bottom = std::min(top + kRows, extent.height);
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; x += kRun)
                if (!addRun(static_cast<uint32_t>(y * extent.width + x),
                            static_cast<uint32_t>(std::min(kRun, right - x))))
                    return false;
        return trace();
    }

private:
    bool addRun(uint32_t pixel, uint32_t count);
    void addPacket(std::span<const uint32_t> first, uint32_t slot, uint32_t k);
    void addStart(uint32_t slot);
    bool trace();
    void keepLight(bool anyHidden);
    void addLight(size_t slot, uint32_t i, bool still);

    const SamplePass& pass_;
    const int columns_;
    const SampleRays& rays_;
    const SampleGatherer& gatherer_;
    SampleBatch& batch_;
    VerificationCounts& counts_;
    bool anyHidden_ = false;  ///< of the batch's samples that keep their verdicts
};

/// A run of pixels of a row, 16 at most, of which each has 16 samples at most.
bool BlockTracer::addRun(uint32_t pixel, uint32_t count) {
    const uint32_t* first = pass_.next.first.data() + pixel;
    const bool dense = pass_.verification.batches == VerificationSettings::Batches::Dense;
    uint32_t most = 0;
    for (uint32_t p = 0; p < count && !dense; ++p) most = std::max(most, first[p + 1] - first[p]);
    const size_t lanes = dense ? first[count] - first[0] : most * static_cast<uint32_t>(kRun);
    const size_t samples = batch_.sampleCount + first[count] - first[0];
    if ((std::max(batch_.startCount + lanes, samples) > SampleBatch::kMost || batch_.runCount == SampleBatch::kMost) &&
        !trace())
        return false;
    const auto begin = static_cast<uint32_t>(batch_.sampleCount);
    const uint32_t ahead = pixel + 2 * kRun, pixels = static_cast<uint32_t>(pass_.next.words.size());
    if (ahead < pixels) gatherer_.prefetch(ahead, std::min<uint32_t>(kRun, pixels - ahead));
    gatherer_.gather(pixel, count);
    batch_.runs[batch_.runCount++] = {pixel, count, begin};
    for (uint32_t i = first[0]; i < first[count]; ++i) batch_.samples[batch_.sampleCount++] = i;
    if (dense) {
        const uint64_t rays = counts_.rays;
        for (uint32_t slot = begin; slot < batch_.sampleCount; ++slot) addStart(slot);
        counts_.lanes += counts_.rays - rays;
        return true;
    }
    for (uint32_t k = 0; k < most; ++k) addPacket({first, count}, begin, k);
    return true;
}

/// The k-th samples of a run's pixels: a packet with idle lanes where a pixel has fewer; none if all are idle.
void BlockTracer::addPacket(std::span<const uint32_t> first, uint32_t slot, uint32_t k) {
    const size_t before = batch_.startCount;
    const uint64_t rays = counts_.rays;
    bool any = false;
    for (size_t p = 0; p < static_cast<size_t>(kRun); ++p) {
        const size_t here = batch_.startCount;
        if (p < first.size() && first[p] + k < first[p + 1]) addStart(slot + first[p] - first[0] + k);
        any |= batch_.startCount > here;
        if (batch_.startCount > here) continue;
        PathStart& idle = batch_.starts[batch_.startCount++] = {};
        idle.slot = SampleBatch::kIdle;
        idle.ray.tmin = 1, idle.ray.tmax = 0;
    }
    if (!any) batch_.startCount = before;
    if (counts_.rays > rays) counts_.lanes += static_cast<uint64_t>(kRun);
}

/// A path for the sample: of one that keeps its verdict only if it is visible, and without a ray then.
void BlockTracer::addStart(uint32_t slot) {
    const uint32_t i = batch_.samples[slot];
    const bool verified = pass_.frame.isVerified(i);
    if (!verified && pass_.frame.verdicts[i] != Verdict::Visible) {
        anyHidden_ = true;
        return;
    }
    batch_.startOf[slot] = static_cast<uint16_t>(batch_.startCount);
    PathStart& start = batch_.starts[batch_.startCount++];
    const float distance = rays_.aim(pass_.next.locations[i], pass_.next.places[i], pass_.next.inWorld[i], start);
    batch_.distances[slot] = distance;
    start.ray.tmax = distance * (1 + pass_.verification.epsilon);
    if (!verified) start.ray.tmin = 1, start.ray.tmax = 0;
    const SampleNote& note = pass_.next.notes[i];
    start.key.x = note.name, start.key.y = kStream, start.key.sample = note.pathsDrawn;
    start.slot = slot;
    counts_.rays += verified;
}

/// All that is in the batch, which is empty then.
bool BlockTracer::trace() {
    const std::span starts(batch_.starts, batch_.startCount);
    SampleJudge judge(pass_.context, pass_.verification.epsilon, anyHidden_, batch_, pass_.frame, pass_.next);
    const PathSettings& path = pass_.context.sampling.path;
    const bool split = !pass_.next.indirect.empty();
    const std::span direct(batch_.direct, batch_.sampleCount), share(batch_.diffuseShare, batch_.sampleCount);
    if (split) std::fill(direct.begin(), direct.end(), Vec3(0)), std::fill(share.begin(), share.end(), Vec3(0));
    SplitObserver splits(direct, share);
    PathObserver* const observers[] = {&judge, &splits};
    if (starts.empty()) judge.judge({}, {}, {});
    else if (!pass_.context.tracer.tracePaths(starts, path, pass_.context.sampling.seed,
                                              {batch_.radiance, starts.size()}, std::span(observers, split ? 2 : 1),
                                              pass_.context.stop))
        return false;
    keepLight(judge.anyHidden());
    batch_.clear();
    anyHidden_ = false;
    return true;
}

void BlockTracer::keepLight(bool anyHidden) {
    const GatheringState& state = pass_.light;
    const bool still = pass_.gathering.converge && state.still;
    const bool plain = pass_.next.indirect.empty() && !pass_.averagesDirect() && !anyHidden;
    SampleNote* const notes = pass_.next.notes.data();
    for (size_t slot = 0; slot < batch_.sampleCount; ++slot) {
        const uint32_t i = batch_.samples[slot];
        const bool hidden = !plain && pass_.frame.hidden[i];
        if (state.restart || (state.lightsMoved && hidden)) notes[i].indirectCount = notes[i].directCount = 0;
        if (hidden) continue;
        ++notes[i].pathsDrawn;
        if (!plain) {
            addLight(slot, i, still);
            continue;
        }
        pass_.next.direct[i] = batch_.radiance[batch_.startOf[slot]];
        notes[i].directCount = 1;
    }
}

/// Where light is averaged, or is more than direct.
void BlockTracer::addLight(size_t slot, uint32_t i, bool still) {
    SampleNote& note = pass_.next.notes[i];
    Vec3 direct = batch_.radiance[batch_.startOf[slot]];
    const bool split = !pass_.next.indirect.empty();
    if (split) {
        const Vec3 indirect = glm::max(direct - batch_.direct[slot], Vec3(0)) * batch_.diffuseShare[slot];
        direct -= indirect;
        addToAverage(pass_.next.indirect[i], note.indirectCount, indirect, still, pass_.gathering);
    }
    if (pass_.averagesDirect()) {
        addToAverage(pass_.next.direct[i], note.directCount, direct, still, pass_.gathering);
    } else {
        pass_.next.direct[i] = direct;
        note.directCount = 1;
    }
    if (split) pass_.frame.colours[i] = pass_.next.radiance(i);
}

}  // namespace

bool traceSamples(const SamplePass& pass, VerificationCounts& counts) {
    const SampleRays rays(pass.context.camera);
    const SampleGatherer gatherer(pass.previous, pass.density, pass.random, pass.averagesDirect(), pass.frame,
                                  pass.next);
    const Extent2 extent = pass.next.extent;
    const int columns = (extent.width + kMostColumns - 1) / kMostColumns, rows = (extent.height + kRows - 1) / kRows;
    const int width = ((extent.width + columns - 1) / columns + kRun - 1) / kRun * kRun;  // of a block
    std::atomic<bool> whole{true};
    std::atomic<uint64_t> flown{0}, lanes{0};
    parallelFor(
        static_cast<int64_t>(columns) * rows,
        [&](int64_t block) {
            std::unique_ptr<SampleBatch> batch = pass.spare.take();
            batch->clear();
            VerificationCounts here;
            const int left = static_cast<int>(block % columns) * width, top = static_cast<int>(block / columns) * kRows;
            if (!BlockTracer(pass, width, rays, gatherer, *batch, here).run(left, top)) whole = false;
            flown += here.rays, lanes += here.lanes;
            pass.spare.giveBack(std::move(batch));
        },
        pass.context.stop);
    counts = {flown, lanes};
    return whole && !pass.context.stop.stop_requested();
}

}  // namespace lumi

#include "reconstruct/stable/sample_frame.h"

#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "frame/motion.h"
#include "math/hash.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;
constexpr size_t kBytesASample = sizeof(SampleLocation) + sizeof(Vec2) + sizeof(SampleLight);

uint32_t keptOf(const SampleFrame& frame, size_t pixel) {
    return subpixel::occupied(frame.reprojected.words[pixel]) & ~frame.changes[pixel].removed & ~frame.changes[pixel].added;
}

/// A new sample of sub-pixel `sub`, still to be traced.
void addNew(size_t pixel, int sub, Vec2 corner, float jitter, uint32_t random, size_t i, SampleFrame& frame, SampleSet& next) {
    const uint32_t drawn = pixelRandom(static_cast<int64_t>(pixel), random);
    next.locations[i] = {};
    next.places[i] = corner + newSamplePlace(sub, jitter, drawn);
    next.lights[i] = {};
    next.lights[i].name = hashCombine(drawn, static_cast<uint32_t>(sub));
    frame.verdicts[i] = Verdict::New;
    frame.motions[i] = Vec2(kNoPreviousPixel);
}

/// Sample `source` of the frame before.
void keep(const SampleSet& previous, uint32_t source, bool wasOccluded, size_t i, SampleFrame& frame, SampleSet& next) {
    next.locations[i] = previous.locations[source];
    next.places[i] = frame.reprojected.places[source];
    next.lights[i] = previous.lights[source];
    if (next.lights[i].age < 0xFFFF) ++next.lights[i].age;
    frame.inWorld[i] = frame.reprojected.inWorld[source];
    frame.motions[i] = previous.places[source] - next.places[i];
    frame.verdicts[i] = wasOccluded ? Verdict::Occluded : Verdict::Visible;
}

void gatherPixel(const SampleSet& previous, size_t pixel, const DensitySettings& settings, uint32_t random, SampleFrame& frame,
                 SampleSet& next) {
    const uint32_t word = frame.reprojected.words[pixel], kept = keptOf(frame, pixel), added = frame.changes[pixel].added;
    const auto width = static_cast<size_t>(next.extent.width);
    const Vec2 corner(pixel % width, pixel / width);
    next.words[pixel] = kept | added | (subpixel::occluded(word) & kept) << subpixel::kCount;
    size_t i = next.first[pixel];
    for (uint32_t bits = kept | added; bits; bits &= bits - 1, ++i) {
        const int sub = std::countr_zero(bits);
        if (added & subpixel::bit(sub)) {
            addNew(pixel, sub, corner, settings.jitter, random, i, frame, next);
            continue;
        }
        const auto rank = static_cast<size_t>(subpixel::rank(subpixel::occupied(word), sub));
        keep(previous, frame.reprojected.sources[frame.reprojected.first[pixel] + rank], subpixel::occluded(word) & subpixel::bit(sub), i,
             frame, next);
    }
}

/// Where the samples of each pixel begin; returns how many there are.
uint32_t numberSamples(SampleFrame& frame, SampleSet& next) {
    const size_t pixels = frame.reprojected.words.size();
    constexpr size_t kChunk = 1 << 14;
    next.words.resize(pixels);
    next.first.resize(pixels + 1);
    frame.chunkSums.resize(pixels / kChunk + 1);
    // Within chunks first, then all of a chunk by what lies before it.
    parallelRanges(static_cast<int64_t>(pixels), kChunk, [&](int64_t begin, int64_t end) {
        uint32_t sum = 0;
        for (auto pixel = static_cast<size_t>(begin); pixel < static_cast<size_t>(end); ++pixel) {
            next.first[pixel] = sum;
            sum += static_cast<uint32_t>(std::popcount(keptOf(frame, pixel) | frame.changes[pixel].added));
        }
        frame.chunkSums[static_cast<size_t>(begin) / kChunk] = sum;
    });
    uint32_t sum = 0;
    for (size_t chunk = 0; chunk * kChunk < pixels; ++chunk) sum += std::exchange(frame.chunkSums[chunk], sum);
    parallelRanges(static_cast<int64_t>(pixels), kChunk, [&](int64_t begin, int64_t end) {
        for (auto pixel = static_cast<size_t>(begin); pixel < static_cast<size_t>(end); ++pixel)
            next.first[pixel] += frame.chunkSums[static_cast<size_t>(begin) / kChunk];
    });
    next.first[pixels] = sum;
    return sum;
}

}  // namespace

size_t SampleFrame::bytes() const {
    const size_t aSample = sizeof(Vec3) * 2 + sizeof(Vec2) + sizeof(SampleLocation) + 2;
    return inWorld.size() * aSample + changes.size() * sizeof(PixelChange) + reprojected.bytes() + chunkSums.size() * 4 + list.bytes();
}

void gatherSamples(const SampleSet& previous, const DensitySettings& settings, uint32_t random, SampleFrame& frame, SampleSet& next) {
    const uint32_t sum = numberSamples(frame, next);
    const size_t more = sum > next.locations.capacity() ? sum - next.locations.capacity() : 0;
    if (more > 0) checkMemory("the samples of stable ray tracing", more * kBytesASample);
    next.locations.resize(sum), next.places.resize(sum), next.lights.resize(sum);
    frame.inWorld.resize(sum), frame.motions.resize(sum), frame.verdicts.resize(sum);
    frame.hidden.resize(sum), frame.colours.resize(sum);
    frame.blockers.assign(sum, {});
    parallelRanges(next.extent.height, kRows, [&](int64_t begin, int64_t end) {
        const auto width = static_cast<size_t>(next.extent.width);
        for (size_t pixel = static_cast<size_t>(begin) * width; pixel < static_cast<size_t>(end) * width; ++pixel)
            gatherPixel(previous, pixel, settings, random, frame, next);
    });
}

}  // namespace lumi

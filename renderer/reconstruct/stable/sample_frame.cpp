#include "reconstruct/stable/sample_batch.h"

#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"

namespace lumi {
namespace {

constexpr size_t kBytesASample = sizeof(SampleLocation) + sizeof(Vec2) + sizeof(SampleLight);

uint32_t keptOf(const SampleFrame& frame, size_t pixel) {
    return subpixel::occupied(frame.reprojected.words[pixel]) & ~frame.changes[pixel].removed & ~frame.changes[pixel].added;
}

/// Where the samples of each pixel begin; returns how many there are.
uint32_t beginPixels(SampleFrame& frame, SampleSet& next) {
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
            sum += subpixel::count(keptOf(frame, pixel) | frame.changes[pixel].added);
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
    return colours.size() * (sizeof(Vec3) + 2) + motions.size() * sizeof(Vec2) + changes.size() * sizeof(PixelChange) + reprojected.bytes() + chunkSums.size() * 4;
}

void numberSamples(SampleFrame& frame, SampleSet& next) {
    const uint32_t sum = beginPixels(frame, next);
    const size_t more = sum > next.locations.capacity() ? sum - next.locations.capacity() : 0;
    if (more > 0) checkMemory("the samples of stable ray tracing", more * kBytesASample);
    next.locations.resize(sum), next.places.resize(sum), next.lights.resize(sum);
    frame.motions.resize(frame.wantsMotions ? sum : 0), frame.verdicts.resize(sum);
    frame.hidden.resize(sum), frame.colours.resize(sum);
}

SampleGatherer::SampleGatherer(const SampleSet& previous, const DensitySettings& settings, uint32_t random, SampleFrame& frame, SampleSet& next)
    : jitter_(settings.jitter), random_(random), width_(static_cast<uint32_t>(next.extent.width)),
      reprojectedWords_(frame.reprojected.words.data()), reprojectedFirst_(frame.reprojected.first.data()),
      sources_(frame.reprojected.sources.data()), changes_(frame.changes.data()), oldLocations_(previous.locations.data()),
      oldLights_(previous.lights.data()), oldPlaces_(previous.places.data()), newPlaces_(frame.reprojected.places.data()),
      inWorld_(frame.reprojected.inWorld.data()), first_(next.first.data()), words_(next.words.data()),
      locations_(next.locations.data()), places_(next.places.data()), lights_(next.lights.data()),
      motions_(frame.wantsMotions ? frame.motions.data() : nullptr), verdicts_(frame.verdicts.data()), hidden_(frame.hidden.data()),
      colours_(frame.colours.data()) {}

void SampleGatherer::prefetch(uint32_t pixel) const {
    const uint32_t count = subpixel::count(subpixel::occupied(reprojectedWords_[pixel]));
    for (uint32_t k = 0; k < count; ++k) {
        const uint32_t source = sources_[reprojectedFirst_[pixel] + k], i = first_[pixel] + k;
        __builtin_prefetch(oldLights_ + source);
        __builtin_prefetch(oldLocations_ + source);
        __builtin_prefetch(newPlaces_ + source);
        __builtin_prefetch(inWorld_ + source);
        __builtin_prefetch(lights_ + i, 1);
        __builtin_prefetch(locations_ + i, 1);
        __builtin_prefetch(places_ + i, 1);
        __builtin_prefetch(colours_ + i, 1);
    }
}

void SampleGatherer::gather(uint32_t pixel, SampleBatch& batch) const {
    const uint32_t word = reprojectedWords_[pixel], added = changes_[pixel].added;
    const uint32_t kept = subpixel::occupied(word) & ~changes_[pixel].removed & ~added;
    words_[pixel] = kept | added;
    if (!(kept | added)) return;
    uint32_t i = first_[pixel];
    size_t slot = batch.sampleCount;
    batch.pixels[batch.pixelCount++] = {pixel, static_cast<uint32_t>(slot)};
    const uint32_t* sources = sources_ + reprojectedFirst_[pixel];
    for (uint32_t bits = kept | added; bits; bits &= bits - 1, ++i, ++slot) {
        const uint32_t bit = bits & (~bits + 1);
        batch.samples[slot] = i;
        hidden_[i] = 0;
        if (added & bit) {
            addNew(pixel, std::countr_zero(bits), i);
            continue;
        }
        const uint32_t source = sources[subpixel::count(subpixel::occupied(word) & (bit - 1))];
        locations_[i] = oldLocations_[source];
        places_[i] = newPlaces_[source];
        lights_[i] = oldLights_[source];
        if (lights_[i].age < 0xFFFF) ++lights_[i].age;
        if (motions_) motions_[i] = oldPlaces_[source] - newPlaces_[source];
        verdicts_[i] = subpixel::occluded(word) & bit ? Verdict::Occluded : Verdict::Visible;
        batch.inWorld[slot] = inWorld_[source];
    }
    batch.sampleCount = slot;
}

/// A new sample of sub-pixel `sub`, still to be traced.
void SampleGatherer::addNew(uint32_t pixel, int sub, size_t i) const {
    const uint32_t drawn = pixelRandom(pixel, random_);
    locations_[i] = {};
    places_[i] = Vec2(pixel % width_, pixel / width_) + newSamplePlace(sub, jitter_, drawn);
    lights_[i] = {};
    lights_[i].name = hashCombine(drawn, static_cast<uint32_t>(sub));
    verdicts_[i] = Verdict::New;
}

}  // namespace lumi

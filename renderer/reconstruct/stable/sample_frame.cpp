#include "reconstruct/stable/sample_frame.h"

#include <algorithm>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"

namespace lumi {
namespace {

uint32_t samplesOf(const SampleFrame& frame, size_t pixel) {
    const PixelChange& change = frame.changes[pixel];
    return subpixel::count((subpixel::occupied(frame.reprojected.words[pixel]) & ~change.removed) | change.added);
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
            sum += samplesOf(frame, pixel);
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

/// to[k] = from[sources[k]].
template <class T>
void copyFrom(const T* from, const uint32_t* sources, T* to, size_t count) {
    for (size_t k = 0; k < count; ++k) to[k] = from[sources[k]];
}

}  // namespace

size_t SampleFrame::bytes() const {
    return heldBytes(colours) + heldBytes(verdicts) + heldBytes(hidden) + heldBytes(motions) + heldBytes(changes) +
           heldBytes(chunkSums) + reprojected.bytes();
}

void numberSamples(SampleFrame& frame, bool withIndirect, SampleSet& next) {
    const uint32_t sum = beginPixels(frame, next);
    if (sum > next.locations.capacity())
        checkMemory("the samples of stable ray tracing",
                    (sum + sum / 8) * (SampleSet::bytesASample(withIndirect) + SampleFrame::kBytesASample));
    next.resize(sum, withIndirect);
    resizeAnew(frame.motions, frame.wantsMotions ? sum : 0), resizeAnew(frame.verdicts, sum);
    resizeAnew(frame.hidden, sum), resizeAnew(frame.colours, withIndirect ? sum : 0);
}

SampleGatherer::SampleGatherer(const SampleSet& previous, const DensitySettings& settings, uint32_t random,
                               bool keepsDirect, SampleFrame& frame, SampleSet& next)
    : jitter_(settings.jitter),
      random_(random),
      width_(static_cast<uint32_t>(next.extent.width)),
      reprojectedWords_(frame.reprojected.words.data()),
      reprojectedFirst_(frame.reprojected.first.data()),
      sources_(frame.reprojected.sources.data()),
      changes_(frame.changes.data()),
      oldLocations_(previous.locations.data()),
      oldInWorld_((frame.reprojected.moved.empty() ? previous.inWorld : frame.reprojected.moved).data()),
      oldDirect_(keepsDirect ? previous.direct.data() : nullptr),
      oldIndirect_(previous.indirect.empty() ? nullptr : previous.indirect.data()),
      oldNotes_(previous.notes.data()),
      oldFlags_(previous.flags.data()),
      oldPlaces_(previous.places.data()),
      newPlaces_(frame.reprojected.places.data()),
      first_(next.first.data()),
      words_(next.words.data()),
      locations_(next.locations.data()),
      inWorld_(next.inWorld.data()),
      direct_(next.direct.data()),
      indirect_(next.indirect.empty() ? nullptr : next.indirect.data()),
      places_(next.places.data()),
      flags_(next.flags.data()),
      notes_(next.notes.data()),
      motions_(frame.wantsMotions ? frame.motions.data() : nullptr),
      verdicts_(frame.verdicts.data()),
      hidden_(frame.hidden.data()) {}

void SampleGatherer::prefetch(uint32_t pixel, uint32_t count) const {
    const uint32_t last = pixel + count - 1;
    const uint32_t end = reprojectedFirst_[last] + subpixel::count(subpixel::occupied(reprojectedWords_[last]));
    for (uint32_t k = reprojectedFirst_[pixel]; k < end; k += 4) {
        const uint32_t source = sources_[k];
        __builtin_prefetch(oldLocations_ + source);
        __builtin_prefetch(oldNotes_ + source);
        __builtin_prefetch(oldInWorld_ + source);
        __builtin_prefetch(newPlaces_ + source);
        if (oldIndirect_) __builtin_prefetch(oldIndirect_ + source);
    }
    for (uint32_t i = first_[pixel]; i < first_[pixel + count]; i += 4) {
        __builtin_prefetch(locations_ + i, 1);
        __builtin_prefetch(notes_ + i, 1);
        __builtin_prefetch(inWorld_ + i, 1);
        __builtin_prefetch(places_ + i, 1);
        __builtin_prefetch(direct_ + i, 1);
    }
}

void SampleGatherer::gather(uint32_t pixel, uint32_t count) const {
    // Most pixels keep what they have: their samples follow each other.
    const uint32_t end = pixel + count;
    for (uint32_t begin = pixel; begin < end;) {
        if ((changes_[begin].added | changes_[begin].removed) != 0) {
            gatherChanged(begin++);
            continue;
        }
        uint32_t next = begin;
        for (; next < end && (changes_[next].added | changes_[next].removed) == 0; ++next)
            words_[next] = subpixel::occupied(reprojectedWords_[next]);
        const uint32_t* source = sources_ + reprojectedFirst_[begin];
        keep(source, first_[begin], first_[next] - first_[begin]);
        begin = next;
    }
}

/// One that loses samples or gets new ones.
void SampleGatherer::gatherChanged(uint32_t pixel) const {
    const uint32_t occupied = subpixel::occupied(reprojectedWords_[pixel]), added = changes_[pixel].added;
    const uint32_t all = (occupied & ~changes_[pixel].removed) | added;
    words_[pixel] = all;
    const uint32_t* source = sources_ + reprojectedFirst_[pixel];
    size_t i = first_[pixel];
    for (uint32_t bits = occupied | all; bits; bits &= bits - 1) {
        const uint32_t bit = bits & (~bits + 1);
        const uint32_t* const here = occupied & bit ? source++ : nullptr;
        if (added & bit) addNew(pixel, std::countr_zero(bit), i++);
        else if (all & bit) keep(here, i++, 1);
    }
}

/// Samples of the frame before, which follow each other in this one. A loop for each thing that is known of them: in
/// one for all every pointer would be read again after each byte that is written, for it may lie anywhere.
void SampleGatherer::keep(const uint32_t* sources, size_t begin, size_t count) const {
    copyFrom(oldLocations_, sources, locations_ + begin, count);
    copyFrom(oldInWorld_, sources, inWorld_ + begin, count);
    copyFrom(newPlaces_, sources, places_ + begin, count);
    copyFrom(oldFlags_, sources, flags_ + begin, count);
    if (oldDirect_) copyFrom(oldDirect_, sources, direct_ + begin, count);
    if (indirect_ && oldIndirect_) copyFrom(oldIndirect_, sources, indirect_ + begin, count);
    else if (indirect_) std::fill_n(indirect_ + begin, count, Vec3(0));
    keepNotes(sources, notes_ + begin, count);
    if (motions_)
        for (size_t k = 0; k < count; ++k) motions_[begin + k] = oldPlaces_[sources[k]] - newPlaces_[sources[k]];
    uint8_t* const flags = flags_ + begin;
    Verdict* const verdicts = verdicts_ + begin;
    for (size_t k = 0; k < count; ++k)
        verdicts[k] = flags[k] & SampleSet::kOccluded ? Verdict::Occluded : Verdict::Visible;
    for (size_t k = 0; k < count; ++k) flags[k] &= static_cast<uint8_t>(~SampleSet::kOccluded);
    std::fill_n(hidden_ + begin, count, uint8_t{0});
}

void SampleGatherer::keepNotes(const uint32_t* sources, SampleNote* notes, size_t count) const {
    const SampleNote* const old = oldNotes_;
    const bool keepsDirect = oldDirect_, keepsIndirect = oldIndirect_;
    for (size_t k = 0; k < count; ++k) {
        SampleNote note = old[sources[k]];
        note.age = static_cast<uint16_t>(note.age + (note.age < 0xFFFF));
        if (!keepsDirect) note.directCount = 0;
        if (!keepsIndirect) note.indirectCount = 0;
        notes[k] = note;
    }
}

/// A new sample of sub-pixel `sub`, still to be traced.
void SampleGatherer::addNew(uint32_t pixel, int sub, size_t i) const {
    const uint32_t drawn = pixelRandom(pixel, random_);
    locations_[i] = {};
    places_[i] = Vec2(pixel % width_, pixel / width_) + newSamplePlace(sub, jitter_, drawn);
    notes_[i] = {};
    notes_[i].name = hashCombine(drawn, static_cast<uint32_t>(sub));
    if (indirect_) indirect_[i] = Vec3(0);
    direct_[i] = Vec3(0);
    verdicts_[i] = Verdict::New;
    flags_[i] = hidden_[i] = 0;
}

}  // namespace lumi

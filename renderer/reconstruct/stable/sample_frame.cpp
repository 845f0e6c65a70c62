#include "reconstruct/stable/sample_frame.h"

#include "base/parallel.h"
#include "frame/motion.h"
#include "math/hash.h"

namespace lumi {
namespace {

constexpr int64_t kRows = 8;

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
        frame.pixelOf[i] = static_cast<uint32_t>(pixel);
        if (added & subpixel::bit(sub)) {
            addNew(pixel, sub, corner, settings.jitter, random, i, frame, next);
            continue;
        }
        const auto rank = static_cast<size_t>(subpixel::rank(subpixel::occupied(word), sub));
        keep(previous, frame.reprojected.sources[frame.reprojected.first[pixel] + rank], subpixel::occluded(word) & subpixel::bit(sub), i,
             frame, next);
    }
}

}  // namespace

size_t SampleFrame::bytes() const {
    const size_t a = inWorld.size();
    return a * (sizeof(Vec3) * 2 + sizeof(Vec2) + 2) + changes.size() * sizeof(PixelChange) + reprojected.bytes() +
           blockers.size() * sizeof(SampleLocation) + pixelOf.size() * 4;
}

void gatherSamples(const SampleSet& previous, const DensitySettings& settings, uint32_t random, SampleFrame& frame, SampleSet& next) {
    const size_t pixels = frame.reprojected.words.size();
    next.words.resize(pixels);
    next.first.resize(pixels);
    uint32_t sum = 0;
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
        next.first[pixel] = sum;
        sum += static_cast<uint32_t>(std::popcount(keptOf(frame, pixel) | frame.changes[pixel].added));
    }
    next.first.push_back(sum);
    next.locations.resize(sum), next.places.resize(sum), next.lights.resize(sum);
    frame.inWorld.resize(sum), frame.motions.resize(sum), frame.verdicts.resize(sum);
    frame.hidden.resize(sum), frame.colours.resize(sum), frame.pixelOf.resize(sum);
    frame.blockers.assign(sum, {});
    parallelRanges(next.extent.height, kRows, [&](int64_t begin, int64_t end) {
        const auto width = static_cast<size_t>(next.extent.width);
        for (size_t pixel = static_cast<size_t>(begin) * width; pixel < static_cast<size_t>(end) * width; ++pixel)
            gatherPixel(previous, pixel, settings, random, frame, next);
    });
}

}  // namespace lumi

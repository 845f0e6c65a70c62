#pragma once
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/sample_set.h"

namespace lumi {

struct SampleBatch;

/// What the visibility ray to a sample found.
enum class Verdict : uint8_t {
    New,       ///< the sample was traced in this frame
    Visible,   ///< nothing in the way
    Occluded,  ///< kept, but not shaded
    Replaced,  ///< it was the last of its pixel and occluded: it has moved to what occludes it
    Missed     ///< its surface is not where it was: evicted
};

/// A frame's samples while they are worked on: beside their set what is not kept, a value a sample.
struct SampleFrame {
    bool wantsMotions = false;
    std::vector<Vec2> motions;       ///< previous minus current place, of visible samples; empty if not wanted
    std::vector<Verdict> verdicts;
    std::vector<uint8_t> hidden;     ///< 1: plays no part in the image
    std::vector<Vec3> colours;       ///< scene-linear

    std::vector<PixelChange> changes;  ///< a pixel
    ReprojectedSamples reprojected;
    std::vector<uint32_t> chunkSums;  ///< of numberSamples()
    bool newOnly = false;             ///< nothing has changed: older samples keep their verdicts

    bool isVerified(uint32_t i) const { return !newOnly || verdicts[i] == Verdict::New; }
    size_t bytes() const;
};

/// Makes room for the samples of the frame: those of the frame before that reprojection and analysis kept, and the new ones.
/// Sets `first`. Throws Error(Resources) if they would pass the memory limit.
void numberSamples(SampleFrame& frame, SampleSet& next);

/// Makes the samples of a frame, pixel by pixel and any pixels at a time: those of `previous` that stay, in their new
/// places, and the new ones, whose location is still to be found.
class SampleGatherer {
public:
    /// `frame`: numbered. `random` names the frame.
    SampleGatherer(const SampleSet& previous, const DensitySettings& settings, uint32_t random, SampleFrame& frame, SampleSet& next);
    /// Asks memory for what gather() is going to need.
    void prefetch(uint32_t pixel) const;
    /// The samples of a pixel and its word, in which none is occluded yet; adds them to `batch`.
    void gather(uint32_t pixel, SampleBatch& batch) const;

private:
    void addNew(uint32_t pixel, int sub, size_t i) const;

    const float jitter_;
    const uint32_t random_, width_;
    // Bare pointers, which the compiler does not read again after each value that is written.
    const uint32_t *reprojectedWords_, *reprojectedFirst_, *sources_;
    const PixelChange* changes_;
    const SampleLocation* oldLocations_;
    const SampleLight* oldLights_;
    const Vec2 *oldPlaces_, *newPlaces_;
    const Vec3* inWorld_;
    const uint32_t* first_;
    uint32_t* words_;
    SampleLocation* locations_;
    Vec2* places_;
    SampleLight* lights_;
    Vec2* motions_;  ///< null if not wanted
    Verdict* verdicts_;
    uint8_t* hidden_;
    Vec3* colours_;
};

}  // namespace lumi

#pragma once
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/sample_set.h"
#include "reconstruct/stable/tile_order.h"

namespace lumi {

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
    std::vector<Vec3> inWorld;       ///< world position, or direction into the sky; undefined for new ones before verification
    std::vector<Vec2> motions;       ///< previous minus current place; far off the image where there was none
    std::vector<Verdict> verdicts;
    std::vector<uint8_t> hidden;     ///< 1: plays no part in the image
    std::vector<Vec3> colours;       ///< scene-linear

    std::vector<PixelChange> changes;  ///< a pixel
    ReprojectedSamples reprojected;
    std::vector<SampleLocation> blockers;  ///< of occluded samples
    std::vector<uint32_t> chunkSums;       ///< of gatherSamples()
    TileList list;                         ///< of samples to verify, then to shade
    bool newOnly = false;                  ///< nothing has changed: older samples keep their verdicts

    bool isVerified(uint32_t i) const { return !newOnly || verdicts[i] == Verdict::New; }
    size_t bytes() const;
};

/// Makes the samples of the frame: those of `previous` that reprojection and analysis kept, in their new places, and the
/// new ones, whose location is still to be found. `random` names the frame. Throws Error(Resources) if they would pass the
/// memory limit.
void gatherSamples(const SampleSet& previous, const DensitySettings& settings, uint32_t random, SampleFrame& frame, SampleSet& next);

}  // namespace lumi

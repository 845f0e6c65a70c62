#pragma once
#include "reconstruct/stable/analysis.h"
#include "reconstruct/stable/reproject_samples.h"
#include "reconstruct/stable/sample_set.h"

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
    bool wantsMotions = false;
    std::vector<Vec2> motions;  ///< previous minus current place, of visible samples; empty if not wanted
    std::vector<Verdict> verdicts;
    std::vector<uint8_t> hidden;  ///< 1: plays no part in the image
    std::vector<Vec3> colours;    ///< scene-linear; empty: the set's direct light is all

    std::vector<PixelChange> changes;  ///< a pixel
    ReprojectedSamples reprojected;
    std::vector<uint32_t> chunkSums;  ///< of numberSamples()
    bool newOnly = false;             ///< nothing has changed: older samples keep their verdicts

    static constexpr size_t kBytesASample =
        sizeof(Vec2) + sizeof(Verdict) + 1 + sizeof(Vec3) + ReprojectedSamples::kBytesASample;

    bool isVerified(uint32_t i) const { return !newOnly || verdicts[i] == Verdict::New; }
    size_t bytes() const;
};

/// Makes room for the samples of the frame: those of the frame before that reprojection and analysis kept, and the new
/// ones. Sets `first`. `withIndirect`: they gather indirect light. Throws Error(Resources) if they would pass the
/// memory limit.
void numberSamples(SampleFrame& frame, bool withIndirect, SampleSet& next);

/// Makes the samples of a frame, some pixels at a time: those of `previous` that stay, in their new places, and the new
/// ones, whose location is still to be found.
class SampleGatherer {
public:
    /// `frame`: numbered. `random` names the frame; `keepsDirect`: direct light is averaged.
    SampleGatherer(const SampleSet& previous, const DensitySettings& settings, uint32_t random, bool keepsDirect,
                   SampleFrame& frame, SampleSet& next);
    /// Asks memory for what gather() is going to need of neighbouring pixels of a row.
    void prefetch(uint32_t pixel, uint32_t count) const;
    /// The samples of neighbouring pixels of a row and their words, in which none is occluded yet.
    void gather(uint32_t pixel, uint32_t count) const;

private:
    void gatherChanged(uint32_t pixel) const;
    void addNew(uint32_t pixel, int sub, size_t i) const;
    void keep(const uint32_t* sources, size_t begin, size_t count) const;
    void keepNotes(const uint32_t* sources, SampleNote* notes, size_t count) const;

    const float jitter_;
    const uint32_t random_, width_;
    // Bare pointers, which the compiler does not read again after each value that is written.
    const uint32_t *reprojectedWords_, *reprojectedFirst_, *sources_;
    const PixelChange* changes_;
    const SampleLocation* oldLocations_;
    const Vec3 *oldInWorld_, *oldDirect_, *oldIndirect_;  ///< light: null if it is not kept
    const SampleNote* oldNotes_;
    const uint8_t* oldFlags_;
    const Vec2 *oldPlaces_, *newPlaces_;
    const uint32_t* first_;
    uint32_t* words_;
    SampleLocation* locations_;
    Vec3 *inWorld_, *direct_, *indirect_;  ///< indirect: null if there is none
    Vec2* places_;
    uint8_t* flags_;
    SampleNote* notes_;
    Vec2* motions_;  ///< null if not wanted
    Verdict* verdicts_;
    uint8_t* hidden_;
};

}  // namespace lumi

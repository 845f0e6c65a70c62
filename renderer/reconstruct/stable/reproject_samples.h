#pragma once
#include "reconstruct/module.h"
#include "reconstruct/stable/sample_set.h"

namespace lumi {

struct ProjectionRow;

/// Where the samples of the frame before have gone [DalCorso17, sec. 4.1].
struct ReprojectedSamples {
    std::vector<uint32_t> words;  ///< a pixel of this frame: occupancy, and occlusion as it was in the frame before
    std::vector<uint32_t> first;  ///< a pixel: where in `sources` its samples begin; those of a pixel follow each other
    std::vector<uint32_t> sources;  ///< index in the frame before, in the order of a pixel's sub-pixels
    std::vector<Vec2> places;       ///< of each sample of the frame before on this frame's screen
    std::vector<Vec3>
        moved;  ///< where they are in the world, if they may be elsewhere than in the frame before; else empty

    // Scratch, kept for its memory.
    std::vector<uint32_t> targets;  ///< of each sample: 16 * column + sub-pixel, with kOccluded if it was
    std::vector<uint32_t> rows;     ///< that each lands in; of those that land nowhere the number of rows
    std::vector<uint32_t> order;    ///< samples by the row they land in
    std::vector<uint32_t> counts;   ///< of each part of the samples in each row
    static constexpr uint32_t kOccluded = 1u << 31;
    static constexpr size_t kBytesASample = sizeof(Vec2) + sizeof(Vec3) + 4 * sizeof(uint32_t);
    size_t bytes() const {
        return heldBytes(words) + heldBytes(first) + heldBytes(sources) + heldBytes(places) + heldBytes(moved) +
               heldBytes(targets) + heldBytes(rows) + heldBytes(order) + heldBytes(counts);
    }
};

/// Projects every sample of `previous` to where its surface point is now and stores it there by Algorithm 1, in the
/// order in which the samples lie, so that which of two stays never depends on threads. Samples off the image, behind
/// the camera, of surfaces that the scene no longer has or that have shrunk to nothing a number can name are dropped.
/// Where nothing has changed since the frame before samples stay in their places, to the bit; where only the camera or
/// the light has, they stay where they were in the world. Returns false if stopped.
bool reprojectSamples(const FrameContext& context, const SampleSet& previous, ReprojectedSamples& out);

/// World position of a surface sample, or the unit direction of one in the sky.
Vec3 placeInWorld(const Tracer& tracer, const SampleLocation& location);

/// Where a camera sees samples. Its lens and shutter play no part.
class ScreenPlaces {
public:
    explicit ScreenPlaces(const CameraPose& camera);
    /// Continuous pixel and view depth, m (of the sky: of its unit direction); false if the sample is not on the
    /// screen.
    bool find(const SampleLocation& location, const Vec3& inWorld, Vec2& place, float& depth) const;
    /// The same for many samples at a time: fills in what projectionKernels() ask of the camera.
    void describe(ProjectionRow& row) const;

private:
    Mat4 view_;
    Vec2 centre_, size_;  ///< pixels
    float inverseSize_;   ///< pixels a metre at depth 1
    bool perspective_;
};

}  // namespace lumi

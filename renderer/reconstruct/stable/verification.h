#pragma once
#include "reconstruct/stable/sample_frame.h"
#include "trace/tracer.h"

namespace lumi {

/// How samples are verified [DalCorso17, sec. 4.3].
struct VerificationSettings {
    /// What rays are traced together. Dense: the samples of all pixels in one list without gaps, tile after tile, the load
    /// balancing that sec. 7 of the paper expects a gain from. PerPixel: as the paper, each pixel goes through its own
    /// samples; packets are the k-th samples of 16 pixels and have idle lanes where a pixel has fewer.
    enum class Batches { Dense, PerPixel };

    float epsilon = 1e-4f;  ///< how far off a hit may be, in parts of the sample's distance
    Batches batches = Batches::Dense;

    void describe(ParameterVisitor& v);
};

/// What verification did.
struct VerificationCounts {
    uint64_t rays = 0;   ///< that were traced
    uint64_t lanes = 0;  ///< of their packets, idle ones included
};

/// Traces a ray to each sample: new ones to whatever they meet, others up to where they should be; sets verdicts, the
/// words' occlusion, and the locations, positions and motions of samples that are new or have moved to what occludes
/// them. Where nothing has changed since the frame before the verdicts of then stand and only new samples are traced.
/// A sample that was missed keeps its bits until the next reprojection drops it; it is hidden and counts as occluded.
/// Returns false if stopped.
bool verifySamples(const FrameContext& context, const VerificationSettings& settings, SampleFrame& frame, SampleSet& set,
                   VerificationCounts& counts);

/// The camera as samples are seen: without lens and shutter.
CameraPose pinhole(const CameraPose& camera);

/// The ray that goes to a sample whose location is known, or through the place of a new one, with its footprint;
/// `distance` is that of the sample, infinite for new ones and the sky.
PathStart rayToSample(const CameraPose& pinhole, const SampleLocation& location, Vec2 place, const Vec3& inWorld, float& distance);

}  // namespace lumi

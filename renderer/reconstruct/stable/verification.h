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

    static constexpr float kEpsilon = 1e-4f;
    float epsilon = kEpsilon;  ///< how far off a hit may be, in parts of the sample's distance
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
/// them. With frame.newOnly only new samples are traced, and all others keep the verdicts that they come with.
/// A sample that was missed keeps its bits until the next reprojection drops it; it is hidden and counts as occluded.
/// A sample's name draws which blended surfaces its rays pass, so that the draw lasts its life.
/// Returns false if stopped.
bool verifySamples(const FrameContext& context, const VerificationSettings& settings, SampleFrame& frame, SampleSet& set,
                   VerificationCounts& counts);

/// Does `hit` of the ray along unit `direction` to a sample find it? `distance` is that of the sample. A hit on its
/// triangle does, wherever the ray meets it; on any other surface it may be off by `epsilon` of the distance. The bodies of
/// lights are convex: of the points of one that lie behind each other the ray meets that which faces it.
bool findsSample(const Tracer& tracer, const SampleLocation& location, const Vec3& direction, const Hit& hit, float distance, float epsilon);

/// The camera as samples are seen: without lens and shutter.
CameraPose pinhole(const CameraPose& camera);

/// The ray that goes to a sample whose location is known, or through the place of a new one, with its footprint;
/// `distance` is that of the sample, infinite for new ones and the sky.
PathStart rayToSample(const CameraPose& pinhole, const SampleLocation& location, Vec2 place, const Vec3& inWorld, float& distance);

}  // namespace lumi

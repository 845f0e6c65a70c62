#pragma once
#include "reconstruct/stable/sample_batch.h"
#include "trace/first_hit_judge.h"

namespace lumi {

/// How samples are verified [DalCorso17, sec. 4.3].
struct VerificationSettings {
    /// What rays are traced together. Dense: the samples of a block of pixels in one list without gaps, block after
    /// block, the load balancing that sec. 7 of the paper expects a gain from. PerPixel: as the paper, each pixel goes
    /// through its own samples; packets are the k-th samples of 16 pixels and have idle lanes where a pixel has fewer.
    enum class Batches { Dense, PerPixel };

    static constexpr float kEpsilon = 1e-4f;
    float epsilon = kEpsilon;  ///< how far off a hit may be, in parts of the sample's distance
    Batches batches = Batches::Dense;

    void describe(ParameterVisitor& v);
};

/// Verifies the samples of a batch by what their rays meet: new ones are whatever that is, others should be there. Sets
/// verdicts, the words' occlusion, and the locations and motions of samples that are new or have moved to what occludes
/// them. With frame.newOnly only new samples are verified, and all others keep the verdicts that they come with.
/// A sample that was missed keeps its bits until the next reprojection drops it; it is hidden and counts as occluded.
/// A sample's name draws which blended surfaces its rays pass, so that the draw lasts its life.
/// The paths of visible samples go on from their locations.
class SampleJudge : public FirstHitJudge {
public:
    /// `anyHidden`: samples that keep their verdict are hidden. As they come none is marked so, nor occluded in the
    /// words.
    SampleJudge(const FrameContext& context, float epsilon, bool anyHidden, const SampleBatch& batch,
                SampleFrame& frame, SampleSet& set)
        : context_(context), epsilon_(epsilon), anyHidden_(anyHidden), batch_(batch), frame_(frame), set_(set) {}
    void nameRays(std::span<const PathStart> starts, std::span<uint32_t> ids) const override;
    void judge(std::span<const PathStart> starts, std::span<Hit> hits, std::span<uint8_t> goesOn) override;
    /// Is any sample of the batch hidden?
    bool anyHidden() const { return anyHidden_; }

private:
    void verify(const PathStart& start, Hit& hit);
    void locate(const Ray& ray, const Hit& hit, uint32_t sample);
    void settle(uint32_t pixel, uint32_t slot, std::span<Hit> hits);
    void evict(uint32_t sample);
    void replace(uint32_t sample, const Hit& blocker);

    const FrameContext& context_;
    const float epsilon_;
    bool anyHidden_;
    const SampleBatch& batch_;
    SampleFrame& frame_;
    SampleSet& set_;
};

/// Does `hit` of the ray along unit `direction` to a sample find it? `distance` is that of the sample. A hit on its
/// triangle does, wherever the ray meets it; on any other surface it may be off by `epsilon` of the distance. The
/// bodies of lights are convex: of the points of one that lie behind each other the ray meets that which faces it.
bool findsSample(const Tracer& tracer, const SampleLocation& location, const Vec3& direction, const Hit& hit,
                 float distance, float epsilon);

}  // namespace lumi

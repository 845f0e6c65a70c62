#pragma once
#include "reconstruct/stable/sample_frame.h"
#include "trace/observer.h"

namespace lumi {

/// How samples gather light [DalCorso17, sec. 6.1].
struct GatheringSettings {
    float indirectAlpha = 0.1f;  ///< weight of a new path in the average, once it has 1/alpha of them
    bool averageDirect = false;  ///< direct light goes into the same average
    bool converge = true;        ///< while nothing changes all is an arithmetic mean

    void describe(ParameterVisitor& v);
};

/// Traces one path from each visible sample on: direct light is that of this frame, indirect light an exponential
/// average over the sample's life; while nothing changes both are arithmetic means. Sets lights and colours.
/// Returns false if stopped.
bool shadeSamples(const FrameContext& context, const GatheringSettings& settings, SampleFrame& frame, SampleSet& set);

/// Adds the light of one more path to what a sample has gathered. `still`: nothing has changed since the frame before.
void gather(SampleLight& light, const Vec3& direct, const Vec3& indirect, bool still, const GatheringSettings& settings);

/// Paths of one sample a slot, split into light that met at most one surface and all else.
class DirectObserver : public PathObserver {
public:
    explicit DirectObserver(std::span<Vec3> direct) : direct_(direct) {}
    ObserverNeeds needs() const override { return {2, 0, 0, 0, false}; }
    void bounce(const BounceBatch& batch) override;

private:
    std::span<Vec3> direct_;  ///< by slot
};

}  // namespace lumi

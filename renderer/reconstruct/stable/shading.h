#pragma once
#include "params/parameter.h"
#include "reconstruct/stable/sample_set.h"
#include "trace/observer.h"

namespace lumi {

/// How samples gather light [DalCorso17, sec. 6.1]: one path a frame each. Light that does not depend on the view,
/// diffuse and indirect, is an exponential average over the sample's life; all else is that of this frame. While
/// nothing changes both are arithmetic means.
struct GatheringSettings {
    float indirectAlpha = 0.1f;  ///< weight of a new path in the average, once it has 1/alpha of them
    bool averageDirect = false;  ///< all else goes into an average, too
    bool converge = true;        ///< while nothing changes all is an arithmetic mean

    void describe(ParameterVisitor& v);
};

/// What is known of the light since the frame before.
struct GatheringState {
    bool still = false;        ///< nothing has changed
    bool restart = false;      ///< averages begin anew: they hold light that is no more
    bool lightsMoved = false;  ///< those of hidden samples do, which cannot follow
};

/// Adds `value`, the light of one more path, to the average of `count` of them. `still`: nothing has changed since the
/// frame before, and it is their mean.
void addToAverage(Vec3& average, uint16_t& count, const Vec3& value, bool still, const GatheringSettings& settings);

/// Paths of one sample a slot: the light that met at most one surface, and which part of all else came to that
/// surface's diffuse lobe.
class SplitObserver : public PathObserver {
public:
    SplitObserver(std::span<Vec3> direct, std::span<Vec3> diffuseShare)
        : direct_(direct), diffuseShare_(diffuseShare) {}
    ObserverNeeds needs() const override { return {2, 0, 0, 1, false}; }
    void bounce(const BounceBatch& batch) override;

private:
    std::span<Vec3> direct_, diffuseShare_;  ///< by slot
};

}  // namespace lumi

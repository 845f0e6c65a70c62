#pragma once
#include <vector>

#include "trace/observer.h"

namespace lumi {

/// What one path brought, split as the signals split it (frame/signals.h): emission seen at once, light that met one
/// surface, and all else; and the albedos of the first surface.
struct PathLighting {
    Vec3 emission{0}, direct{0}, indirect{0};
    Vec3 albedo{0}, specularAlbedo{0};
};

/// Collects the lighting of paths by their slots, 0 to count - 1, one path a slot.
class PathLightingObserver : public PathObserver {
public:
    explicit PathLightingObserver(size_t count) : lighting_(count) {}
    ObserverNeeds needs() const override { return {ObserverNeeds::kAll, 1, 0, 0, false}; }
    void bounce(const BounceBatch& batch) override {
        for (size_t i = 0; i < batch.slots.size(); ++i) {
            const PathVertex& v = batch.vertices[i];
            PathLighting& sum = lighting_[batch.slots[i]];
            const Vec3 emitted = v.throughput * v.emitted,
                       sampled = v.throughput * (v.directDiffuse + v.directSpecular);
            if (batch.depth == 0) {
                sum.emission = emitted;
                sum.direct = sampled;
                sum.albedo = v.albedo;
                sum.specularAlbedo = v.specularAlbedo;
            } else {
                (batch.depth == 1 ? sum.direct : sum.indirect) += emitted;
                sum.indirect += sampled;
            }
        }
    }
    const PathLighting& operator[](size_t slot) const { return lighting_[slot]; }

private:
    std::vector<PathLighting> lighting_;
};

/// What next-event estimation met at the first surface of paths, by their slots: where the light's sample was and what
/// stood before it.
struct ShadowSample {
    int light = -1;         ///< entry of the light that was sampled; -1: none
    bool infinite = false;  ///< `lightPosition` is a direction
    bool blocked = false;
    Vec3 lightPosition{0};
    SurfacePoint blocker;  ///< nearest, if blocked
};

class ShadowObserver : public PathObserver {
public:
    explicit ShadowObserver(size_t count) : samples_(count) {}
    ObserverNeeds needs() const override { return {1, 0, 0, 0, true}; }
    void bounce(const BounceBatch& batch) override {
        for (size_t i = 0; i < batch.slots.size(); ++i) {
            const PathVertex& v = batch.vertices[i];
            if (!v.lightSampled) continue;
            samples_[batch.slots[i]] = {v.light, v.lightInfinite, !v.lightVisible, v.lightPosition, v.blocker};
        }
    }
    const ShadowSample& operator[](size_t slot) const { return samples_[slot]; }

private:
    std::vector<ShadowSample> samples_;
};

}  // namespace lumi

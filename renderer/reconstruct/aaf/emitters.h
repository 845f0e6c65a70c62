#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "trace/tracer.h"

namespace lumi {

/// Which emissive triangles are one light to an eye that looks at its shadows: those of an instance that hang together
/// by corners at the same place. The tracer samples each of them as a light of its own.
class Emitters {
public:
    /// What the sampled light `light` (ShadowSample::light) is a part of; equal for parts of one. A light that is no
    /// triangle stands for itself.
    uint64_t emitterOf(const Tracer& tracer, int light);
    /// Is the point on that emitter?
    bool isOn(const Tracer& tracer, const SurfacePoint& point, uint64_t emitter);

private:
    uint64_t emitterOf(const Tracer& tracer, uint32_t instance, uint32_t primitive);
    struct Parts {
        std::weak_ptr<const Mesh> mesh;
        std::vector<uint32_t> part;  ///< of each triangle: the first triangle that it hangs together with
    };
    std::map<const Mesh*, Parts> parts_;
};

/// Of each triangle of a mesh at rest: the first one that it is connected with, over corners of equal position.
std::vector<uint32_t> connectedParts(const Mesh& mesh);

}  // namespace lumi

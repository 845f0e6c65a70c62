#pragma once
#include <cstdint>
#include <span>

#include "trace/ray.h"

namespace lumi {

class PosedScene;

enum class Lobe : uint8_t { None, Diffuse, SpecularReflection, SpecularTransmission, Clearcoat, Sheen };
inline bool isSpecular(Lobe lobe) { return lobe != Lobe::None && lobe != Lobe::Diffuse; }

/// One vertex of one path, as the integrator made it. World space.
struct PathVertex {
    SurfacePoint point;  ///< invalid: the path left the scene
    Vec3 position{0};
    Vec3 geometricNormal{0};  ///< unit, on the side of wo
    Vec3 normal{0};           ///< unit shading normal, on the side of wo
    Vec3 objectNormal{0};     ///< shading normal in object space, rest pose
    Vec3 wo{0};               ///< unit, towards the previous vertex
    float distance = 0;       ///< to the previous vertex; +inf where the path left the scene
    uint32_t material = 0;
    float roughness = 1;
    RayCone cone;            ///< footprint on arrival
    Vec3 throughput{1};      ///< path weight on arrival, roulette included
    Vec3 albedo{0};          ///< directional albedo of the diffuse lobe towards wo
    Vec3 specularAlbedo{0};  ///< and of all specular lobes together
    Vec3 emitted{
        0};  ///< radiance emitted towards wo, MIS-weighted for having been found by the BSDF, unweighted by throughput

    // Next-event estimation at this vertex. Contributions are radiance towards wo, MIS-weighted, visibility applied.
    Vec3 directDiffuse{0}, directSpecular{0};
    bool lightSampled = false;  ///< a light sample with a chance to contribute was taken
    bool lightVisible = false;
    Vec3 lightPosition{0};  ///< of the light sample; for infinite lights the direction
    bool lightInfinite = false;
    int light = -1;        ///< which light was sampled, TracerLights' index; -1 none
    SurfacePoint blocker;  ///< valid if needs().blocker was asked for and something blocked

    // The continuation that was sampled here.
    Lobe sampledLobe = Lobe::None;  ///< None: the path ended here
    Vec3 wi{0};
    Vec3 weight{0};  ///< f cos / pdf of the continuation, roulette included
    float pdf = 0;   ///< of wi per solid angle over all lobes; 0 for delta lobes
    Vec3 diffuseShare{
        0};  ///< fraction of `weight` in [0,1] that the diffuse lobe has; where lobes overlap neither 0 nor 1
};

/// What an observer wants; asked once a frame. What nobody asks for is not computed.
struct ObserverNeeds {
    static constexpr int kAll = 1 << 30;
    int vertexDepths = kAll;  ///< vertices at depths below this are reported; 0: only finished() is called
    int albedoDepths = kAll;  ///< vertices below this depth carry albedo and specularAlbedo
    int normalDepths = kAll;  ///< and objectNormal
    int shareDepths = kAll;   ///< and diffuseShare
    bool blocker = false;     ///< shadow rays report what blocked them (a closest-hit ray instead of an any-hit one)
};

/// The vertices of one bounce of a batch. `slots[i]` is the start's slot that vertices[i] belongs to; samples of one
/// slot arrive in order. All spans have one length.
struct BounceBatch {
    int depth = 0;  ///< 0 is the first surface the camera ray meets
    std::span<const uint32_t> slots;
    std::span<const uint32_t> samples;  ///< RandomKey::sample of each path
    std::span<const PathVertex> vertices;
    const PosedScene* scene = nullptr;
};

/// Watches the one integrator. Calls of one batch come in order from one thread; batches run in parallel, so an
/// observer writes only memory that belongs to the batch's slots (a slot is never in two batches at a time).
/// The result may not depend on which thread or in which order batches ran.
class PathObserver {
public:
    virtual ~PathObserver() = default;
    virtual ObserverNeeds needs() const { return {}; }
    virtual void bounce(const BounceBatch&) {}
    /// Each path of a batch is complete: its radiance, by start index. `slots` as above.
    virtual void finished(std::span<const uint32_t> slots, std::span<const uint32_t> samples,
                          std::span<const Vec3> radiance) {}
};

}  // namespace lumi

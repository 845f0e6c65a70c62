#include "trace/media_around.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "trace/packets.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

constexpr int kDirections = 16, kLeastAgreeing = 4, kMostCrossings = 64;

/// What a ray crossed on its way out.
struct Crossings {
    std::vector<uint32_t> left;  ///< materials of solids that it left without having entered, the innermost first
    bool escaped = false;
};

Crossings crossingsAlong(const TraceScene& scene, const Vec3& origin, const Vec3& direction, float time) {
    Crossings result;
    std::vector<uint32_t> entered;
    BatchRay ray{.origin = origin, .direction = direction, .time = time};
    for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
        RawHit hit;
        intersectRays(scene.embree, {&ray, 1}, {&hit, 1}, Coherence::Incoherent);
        result.escaped = !hit.valid();
        if (!hit.valid()) return result;
        const InstanceRecord& instance = scene.tables.instances[hit.instance];
        if (instance.body >= 0) return result;
        const uint32_t index = instance.materialOf(hit.primitive);
        const MaterialRecord& material = scene.tables.materials[index];
        if (!material.solid && !material.thinWall) return result;
        const SurfacePoint point = surfacePoint(scene.tables, hit, ray.origin + ray.direction * hit.distance, ray.time);
        const SurfaceGeometry at = surfaceGeometry(scene.tables, point, -direction, 0);
        ray.origin = offsetOrigin(at.position, at.frontFace ? -at.outwardNormal : at.outwardNormal, at.offset);
        if (!material.solid) continue;
        const auto earlier = std::find(entered.rbegin(), entered.rend(), index);
        if (at.frontFace) entered.push_back(index);
        else if (earlier != entered.rend()) entered.erase(std::next(earlier).base());
        else result.left.push_back(index);
    }
    return result;
}

/// Direction k of the spherical Fibonacci lattice.
Vec3 latticeDirection(int k) {
    const float y = 1 - (2 * static_cast<float>(k) + 1) / kDirections, r = std::sqrt(1 - y * y);
    const float angle = 2.39996323f * static_cast<float>(k);  // the golden angle
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

MediumStack mediaAt(const TraceScene& scene, const Vec3& place, float time) {
    std::map<std::vector<uint32_t>, int> votes;
    for (int k = 0; k < kDirections; ++k) {
        const Crossings found = crossingsAlong(scene, place, latticeDirection(k), time);
        if (!found.left.empty()) ++votes[found.left];
        else if (found.escaped) return {};
    }
    MediumStack media;
    const auto most =
        std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == votes.end() || most->second < kLeastAgreeing) return media;
    for (auto solid = most->first.rbegin(); solid != most->first.rend(); ++solid) media.enter(*solid);
    return media;
}

}  // namespace

MediumStack mediaAround(const TraceScene& scene, std::span<const Vec3> places, float time) {
    MediumStack media;
    for (size_t i = 0; i < places.size(); ++i) {
        const MediumStack here = mediaAt(scene, places[i], time);
        if (i > 0 && here != media) return {};
        media = here;
    }
    return media;
}

}  // namespace lumi

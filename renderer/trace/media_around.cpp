#include "trace/media_around.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "trace/packets.h"
#include "trace/surface.h"
#include "trace/trace_scene.h"

namespace lumi {
namespace {

constexpr int kDirections = 16, kLeastAgreeing = 14, kMostCrossings = 4096;

/// Materials of the solids that a ray leaves on its way out without having entered them, the innermost first; nothing
/// if it meets too much to tell.
std::optional<std::vector<uint32_t>> leftAlong(const TraceScene& scene, const Vec3& origin, const Vec3& direction,
                                               float time) {
    std::vector<uint32_t> left, entered;
    BatchRay ray{.origin = origin, .direction = direction, .time = time};
    for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
        RawHit hit;
        intersectRays(scene.embree, {&ray, 1}, {&hit, 1}, Coherence::Incoherent);
        if (!hit.valid()) return left;
        const SurfacePoint point = surfacePoint(scene.tables, hit, ray.origin + ray.direction * hit.distance, ray.time);
        const Surface at = evaluateSurface(scene.tables, point, -direction, 0);
        ray.origin = offsetOrigin(at.position, at.frontFace ? -at.outwardNormal : at.outwardNormal, at.offset);
        const uint32_t index = at.material;
        if (at.body >= 0 || !scene.tables.materials[index].solid) continue;
        const auto earlier = std::find(entered.rbegin(), entered.rend(), index);
        if (at.frontFace) entered.push_back(index);
        else if (earlier != entered.rend()) entered.erase(std::next(earlier).base());
        else left.push_back(index);
    }
    return std::nullopt;
}

/// Direction k of the spherical Fibonacci lattice.
Vec3 latticeDirection(int k) {
    const float y = 1 - (2 * static_cast<float>(k) + 1) / kDirections, r = std::sqrt(1 - y * y);
    const float angle = 2.39996323f * static_cast<float>(k);  // the golden angle
    return {r * std::cos(angle), y, r * std::sin(angle)};
}

}  // namespace

MediumStack mediaAround(const TraceScene& scene, const Vec3& place, float time) {
    // Each solid is voted on by itself: directions may leave solids that overlap in another order. Of one material
    // there may be several around each other.
    struct Votes {
        int count = 0, orders = 0;
    };
    std::map<std::pair<uint32_t, int>, Votes> votes;
    for (int k = 0; k < kDirections; ++k) {
        std::map<uint32_t, int> copies;
        int order = 0;
        for (const uint32_t material :
             leftAlong(scene, place, latticeDirection(k), time).value_or(std::vector<uint32_t>())) {
            Votes& of = votes[{material, copies[material]++}];
            ++of.count, of.orders += order++;
        }
    }
    std::vector<std::pair<float, uint32_t>> around;  // by how early they are left on the average
    for (const auto& [solid, of] : votes)
        if (of.count >= kLeastAgreeing)
            around.emplace_back(static_cast<float>(of.orders) / static_cast<float>(of.count), solid.first);
    std::sort(around.rbegin(), around.rend());
    MediumStack media;
    for (const auto& [order, material] : around) media.enter(material);
    return media;
}

}  // namespace lumi

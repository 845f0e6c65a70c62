#include "reconstruct/aaf/emitters.h"

#include <algorithm>
#include <numeric>

namespace lumi {
namespace {

constexpr uint64_t kNoTriangle = 1ull << 63;  ///< beside the index of a light that is none

/// A forest of sets; the root of each is its least member.
class DisjointSets {
public:
    explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<uint32_t> parent_;
};

}  // namespace

std::vector<uint32_t> connectedParts(const Mesh& mesh) {
    // Vertices in the order of their places: equal ones follow each other.
    std::vector<uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](uint32_t a, uint32_t b) {
        const Vec3 &p = mesh.positions[a], &q = mesh.positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z < q.z;
    };
    std::sort(order.begin(), order.end(), before);
    std::vector<uint32_t> place(order.size());
    for (size_t i = 0; i < order.size(); ++i)
        place[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? place[order[i - 1]] : static_cast<uint32_t>(i);

    const auto count = static_cast<uint32_t>(mesh.triangles.size());
    constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> firstAt(order.size(), kNone);  // the first triangle with a corner at the place
    DisjointSets sets(count);
    for (uint32_t t = 0; t < count; ++t)
        for (int corner = 0; corner < 3; ++corner) {
            uint32_t& first = firstAt[place[mesh.triangles[t][corner]]];
            if (first == kNone) first = t;
            else sets.join(first, t);
        }
    std::vector<uint32_t> parts(count);
    for (uint32_t t = 0; t < count; ++t) parts[t] = sets.find(t);
    return parts;
}

uint64_t Emitters::emitterOf(const Tracer& tracer, int light) {
    const std::optional<SurfacePoint> triangle = tracer.emittingTriangle(light);
    return triangle ? emitterOf(tracer, triangle->instance, triangle->primitive)
                    : kNoTriangle | static_cast<uint64_t>(light);
}

bool Emitters::isOn(const Tracer& tracer, const SurfacePoint& point, uint64_t emitter) {
    if (emitter & kNoTriangle || !tracer.has(point) || point.instance != emitter >> 32) return false;
    return emitterOf(tracer, point.instance, point.primitive) == emitter;
}

uint64_t Emitters::emitterOf(const Tracer& tracer, uint32_t instance, uint32_t primitive) {
    const std::shared_ptr<const Mesh>& mesh = tracer.scene().scene->instances[instance].mesh;
    auto found = parts_.find(mesh.get());
    if (found == parts_.end() || found->second.mesh.lock() != mesh) {
        std::erase_if(parts_, [](const auto& entry) { return entry.second.mesh.expired(); });
        found = parts_.insert_or_assign(mesh.get(), Parts{mesh, connectedParts(*mesh)}).first;
    }
    return uint64_t{instance} << 32 | found->second.part[primitive];
}

}  // namespace lumi

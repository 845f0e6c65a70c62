// Tangents as normal maps are baked with: Morten S. Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008,
// section 3.3 and appendix A. Corners of equal position, normal and texture coordinates are one vertex; the corners
// around a vertex that share edges and the orientation of their coordinates form a group; a group's tangent is the sum
// of its triangles' tangents in the plane of the vertex normal, weighted by angle. Differs from the thesis: triangles
// only (no quads); one tangent for a group of more than 128 corners.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "math/transform.h"
#include "scene/mesh.h"
#include "scene/mesh_edit.h"

namespace lumi {
namespace {

constexpr uint32_t kNone = ~0u;
constexpr size_t kLargestExactGroup = 128;
constexpr Vec4 kNoDirection(0, 0, 0, 1);
constexpr int kMostCopiesTried = 16;  ///< of a vertex that thousands of faces share, before it gets another copy

struct Face {
    std::array<uint32_t, 3> vertex{};                        ///< welded vertex of each corner
    std::array<uint32_t, 3> neighbour{kNone, kNone, kNone};  ///< face across the edge from this corner to the next
    std::array<uint32_t, 3> group{kNone, kNone, kNone};
    Vec3 along{0}, across{0};   ///< unit directions of growing u and growing v
    bool isDegenerate = false;  ///< two corners in one place
    bool isUndirected = true;   ///< its coordinates have no area: joins any group and adds nothing
    bool preserves = false;     ///< the coordinates run counter-clockwise where the triangle does
};

/// Corners of one vertex: entries [first, last) of the list of members, which are faces.
struct Group {
    uint32_t vertex = 0;
    bool preserves = false;
    uint32_t first = 0, last = 0;
};

Vec3 projected(const Vec3& v, const Vec3& normal) { return unitOr(v - normal * glm::dot(normal, v), Vec3(0)); }

Vec3 anyPerpendicular(const Vec3& n) {
    const Vec3 axis = std::abs(n.x) < 0.6f ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
    return glm::normalize(glm::cross(axis, n));
}

/// Representative (the first) of every vertex among those with equal position, normal and texture coordinates.
std::vector<uint32_t> weld(const Mesh& mesh, const std::vector<Vec2>& uv) {
    using Key = std::array<uint32_t, 8>;
    const auto keyOf = [&](size_t v) {
        const Vec3 &p = mesh.positions[v], &n = mesh.normals[v];
        Key key;
        const float values[8] = {p.x, p.y, p.z, n.x, n.y, n.z, uv[v].x, uv[v].y};
        for (size_t i = 0; i < 8; ++i) key[i] = std::bit_cast<uint32_t>(values[i] + 0.0f);  // -0 is 0
        return key;
    };
    const size_t slots = std::bit_ceil(2 * mesh.positions.size() + 1);
    std::vector<uint32_t> table(slots, kNone), representative(mesh.positions.size());
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const Key key = keyOf(v);
        uint64_t hash = 0;
        for (const uint32_t word : key) hash = (hash ^ word) * 0x9E3779B97F4A7C15u, hash ^= hash >> 29;
        size_t slot = hash & (slots - 1);
        while (table[slot] != kNone && keyOf(table[slot]) != key) slot = (slot + 1) & (slots - 1);
        if (table[slot] == kNone) table[slot] = static_cast<uint32_t>(v);
        representative[v] = table[slot];
    }
    return representative;
}

class TangentSpaces {
public:
    TangentSpaces(const Mesh& mesh, const std::vector<Vec2>& uv) : mesh_(mesh), uv_(uv), faces_(mesh.triangles.size()) {
        const std::vector<uint32_t> representative = weld(mesh, uv);
        for (size_t f = 0; f < faces_.size(); ++f) {
            for (int c = 0; c < 3; ++c) faces_[f].vertex[static_cast<size_t>(c)] = representative[mesh.triangles[f][c]];
            orient(faces_[f]);
        }
        findNeighbours();
        findGroups();
        cornerTangents_.assign(3 * faces_.size(), kNoDirection);
        for (const Group& group : groups_) evaluate(group);
        copyToDegenerate();
    }
    /// xyz unit and orthogonal to the normal, or zero where nothing gives a direction; w as in glTF.
    const std::vector<Vec4>& cornerTangents() const { return cornerTangents_; }

private:
    void orient(Face& face) const {
        const auto [a, b, c] = face.vertex;
        const Vec3 e1 = mesh_.positions[b] - mesh_.positions[a], e2 = mesh_.positions[c] - mesh_.positions[a];
        const Vec2 d1 = uv_[b] - uv_[a], d2 = uv_[c] - uv_[a];
        face.isDegenerate = e1 == Vec3(0) || e2 == Vec3(0) || mesh_.positions[b] == mesh_.positions[c];
        const float area = d1.x * d2.y - d1.y * d2.x;
        if (!(std::abs(area) > 0) || !std::isfinite(area)) return;
        face.preserves = area > 0;
        const float sign = face.preserves ? 1.0f : -1.0f;
        face.along = unitOr(sign * (e1 * d2.y - e2 * d1.y), Vec3(0));
        face.across = unitOr(sign * (e2 * d1.x - e1 * d2.x), Vec3(0));
        face.isUndirected = face.along == Vec3(0) || face.across == Vec3(0);
    }

    /// Two faces are neighbours if they run along an edge in opposite directions; further faces on it pair up in turn.
    void findNeighbours() {
        struct Edge {
            uint32_t low, high, face, corner;
        };
        std::vector<Edge> edges;
        edges.reserve(3 * faces_.size());
        for (uint32_t f = 0; f < faces_.size(); ++f)
            for (uint32_t c = 0; c < 3 && !faces_[f].isDegenerate; ++c) {
                const auto [low, high] = std::minmax({faces_[f].vertex[c], faces_[f].vertex[(c + 1) % 3]});
                edges.push_back({low, high, f, c});
            }
        std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
            return std::tie(a.low, a.high, a.face, a.corner) < std::tie(b.low, b.high, b.face, b.corner);
        });
        const auto start = [&](const Edge& e) { return faces_[e.face].vertex[e.corner]; };
        const auto isFree = [&](const Edge& e) { return faces_[e.face].neighbour[e.corner] == kNone; };
        constexpr size_t kMostAtOneEdge = 64;  // a bound on the search where thousands of faces meet at one edge
        for (size_t i = 0; i < edges.size(); ++i) {
            const Edge& a = edges[i];
            for (size_t j = i + 1; j < std::min(edges.size(), i + kMostAtOneEdge) && isFree(a); ++j) {
                const Edge& b = edges[j];
                if (b.low != a.low || b.high != a.high) break;
                if (!isFree(b) || start(a) == start(b)) continue;
                faces_[a.face].neighbour[a.corner] = b.face;
                faces_[b.face].neighbour[b.corner] = a.face;
            }
        }
    }

    void findGroups() {
        for (uint32_t f = 0; f < faces_.size(); ++f)
            for (size_t c = 0; c < 3; ++c)
                if (!faces_[f].isDegenerate && !faces_[f].isUndirected && faces_[f].group[c] == kNone)
                    gather(f, faces_[f].vertex[c]);
    }

    /// Everything around `vertex` that can be reached from `face` without crossing a change of orientation.
    void gather(uint32_t face, uint32_t vertex) {
        Group group{vertex, faces_[face].preserves, static_cast<uint32_t>(members_.size()), 0};
        const auto number = static_cast<uint32_t>(groups_.size());
        stack_.assign(1, face);
        while (!stack_.empty()) {
            const uint32_t index = stack_.back();
            stack_.pop_back();
            Face& reached = faces_[index];
            const auto corner = static_cast<size_t>(std::find(reached.vertex.begin(), reached.vertex.end(), vertex) -
                                                    reached.vertex.begin());
            if (corner == 3 || reached.group[corner] != kNone) continue;
            const bool isNew =
                std::all_of(reached.group.begin(), reached.group.end(), [](auto g) { return g == kNone; });
            if (reached.isUndirected && isNew) reached.preserves = group.preserves;
            if (reached.preserves != group.preserves) continue;
            reached.group[corner] = number;
            members_.push_back(index);
            for (const uint32_t next : {reached.neighbour[corner], reached.neighbour[(corner + 2) % 3]})
                if (next != kNone) stack_.push_back(next);
        }
        group.last = static_cast<uint32_t>(members_.size());
        std::sort(members_.begin() + group.first, members_.end());
        groups_.push_back(group);
    }

    size_t cornerAt(uint32_t face, uint32_t vertex) const {
        const auto& vertices = faces_[face].vertex;
        return static_cast<size_t>(std::find(vertices.begin(), vertices.end(), vertex) - vertices.begin());
    }

    /// Sum over the members that go with `face`: all but those that point exactly against it (kNone: all).
    Vec3 sumOver(const Group& group, uint32_t face) const {
        const Vec3& normal = mesh_.normals[group.vertex];
        Vec3 sum(0);
        for (uint32_t m = group.first; m < group.last; ++m) {
            const Face& member = faces_[members_[m]];
            if (member.isUndirected || (face != kNone && !goTogether(faces_[face], member, normal))) continue;
            const size_t corner = cornerAt(members_[m], group.vertex);
            const Vec3& p = mesh_.positions[group.vertex];
            const Vec3 next = projected(mesh_.positions[member.vertex[(corner + 1) % 3]] - p, normal);
            const Vec3 last = projected(mesh_.positions[member.vertex[(corner + 2) % 3]] - p, normal);
            sum += std::acos(std::clamp(glm::dot(next, last), -1.0f, 1.0f)) * projected(member.along, normal);
        }
        return unitOr(sum, Vec3(0));
    }

    static bool goTogether(const Face& a, const Face& b, const Vec3& normal) {
        if (a.isUndirected || b.isUndirected) return true;
        return glm::dot(projected(a.along, normal), projected(b.along, normal)) > -1 &&
               glm::dot(projected(a.across, normal), projected(b.across, normal)) > -1;
    }

    void evaluate(const Group& group) {
        // No two members can be opposite while all lie within a right angle of one of them.
        const Vec3& normal = mesh_.normals[group.vertex];
        const Face& first = faces_[members_[group.first]];
        const Vec3 along = projected(first.along, normal), across = projected(first.across, normal);
        bool isNarrow = !first.isUndirected || group.last - group.first == 1;
        for (uint32_t m = group.first; m < group.last && isNarrow; ++m) {
            const Face& member = faces_[members_[m]];
            isNarrow = member.isUndirected || (glm::dot(projected(member.along, normal), along) > 0 &&
                                               glm::dot(projected(member.across, normal), across) > 0);
        }
        const bool shared = isNarrow || group.last - group.first > kLargestExactGroup;
        // glTF's bitangent, cross(normal, tangent) * w, points up in the image: against v, which grows downwards.
        const float w = group.preserves ? -1.0f : 1.0f;
        const Vec3 common = shared ? sumOver(group, kNone) : Vec3(0);
        for (uint32_t m = group.first; m < group.last; ++m)
            cornerTangents_[3 * members_[m] + cornerAt(members_[m], group.vertex)] =
                Vec4(shared ? common : sumOver(group, members_[m]), w);
    }

    /// Corners of degenerate faces take the tangent of some other face at the same vertex.
    void copyToDegenerate() {
        std::vector<uint32_t> cornerOf;
        for (uint32_t f = 0; f < faces_.size(); ++f) {
            if (!faces_[f].isDegenerate) continue;
            if (cornerOf.empty()) cornerOf = firstCorners();
            for (uint32_t c = 0; c < 3; ++c)
                if (const uint32_t corner = cornerOf[faces_[f].vertex[c]]; corner != kNone)
                    cornerTangents_[3 * f + c] = cornerTangents_[corner];
        }
    }
    std::vector<uint32_t> firstCorners() const {
        std::vector<uint32_t> cornerOf(mesh_.positions.size(), kNone);
        for (uint32_t f = 0; f < faces_.size(); ++f)
            for (uint32_t c = 0; c < 3 && !faces_[f].isDegenerate; ++c)
                if (uint32_t& corner = cornerOf[faces_[f].vertex[c]]; corner == kNone) corner = 3 * f + c;
        return cornerOf;
    }

    const Mesh& mesh_;
    const std::vector<Vec2>& uv_;
    std::vector<Face> faces_;
    std::vector<Group> groups_;
    std::vector<uint32_t> members_, stack_;
    std::vector<Vec4> cornerTangents_;
};

/// Gives every vertex its corners' tangent; a vertex whose corners disagree is split.
void assignToVertices(Mesh& mesh, const std::vector<Vec4>& cornerTangents) {
    const size_t before = mesh.positions.size();
    std::vector<uint32_t> source(before), nextCopy(before, kNone);
    std::vector<bool> isSet(before, false);
    for (uint32_t v = 0; v < before; ++v) source[v] = v;
    std::vector<Vec4> tangents(before, kNoDirection);
    const auto agree = [](const Vec4& a, const Vec4& b) {
        const Vec3 difference = Vec3(a) - Vec3(b);
        return b == kNoDirection || (a.w == b.w && glm::dot(difference, difference) < 1e-10f);
    };
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            const Vec4& tangent = cornerTangents[3 * t + static_cast<size_t>(c)];
            uint32_t v = mesh.triangles[t][c];
            if (!isSet[v] && tangent != kNoDirection) tangents[v] = tangent, isSet[v] = true;
            const uint32_t original = v;
            for (int tried = 0; v != kNone && !agree(tangents[v], tangent); ++tried)
                v = tried < kMostCopiesTried ? nextCopy[v] : kNone;
            if (v == kNone) {
                v = static_cast<uint32_t>(source.size());
                source.push_back(original);
                tangents.push_back(tangent);
                nextCopy.push_back(std::exchange(nextCopy[original], v));
            }
            mesh.triangles[t][c] = v;
        }
    mesh.tangents.clear();
    if (source.size() > before) gatherVertices(mesh, source);
    mesh.tangents = std::move(tangents);
}

}  // namespace

void computeTangents(Mesh& mesh, int uvSet) {
    if (mesh.normals.empty()) computeNormals(mesh);
    if (mesh.uv[uvSet].empty()) {
        mesh.tangents.assign(mesh.positions.size(), kNoDirection);
    } else {
        const TangentSpaces spaces(mesh, mesh.uv[uvSet]);
        assignToVertices(mesh, spaces.cornerTangents());
    }
    for (size_t v = 0; v < mesh.tangents.size(); ++v)
        if (Vec4& tangent = mesh.tangents[v]; Vec3(tangent) == Vec3(0))
            tangent = Vec4(anyPerpendicular(mesh.normals[v]), tangent.w);
}

}  // namespace lumi

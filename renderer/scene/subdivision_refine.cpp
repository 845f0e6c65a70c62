#include "scene/subdivision_refine.h"

#include <opensubdiv/far/primvarRefiner.h>

#include <algorithm>
#include <map>
#include <memory>

#include "scene/subdivision_folds.h"
#include "scene/subdivision_topology.h"

namespace lumi {
namespace {
namespace Far = OpenSubdiv::Far;

/// Edges of this sharpness and above never become smooth; a dart at a fold gets a little less.
constexpr float kInfinitelySharp = 10, kNearlySharp = 9.5f;

/// A row of weights that OpenSubdiv's refiner combines; a vertex may stand in it several times until merged().
struct WeightRow : RefinedCage::Row {
    void Clear(void* = nullptr) { weights.clear(); }
    void AddWithWeight(const WeightRow& other, float weight) {
        for (const auto& [vertex, w] : other.weights) weights.emplace_back(vertex, weight * w);
    }
    RefinedCage::Row merged() const {
        std::map<uint32_t, float> sums;
        for (const auto& [vertex, weight] : weights) sums[vertex] += weight;
        return {{sums.begin(), sums.end()}};
    }
};

struct Uv {
    Vec2 value{0};
    void Clear(void* = nullptr) { value = Vec2(0); }
    void AddWithWeight(const Uv& other, float weight) { value += weight * other.value; }
};

void refineVertices(const Far::TopologyRefiner& refiner, const SubdivisionCage& coarse, RefinedCage& out) {
    std::vector<WeightRow> identity(coarse.positions.size());
    for (uint32_t v = 0; v < identity.size(); ++v) identity[v].weights = {{v, 1.0f}};
    std::vector<WeightRow> rows(static_cast<size_t>(refiner.GetLevel(1).GetNumVertices()));
    Far::PrimvarRefiner(refiner).Interpolate(1, identity, rows);
    for (const WeightRow& row : rows) {
        Vec3 position(0);
        out.vertices.push_back(row.merged());
        for (const auto& [vertex, weight] : out.vertices.back().weights) position += weight * coarse.positions[vertex];
        out.cage.positions.push_back(position);
    }
}

void refineUvs(const Far::TopologyRefiner& refiner, const SubdivisionCage& coarse, SubdivisionCage& out) {
    std::vector<Uv> from(coarse.uvs.size()), to(static_cast<size_t>(refiner.GetLevel(1).GetNumFVarValues(0)));
    for (size_t i = 0; i < from.size(); ++i) from[i].value = coarse.uvs[i];
    Far::PrimvarRefiner(refiner).InterpolateFaceVarying(1, from, to);
    for (const Uv& uv : to) out.uvs.push_back(uv.value);
    const Far::TopologyLevel& level = refiner.GetLevel(1);
    for (int face = 0; face < level.GetNumFaces(); ++face)
        for (const int value : level.GetFaceFVarValues(face)) out.faceUvs.push_back(static_cast<uint32_t>(value));
}

/// A face has a limit surface unless it is a hole or, where boundaries are not interpolated, touches one.
bool hasSurface(const Far::TopologyLevel& level, int face, SubdivisionCage::Boundary boundary) {
    if (level.IsFaceHole(face)) return false;
    if (boundary != SubdivisionCage::Boundary::None) return true;
    const auto corners = level.GetFaceVertices(face);
    return std::none_of(corners.begin(), corners.end(), [&](int v) { return level.IsVertexBoundary(v); });
}

void refineFaces(const Far::TopologyRefiner& refiner, const SubdivisionCage& coarse, RefinedCage& out) {
    const Far::TopologyLevel &parents = refiner.GetLevel(0), &level = refiner.GetLevel(1);
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        const auto corners = level.GetFaceVertices(face);
        out.cage.faceSizes.push_back(static_cast<uint32_t>(corners.size()));
        for (const int vertex : corners) out.cage.faceVertices.push_back(static_cast<uint32_t>(vertex));
        const int parent = level.GetFaceParentFace(face);
        const auto children = parents.GetFaceChildFaces(parent);
        out.parentFace.push_back(static_cast<uint32_t>(parent));
        const auto child = std::find(children.begin(), children.end(), face) - children.begin();
        out.childOfFace.push_back(static_cast<uint32_t>(child));
        out.parentSize.push_back(static_cast<uint32_t>(children.size()));
        if (!coarse.faceMaterials.empty())
            out.cage.faceMaterials.push_back(coarse.faceMaterials[static_cast<size_t>(parent)]);
        if (!hasSurface(parents, parent, coarse.boundary)) out.cage.holes.push_back(static_cast<uint32_t>(face));
    }
}

/// The one infinitely sharp edge of a fold, or -1.
int dartEdge(const Far::TopologyLevel& level, int vertex) {
    int found = -1, sharp = 0;
    for (const int edge : level.GetVertexEdges(vertex)) {
        if (level.GetEdgeSharpness(edge) < kInfinitelySharp) continue;
        found = edge;
        ++sharp;
    }
    return sharp == 1 ? found : -1;
}

/// An edge of a face from a vertex to itself becomes two edges that join the same two vertices. Refinement keeps them
/// apart and sharp; in a cage they are one edge and its middle a fold, which tags hold where it was.
void sharpenDoubledEdges(const Far::TopologyRefiner& refiner, SubdivisionCage& out) {
    const Far::TopologyLevel& parents = refiner.GetLevel(0);
    for (int edge = 0; edge < parents.GetNumEdges(); ++edge) {
        const auto ends = parents.GetEdgeVertices(edge);
        if (ends[0] != ends[1]) continue;
        const auto end = static_cast<uint32_t>(parents.GetVertexChildVertex(ends[0]));
        const auto middle = static_cast<uint32_t>(parents.GetEdgeChildVertex(edge));
        out.corners.push_back({middle, kInfinitelySharp});
        out.creases.push_back({end, middle, kNearlySharp});
    }
}

void refineSharpness(const Far::TopologyRefiner& refiner, SubdivisionCage& out) {
    const Far::TopologyLevel& level = refiner.GetLevel(1);
    std::vector<bool> isDart(static_cast<size_t>(level.GetNumEdges()), false);
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex) {
        const float sharpness = level.GetVertexSharpness(vertex);
        if (sharpness > 0) out.corners.push_back({static_cast<uint32_t>(vertex), sharpness});
        if (!isFold(level, vertex)) continue;
        if (const int edge = dartEdge(level, vertex); edge >= 0) isDart[static_cast<size_t>(edge)] = true;
    }
    for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
        const float sharpness = level.GetEdgeSharpness(edge);
        if (sharpness <= 0 || level.GetEdgeFaces(edge).size() != 2) continue;
        const auto ends = level.GetEdgeVertices(edge);
        out.creases.push_back({static_cast<uint32_t>(ends[0]), static_cast<uint32_t>(ends[1]),
                               isDart[static_cast<size_t>(edge)] ? kNearlySharp : sharpness});
    }
}

}  // namespace

RefinedCage refineOnce(const SubdivisionCage& cage, const std::string& where) {
    const auto refiner = makeRefiner(cage, where);
    Far::TopologyRefiner::UniformOptions options(1);
    options.fullTopologyInLastLevel = true;
    refiner->RefineUniform(options);

    RefinedCage out;
    out.cage.name = cage.name;
    out.cage.material = cage.material;
    out.cage.scheme = cage.scheme;
    out.cage.faceVarying = cage.faceVarying;
    out.cage.chaikin = cage.chaikin;
    using Boundary = SubdivisionCage::Boundary;
    out.cage.boundary = cage.boundary == Boundary::None ? Boundary::EdgeOnly : cage.boundary;
    refineVertices(*refiner, cage, out);
    refineFaces(*refiner, cage, out);
    if (!cage.uvs.empty()) refineUvs(*refiner, cage, out.cage);
    refineSharpness(*refiner, out.cage);
    sharpenDoubledEdges(*refiner, out.cage);
    return out;
}

}  // namespace lumi

#include "scene/subdivision_folds.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace lumi {
namespace {
namespace Far = OpenSubdiv::Far;

/// As many creases as every face's patch has room for, whatever lies around it: with no more vertices than these, its
/// faces, their vertices and its creases fit into the 256 integers that OpenSubdiv has ready on the stack.
constexpr int kSafeCreases = 32;

/// What joins faces: their vertices or, as a face-varying channel has it, their texture coordinates.
constexpr int kVertices = -1;

/// The two faces have the same values at both ends of their edge, which they go along in opposite directions.
bool valuesMatch(const Far::TopologyLevel& level, int edge, int face, int other, int channel) {
    const auto place = [&](int of) {
        const auto edges = level.GetFaceEdges(of);
        return static_cast<int>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
    };
    const auto values = level.GetFaceFVarValues(face, channel), others = level.GetFaceFVarValues(other, channel);
    const int here = place(face), there = place(other);
    return values[here] == others[(there + 1) % others.size()] && values[(here + 1) % values.size()] == others[there];
}

/// The face on the other side of a closed edge, or -1.
int acrossEdge(const Far::TopologyLevel& level, int edge, int face, int channel) {
    const auto faces = level.GetEdgeFaces(edge);
    if (faces.size() != 2 || level.IsEdgeNonManifold(edge)) return -1;
    const int other = faces[0] == face ? faces[1] : faces[0];
    return channel == kVertices || valuesMatch(level, edge, face, other, channel) ? other : -1;
}

bool isFoldCorner(const Far::TopologyLevel& level, int face, int corner, int channel) {
    const auto edges = level.GetFaceEdges(face);
    const int before = edges[(corner + edges.size() - 1) % edges.size()];
    const int neighbour = acrossEdge(level, edges[corner], face, channel);
    return neighbour >= 0 && neighbour == acrossEdge(level, before, face, channel);
}

bool isOpenFold(const Far::TopologyLevel& level, int face, int channel) {
    const auto edges = level.GetFaceEdges(face);
    const auto isOpen = [&](int edge) { return acrossEdge(level, edge, face, channel) < 0; };
    if (std::none_of(edges.begin(), edges.end(), isOpen)) return false;
    for (int corner = 0; corner < edges.size(); ++corner)
        if (isFoldCorner(level, face, corner, channel)) return true;
    return false;
}

bool isSharp(const Far::TopologyLevel& level, int edge) {
    return level.GetEdgeSharpness(edge) > 0 && level.GetEdgeFaces(edge).size() > 1;
}

/// What of a vertex matters to the creases of the faces around it.
struct VertexCreases {
    int sharpEdges = 0;
    bool touchesTriangle = false;
};

std::vector<VertexCreases> creasesOfVertices(const Far::TopologyLevel& level) {
    std::vector<VertexCreases> result(static_cast<size_t>(level.GetNumVertices()));
    for (int edge = 0; edge < level.GetNumEdges(); ++edge) {
        if (!isSharp(level, edge)) continue;
        for (const int vertex : level.GetEdgeVertices(edge)) ++result[static_cast<size_t>(vertex)].sharpEdges;
    }
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        const auto corners = level.GetFaceVertices(face);
        if (corners.size() != 3) continue;
        for (const int vertex : corners) result[static_cast<size_t>(vertex)].touchesTriangle = true;
    }
    return result;
}

}  // namespace

bool isFold(const Far::TopologyLevel& level, int vertex) {
    for (const int face : level.GetVertexFaces(vertex)) {
        const auto corners = level.GetFaceVertices(face);
        for (int corner = 0; corner < corners.size(); ++corner)
            if (corners[corner] == vertex && isFoldCorner(level, face, corner, kVertices)) return true;
    }
    return false;
}

bool hasFolds(const Far::TopologyLevel& level) {
    for (int vertex = 0; vertex < level.GetNumVertices(); ++vertex)
        if (isFold(level, vertex)) return true;
    return false;
}

bool hasOpenFolds(const Far::TopologyLevel& level) {
    for (int channel = kVertices; channel < level.GetNumFVarChannels(); ++channel)
        for (int face = 0; face < level.GetNumFaces(); ++face)
            if (isOpenFold(level, face, channel)) return true;
    return false;
}

bool hasCrowdedCreases(const Far::TopologyLevel& level) {
    const std::vector<VertexCreases> vertices = creasesOfVertices(level);
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        // The sharp edges at its corners, its own counted once.
        int64_t creases = 0;
        bool touchesTriangle = false;
        for (const int vertex : level.GetFaceVertices(face)) {
            creases += vertices[static_cast<size_t>(vertex)].sharpEdges;
            touchesTriangle |= vertices[static_cast<size_t>(vertex)].touchesTriangle;
        }
        for (const int edge : level.GetFaceEdges(face)) creases -= isSharp(level, edge) ? 1 : 0;
        if (creases > kSafeCreases && touchesTriangle) return true;
    }
    return false;
}

}  // namespace lumi

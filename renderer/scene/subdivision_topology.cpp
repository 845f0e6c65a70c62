#include "scene/subdivision_topology.h"

#include <fmt/format.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/sdc/crease.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "scene/reach.h"

namespace lumi {
namespace {
namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

void checkIndices(const std::vector<uint32_t>& indices, size_t limit, const char* what, const std::string& where) {
    for (const uint32_t index : indices)
        if (index >= limit)
            throwBadInput({fmt::format("a {} index is out of range", what), where, fmt::format("below {}", limit),
                           fmt::format("{}", static_cast<int32_t>(index))});
}

void checkCage(const SubdivisionCage& cage, const std::string& where) {
    uint64_t corners = 0;
    for (const uint32_t size : cage.faceSizes) {
        if (size < 3) throwBadInput({"a face has too few corners", where, "3 or more", fmt::format("{}", size)});
        corners += size;
    }
    if (corners != cage.faceVertices.size() || (!cage.uvs.empty() && corners != cage.faceUvs.size()))
        throwBadInput({"face sizes and face indices do not agree", where, "", ""});
    checkIndices(cage.faceVertices, cage.positions.size(), "vertex", where);
    if (!cage.uvs.empty()) checkIndices(cage.faceUvs, cage.uvs.size(), "texture coordinate", where);
    checkIndices(cage.holes, cage.faceSizes.size(), "hole", where);
    for (const auto& crease : cage.creases) checkIndices({crease.a, crease.b}, cage.positions.size(), "crease", where);
    for (const auto& corner : cage.corners) checkIndices({corner.vertex}, cage.positions.size(), "corner", where);
    if (const size_t i = firstOutOfReach(cage.positions); i < cage.positions.size())
        throwBadInput({fmt::format("the position of vertex {} is out of range", i), where, reachText(),
                       outOfReachText(cage.positions[i])});
}

Sdc::Options schemeOptions(const SubdivisionCage& cage) {
    Sdc::Options options;
    constexpr Sdc::Options::VtxBoundaryInterpolation kBoundary[] = {Sdc::Options::VTX_BOUNDARY_NONE,
                                                                    Sdc::Options::VTX_BOUNDARY_EDGE_ONLY,
                                                                    Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER};
    constexpr Sdc::Options::FVarLinearInterpolation kFaceVarying[] = {
        Sdc::Options::FVAR_LINEAR_NONE,          Sdc::Options::FVAR_LINEAR_CORNERS_ONLY,
        Sdc::Options::FVAR_LINEAR_CORNERS_PLUS1, Sdc::Options::FVAR_LINEAR_CORNERS_PLUS2,
        Sdc::Options::FVAR_LINEAR_BOUNDARIES,    Sdc::Options::FVAR_LINEAR_ALL};
    options.SetVtxBoundaryInterpolation(kBoundary[static_cast<size_t>(cage.boundary)]);
    options.SetFVarLinearInterpolation(kFaceVarying[static_cast<size_t>(cage.faceVarying)]);
    options.SetCreasingMethod(cage.chaikin ? Sdc::Options::CREASE_CHAIKIN : Sdc::Options::CREASE_UNIFORM);
    options.SetTriangleSubdivision(cage.smoothTriangles ? Sdc::Options::TRI_SUB_SMOOTH : Sdc::Options::TRI_SUB_CATMARK);
    return options;
}

/// OpenSubdiv prints what it finds odd in a topology (a crease along an edge that is not there, say); it skips it.
void silenceOpenSubdiv() {
    Far::SetWarningCallback([](const char*) {});
    Far::SetErrorCallback([](Far::ErrorType, const char*) {});
}

/// Vertices that some face has twice. OpenSubdiv 3.5 makes sharp corners of most, as of all that are not manifold, but
/// takes a few for manifold ones and averages around them with weights that it never set. Made corners, all are alike.
std::vector<int> repeatedVertices(const SubdivisionCage& cage) {
    std::vector<int> result;
    std::vector<size_t> lastFace(cage.positions.size(), 0);  // of each vertex, counted from 1
    size_t next = 0;
    for (size_t face = 1; face <= cage.faceSizes.size(); ++face)
        for (uint32_t corner = 0; corner < cage.faceSizes[face - 1]; ++corner) {
            const uint32_t vertex = cage.faceVertices[next++];
            if (lastFace[vertex] == face) result.push_back(static_cast<int>(vertex));
            lastFace[vertex] = face;
        }
    return result;
}

std::vector<int> asInts(const std::vector<uint32_t>& values) { return {values.begin(), values.end()}; }

}  // namespace

std::unique_ptr<Far::TopologyRefiner> makeRefiner(const SubdivisionCage& cage, const std::string& where) {
    checkCage(cage, where);
    silenceOpenSubdiv();
    const std::vector<int> sizes = asInts(cage.faceSizes), vertices = asInts(cage.faceVertices);
    const std::vector<int> holes = asInts(cage.holes), uvs = asInts(cage.faceUvs);
    std::vector<int> creaseVertices, cornerVertices;
    std::vector<float> creaseWeights, cornerWeights;
    for (const auto& crease : cage.creases) {
        creaseVertices.insert(creaseVertices.end(), {static_cast<int>(crease.a), static_cast<int>(crease.b)});
        creaseWeights.push_back(crease.sharpness);
    }
    for (const auto& corner : cage.corners) {
        cornerVertices.push_back(static_cast<int>(corner.vertex));
        cornerWeights.push_back(corner.sharpness);
    }

    for (const int vertex : repeatedVertices(cage)) {
        cornerVertices.push_back(vertex);
        cornerWeights.push_back(Sdc::Crease::SHARPNESS_INFINITE);
    }

    Far::TopologyDescriptor::FVarChannel channel;
    channel.numValues = static_cast<int>(cage.uvs.size());
    channel.valueIndices = uvs.data();
    Far::TopologyDescriptor topology;
    topology.numVertices = static_cast<int>(cage.positions.size());
    topology.numFaces = static_cast<int>(sizes.size());
    topology.numVertsPerFace = sizes.data();
    topology.vertIndicesPerFace = vertices.data();
    topology.numCreases = static_cast<int>(creaseWeights.size());
    topology.creaseVertexIndexPairs = creaseVertices.data();
    topology.creaseWeights = creaseWeights.data();
    topology.numCorners = static_cast<int>(cornerWeights.size());
    topology.cornerVertexIndices = cornerVertices.data();
    topology.cornerWeights = cornerWeights.data();
    topology.numHoles = static_cast<int>(holes.size());
    topology.holeIndices = holes.data();
    if (!cage.uvs.empty()) {
        topology.numFVarChannels = 1;
        topology.fvarChannels = &channel;
    }
    using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
    const Sdc::SchemeType scheme =
        cage.scheme == SubdivisionCage::Scheme::Bilinear ? Sdc::SCHEME_BILINEAR : Sdc::SCHEME_CATMARK;
    std::unique_ptr<Far::TopologyRefiner> refiner(
        Factory::Create(topology, Factory::Options(scheme, schemeOptions(cage))));
    if (!refiner) throwBadInput({"the cage's topology cannot be subdivided", where, "", ""});
    return refiner;
}

}  // namespace lumi

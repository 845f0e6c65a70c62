#include "scene/subdivision.h"

#include <fmt/format.h>
#include <opensubdiv/bfr/refinerSurfaceFactory.h>
#include <opensubdiv/bfr/surface.h>
#include <opensubdiv/bfr/surfaceFactoryCache.h>
#include <opensubdiv/bfr/tessellation.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <unordered_map>

#include "base/error.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/subdivision_folds.h"
#include "scene/subdivision_refine.h"
#include "scene/subdivision_topology.h"

namespace lumi {
namespace {
namespace Bfr = OpenSubdiv::Bfr;
namespace Far = OpenSubdiv::Far;

using SharedCache = Bfr::SurfaceFactoryCacheThreaded<std::shared_mutex, std::shared_lock<std::shared_mutex>,
                                                     std::unique_lock<std::shared_mutex>>;
using Factory = Bfr::RefinerSurfaceFactory<SharedCache>;

void checkStop(const std::stop_token& stop, const std::string& where) {
    if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"loading was stopped", where, "", ""});
}

/// Where one base face's vertices, triangles and weights go.
struct FaceSpan {
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t firstTriangle = 0, triangleCount = 0;
    std::vector<uint32_t> controls;  // cage vertices that the face's surface depends on
};

/// Bytes of a weight of the finished table, and of one while its face is tessellated: see SubdivisionSurface.
constexpr uint64_t kWeightBytes = sizeof(uint32_t) + 3 * sizeof(float), kFaceWeightBytes = 3 * sizeof(float);
/// What a vertex takes beside its weights.
constexpr uint64_t kVertexBytes = 100;

/// About how many cage vertices each face's surface depends on: those of all faces at its corners. Exact among quads
/// inside of a cage; a corner where many faces meet adds them all to each of these.
std::vector<uint64_t> countControls(const Far::TopologyLevel& level) {
    std::vector<int64_t> added(static_cast<size_t>(level.GetNumVertices()));
    for (int v = 0; v < level.GetNumVertices(); ++v) {
        added[static_cast<size_t>(v)] = level.GetVertexEdges(v).size();
        for (const int face : level.GetVertexFaces(v))
            added[static_cast<size_t>(v)] += level.GetFaceVertices(face).size() - 3;
    }
    std::vector<uint64_t> controls(static_cast<size_t>(level.GetNumFaces()));
    for (int face = 0; face < level.GetNumFaces(); ++face) {
        const auto corners = level.GetFaceVertices(face);
        int64_t sum = 0;
        for (const int v : corners) sum += added[static_cast<size_t>(v)] - corners.size();
        controls[static_cast<size_t>(face)] = static_cast<uint64_t>(std::max<int64_t>(sum, corners.size()));
    }
    return controls;
}

std::vector<FaceSpan> planFaces(const Factory& factory, const Far::TopologyLevel& level, int rate,
                                const std::string& where) {
    const int faceCount = level.GetNumFaces();
    const std::vector<uint64_t> controls = countControls(level);
    std::vector<FaceSpan> spans(static_cast<size_t>(faceCount));
    uint64_t vertices = 0, triangles = 0, weights = 0;
    for (int face = 0; face < faceCount; ++face) {
        FaceSpan& span = spans[static_cast<size_t>(face)];
        span.firstVertex = static_cast<uint32_t>(vertices);
        span.firstTriangle = static_cast<uint32_t>(triangles);
        if (!factory.FaceHasLimitSurface(face)) continue;
        const Bfr::Tessellation pattern(factory.GetFaceParameterization(face), rate);
        span.vertexCount = static_cast<uint32_t>(pattern.GetNumCoords());
        span.triangleCount = static_cast<uint32_t>(pattern.GetNumFacets());
        vertices += span.vertexCount;
        triangles += span.triangleCount;
        weights += span.vertexCount * controls[static_cast<size_t>(face)];
    }
    if (triangles > uint64_t(1) << 30)
        throwBadInput({"tessellates into too many triangles", where, "at most 2^30", fmt::format("{}", triangles)});
    checkMemory(fmt::format("tessellating {}", where),
                vertices * kVertexBytes + triangles * 20 + weights * (kWeightBytes + kFaceWeightBytes));
    return spans;
}

/// Coordinates, triangles and texture coordinates of one face, and the weights of its vertices over the cage.
class FaceTessellator {
public:
    FaceTessellator(const SubdivisionCage& cage, const Factory& factory, int rate)
        : cage_(cage), factory_(factory), rate_(rate) {}

    void run(int face, FaceSpan& span, std::vector<std::vector<float>>& rows, SubdivisionSurface& out) const {
        Bfr::Surface<float> surface;
        factory_.InitVertexSurface(face, &surface);
        const Bfr::Tessellation pattern(surface.GetParameterization(), rate_);
        std::vector<float> coordinates(2 * span.vertexCount);
        pattern.GetCoords(coordinates.data());

        std::vector<int> controls(static_cast<size_t>(surface.GetNumControlPoints()));
        surface.GetControlPointIndices(controls.data());
        span.controls.assign(controls.begin(), controls.end());
        const size_t n = controls.size();
        std::vector<float>& weights = rows[static_cast<size_t>(face)];
        weights.resize(3 * n * span.vertexCount);
        for (uint32_t v = 0; v < span.vertexCount; ++v) {
            float* row = &weights[3 * n * v];
            surface.EvaluateStencil(&coordinates[2 * v], row, row + n, row + 2 * n);
            out.faceCoordinates[span.firstVertex + v] = {coordinates[2 * v], coordinates[2 * v + 1]};
        }
        writeTriangles(pattern, span, static_cast<uint32_t>(face), out);
        if (!cage_.uvs.empty()) writeUvs(face, span, coordinates, out);
    }

private:
    void writeTriangles(const Bfr::Tessellation& pattern, const FaceSpan& span, uint32_t face,
                        SubdivisionSurface& out) const {
        std::vector<int> facets(3 * static_cast<size_t>(span.triangleCount));
        pattern.GetFacets(facets.data());
        for (uint32_t t = 0; t < span.triangleCount; ++t) {
            const auto corner = [&](uint32_t c) { return span.firstVertex + static_cast<uint32_t>(facets[3 * t + c]); };
            out.mesh.triangles[span.firstTriangle + t] = {corner(0), corner(1), corner(2)};
            out.triangleFace[span.firstTriangle + t] = face;
            if (!cage_.faceMaterials.empty())
                out.mesh.triangleMaterial[span.firstTriangle + t] = cage_.faceMaterials[face];
        }
    }
    void writeUvs(int face, const FaceSpan& span, const std::vector<float>& coordinates,
                  SubdivisionSurface& out) const {
        Bfr::Surface<float> surface;
        if (!factory_.InitFaceVaryingSurface(face, &surface)) return;
        std::vector<float> points(2 * static_cast<size_t>(surface.GetNumPatchPoints()));
        surface.PreparePatchPoints(&cage_.uvs[0].x, Bfr::Surface<float>::PointDescriptor(2), points.data(),
                                   Bfr::Surface<float>::PointDescriptor(2));
        for (uint32_t v = 0; v < span.vertexCount; ++v)
            surface.Evaluate(&coordinates[2 * v], points.data(), Bfr::Surface<float>::PointDescriptor(2),
                             &out.mesh.uv[0][span.firstVertex + v].x);
    }
    const SubdivisionCage& cage_;
    const Factory& factory_;
    int rate_;
};

/// Makes room for `more` weights in the table of rows.
void reserveWeights(SubdivisionSurface& out, uint64_t more, const std::string& where) {
    const uint64_t there = out.weight.size(), room = out.weight.capacity();
    if (there + more > std::numeric_limits<uint32_t>::max())
        throwBadInput({"a vertex where too many faces meet, for so fine a tessellation", where, "", ""});
    if (room - there >= more) return;
    const uint64_t wanted = std::max(there + more, 2 * room);
    checkMemory(fmt::format("tessellating {}", where), wanted * kWeightBytes);
    out.cageVertex.reserve(wanted);
    for (std::vector<float>* table : {&out.weight, &out.tangentU, &out.tangentV}) table->reserve(wanted);
}

/// Concatenates the faces' weights into one table of rows, and frees them.
void gatherRows(const std::vector<FaceSpan>& spans, std::vector<std::vector<float>> rows, const std::string& where,
                SubdivisionSurface& out) {
    uint64_t weights = 0;
    for (const std::vector<float>& ofFace : rows) weights += ofFace.size() / 3;
    reserveWeights(out, weights, where);
    out.first.assign(1, 0);
    for (size_t face = 0; face < spans.size(); ++face) {
        const size_t n = spans[face].controls.size();
        for (uint32_t v = 0; v < spans[face].vertexCount; ++v) {
            const float* row = &rows[face][3 * n * v];
            for (size_t k = 0; k < n; ++k) {
                if (row[k] == 0 && row[n + k] == 0 && row[2 * n + k] == 0) continue;
                out.cageVertex.push_back(spans[face].controls[k]);
                out.weight.push_back(row[k]);
                out.tangentU.push_back(row[n + k]);
                out.tangentV.push_back(row[2 * n + k]);
            }
            out.first.push_back(static_cast<uint32_t>(out.weight.size()));
        }
        rows[face] = {};
    }
}

/// Finds vertices of different faces that are the same point of a cage vertex or edge. The boundary of a face's pattern
/// begins at its first corner and runs counter-clockwise, corner by corner with the points of the edge between.
void findShared(const Far::TopologyLevel& level, const Factory& factory, int rate, const std::vector<FaceSpan>& spans,
                SubdivisionSurface& out) {
    std::unordered_map<uint64_t, uint32_t> seen;
    const auto meet = [&](uint64_t key, uint32_t vertex) {
        const auto [place, isNew] = seen.emplace(key, vertex);
        if (!isNew) out.shared.emplace_back(vertex, place->second);
    };
    for (size_t face = 0; face < spans.size(); ++face) {
        if (spans[face].vertexCount == 0) continue;
        const auto corners = level.GetFaceVertices(static_cast<int>(face));
        const auto edges = level.GetFaceEdges(static_cast<int>(face));
        const Bfr::Tessellation pattern(factory.GetFaceParameterization(static_cast<int>(face)), rate);
        uint32_t vertex = spans[face].firstVertex;
        for (int e = 0; e < corners.size(); ++e) {
            meet(static_cast<uint64_t>(corners[e]), vertex++);
            const int inner = pattern.GetNumEdgeCoords(e);
            const bool forward = level.GetEdgeVertices(edges[e])[0] == corners[e];
            for (int k = 0; k < inner; ++k, ++vertex) {
                const auto place = static_cast<uint64_t>(forward ? k : inner - 1 - k);
                meet((uint64_t(1) << 63) | (static_cast<uint64_t>(edges[e]) << 16) | place, vertex);
            }
        }
    }
}

SubdivisionSurface tessellateFaces(const SubdivisionCage& cage, const Far::TopologyRefiner& refiner, int rate,
                                   bool shareTopology, const std::string& where, const std::stop_token& stop) {
    Factory::Options options;
    options.SetDefaultFVarID(cage.uvs.empty() ? -1 : 0);
    options.EnableCaching(shareTopology);
    const Factory factory(refiner, options);
    const auto faceCount = static_cast<int>(cage.faceSizes.size());
    std::vector<FaceSpan> spans = planFaces(factory, refiner.GetLevel(0), rate, where);

    SubdivisionSurface out;
    const size_t vertices = spans.empty() ? 0 : spans.back().firstVertex + spans.back().vertexCount;
    const size_t triangles = spans.empty() ? 0 : spans.back().firstTriangle + spans.back().triangleCount;
    out.mesh.name = cage.name;
    out.mesh.material = cage.material;
    out.mesh.triangles.resize(triangles);
    out.triangleFace.resize(triangles);
    out.faceCoordinates.resize(vertices);
    if (!cage.faceMaterials.empty()) out.mesh.triangleMaterial.resize(triangles);
    if (!cage.uvs.empty()) out.mesh.uv[0].resize(vertices);

    std::vector<std::vector<float>> rows(spans.size());
    const FaceTessellator tessellator(cage, factory, rate);
    parallelRanges(
        faceCount, 32,
        [&](int64_t begin, int64_t end) {
            for (int64_t face = begin; face < end; ++face)
                if (spans[static_cast<size_t>(face)].vertexCount > 0)
                    tessellator.run(static_cast<int>(face), spans[static_cast<size_t>(face)], rows, out);
        },
        stop);
    checkStop(stop, where);
    gatherRows(spans, std::move(rows), where, out);
    findShared(refiner.GetLevel(0), factory, rate, spans, out);
    return out;
}

/// Rows over the refined cage become rows over the coarse one.
void composeRows(const std::vector<RefinedCage::Row>& vertices, const std::string& where, const std::stop_token& stop,
                 SubdivisionSurface& out) {
    struct Sums {
        float weight = 0, u = 0, v = 0;
    };
    const SubdivisionSurface fine = std::move(out);
    out = {};
    out.first.assign(1, 0);
    for (size_t row = 0; row + 1 < fine.first.size(); ++row) {
        checkStop(stop, where);
        std::map<uint32_t, Sums> sums;
        for (uint32_t k = fine.first[row]; k < fine.first[row + 1]; ++k)
            for (const auto& [vertex, weight] : vertices[fine.cageVertex[k]].weights) {
                Sums& sum = sums[vertex];
                sum.weight += weight * fine.weight[k];
                sum.u += weight * fine.tangentU[k];
                sum.v += weight * fine.tangentV[k];
            }
        reserveWeights(out, sums.size(), where);
        for (const auto& [vertex, sum] : sums) {
            out.cageVertex.push_back(vertex);
            out.weight.push_back(sum.weight);
            out.tangentU.push_back(sum.u);
            out.tangentV.push_back(sum.v);
        }
        out.first.push_back(static_cast<uint32_t>(out.weight.size()));
    }
    out.mesh = fine.mesh;
    out.triangleFace = fine.triangleFace;
    out.faceCoordinates = fine.faceCoordinates;
    out.shared = fine.shared;
}

/// A child's (u, v) in its parent's parameterisation: a quarter of a quad, its corners in the quad's own order; of any
/// other face child i is the sub-face whose origin is corner i.
Vec2 parentCoordinates(const RefinedCage& refined, uint32_t face, const Vec2& uv) {
    const uint32_t child = refined.childOfFace[face], size = refined.parentSize[face];
    if (size == 4) {
        constexpr float kOrigin[4][2] = {{0, 0}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}};
        return Vec2(kOrigin[child][0], kOrigin[child][1]) + 0.5f * uv;
    }
    const Bfr::Parameterization parent(OpenSubdiv::Sdc::SCHEME_CATMARK, static_cast<int>(size));
    Vec2 result;
    parent.ConvertNormalizedSubFaceToCoord(static_cast<int>(child), &uv.x, &result.x);
    return result;
}

/// Tessellates what can be handed to OpenSubdiv, or refines it until it can. `levels`: how often that was done already.
SubdivisionSurface tessellateSafely(const SubdivisionCage& cage, int rate, int levels, const std::string& where,
                                    const std::stop_token& stop) {
    const std::unique_ptr<Far::TopologyRefiner> refiner = makeRefiner(cage, where);
    const Far::TopologyLevel& level = refiner->GetLevel(0);
    const bool refine = levels == 0 ? hasFolds(level) || hasCrowdedCreases(level) : hasOpenFolds(level);
    if (!refine) return tessellateFaces(cage, *refiner, rate, levels == 0, where, stop);

    const RefinedCage refined = refineOnce(cage, where);
    SubdivisionSurface out = tessellateSafely(refined.cage, (rate + 1) / 2, levels + 1, where, stop);
    std::vector<bool> isDone(out.faceCoordinates.size(), false);
    for (size_t t = 0; t < out.triangleFace.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const uint32_t vertex = out.mesh.triangles[t][corner];
            if (isDone[vertex]) continue;
            isDone[vertex] = true;
            out.faceCoordinates[vertex] = parentCoordinates(refined, out.triangleFace[t], out.faceCoordinates[vertex]);
        }
        out.triangleFace[t] = refined.parentFace[out.triangleFace[t]];
    }
    composeRows(refined.vertices, where, stop, out);
    return out;
}

}  // namespace

SubdivisionSurface tessellate(const SubdivisionCage& cage, int rate, const std::string& where, std::stop_token stop) {
    if (rate < 1 || rate > 64)
        throwBadInput({"the tessellation rate is out of range", where, "1 to 64", fmt::format("{}", rate)});
    SubdivisionSurface out = tessellateSafely(cage, rate, 0, where, stop);
    out.evaluate(cage.positions, out.mesh.positions, out.mesh.normals);
    return out;
}

void SubdivisionSurface::evaluate(const std::vector<Vec3>& cage, std::vector<Vec3>& positions,
                                  std::vector<Vec3>& normals) const {
    const size_t count = first.size() - 1;
    positions.resize(count);
    normals.resize(count);
    parallelRanges(static_cast<int64_t>(count), 1024, [&](int64_t begin, int64_t end) {
        for (auto v = static_cast<size_t>(begin); v < static_cast<size_t>(end); ++v) {
            Vec3 p(0), du(0), dv(0);
            for (uint32_t k = first[v]; k < first[v + 1]; ++k) {
                const Vec3& c = cage[cageVertex[k]];
                p += weight[k] * c;
                du += tangentU[k] * c;
                dv += tangentV[k] * c;
            }
            positions[v] = p;
            const Vec3 normal = glm::cross(du, dv);
            const float length = glm::length(normal);
            normals[v] = length > 0 && std::isfinite(length) ? normal / length : Vec3(0, 1, 0);
        }
    });
    for (const auto& [vertex, source] : shared) positions[vertex] = positions[source];
}

}  // namespace lumi

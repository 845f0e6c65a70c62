#pragma once
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "scene/mesh.h"

namespace lumi {

/// A control cage: polygons of any size over shared vertices, with OpenSubdiv's tags.
struct SubdivisionCage {
    enum class Scheme : uint8_t { CatmullClark, Bilinear };
    enum class Boundary : uint8_t { None, EdgeOnly, EdgeAndCorner };
    enum class FaceVarying : uint8_t { Smooth, CornersOnly, CornersPlus1, CornersPlus2, Boundaries, Linear };
    struct Crease {
        uint32_t a = 0, b = 0;  ///< end vertices of an edge
        float sharpness = 0;    ///< 10 and above is infinitely sharp
    };
    struct Corner {
        uint32_t vertex = 0;
        float sharpness = 0;
    };

    std::string name;
    std::vector<Vec3> positions;
    std::vector<uint32_t> faceSizes;      ///< corners of each face, 3 or more
    std::vector<uint32_t> faceVertices;   ///< of all faces, one after the other, counter-clockwise
    std::vector<Vec2> uvs;                ///< face-varying; empty: none
    std::vector<uint32_t> faceUvs;        ///< as faceVertices, into uvs
    std::vector<uint32_t> faceMaterials;  ///< one a face; empty: `material`
    uint32_t material = 0;
    std::vector<Crease> creases;
    std::vector<Corner> corners;
    std::vector<uint32_t> holes;  ///< faces that are not drawn
    Scheme scheme = Scheme::CatmullClark;
    Boundary boundary = Boundary::EdgeAndCorner;
    FaceVarying faceVarying = FaceVarying::CornersOnly;
    bool chaikin = false;          ///< crease sharpness by Chaikin's rule
    bool smoothTriangles = false;  ///< the triangle rule for Catmull-Clark
};

/// A cage's limit surface as triangles whose topology never changes, whatever the cage does. Every base face has
/// vertices of its own; those on shared edges have equal positions, bit for bit, so the surface has no cracks.
struct SubdivisionSurface {
    Mesh mesh;                           ///< limit positions, limit normals, uv[0] if the cage has any
    std::vector<uint32_t> triangleFace;  ///< base face of each triangle
    std::vector<Vec2> faceCoordinates;   ///< of each vertex, in OpenSubdiv's parameterisation of its base face

    /// Rows of weights over cage vertices: position, and the two tangents whose cross product is the normal.
    /// Row v is [first[v], first[v + 1]).
    std::vector<uint32_t> first, cageVertex;
    std::vector<float> weight, tangentU, tangentV;
    /// Vertices that take the position of another one (the same point of a shared edge): (vertex, source) pairs.
    std::vector<std::pair<uint32_t, uint32_t>> shared;

    /// Positions and unit normals for a moved cage of the same topology; both get mesh.positions.size() entries.
    void evaluate(const std::vector<Vec3>& cage, std::vector<Vec3>& positions, std::vector<Vec3>& normals) const;
};

/// Tessellates the limit surface [OpenSubdiv 3.5, Bfr] with `rate` segments along every edge of the cage, on all
/// threads; where OpenSubdiv needs the cage refined first (subdivision_folds.h), the rate goes up to an even number, or
/// to a multiple of four. Throws Error(BadInput) headed by `where`: indices out of range, fewer than three corners,
/// topology that cannot be refined, `rate` outside 1 to 64; Error(Resources) beyond the memory limit;
/// Error(Interrupted) once stopped, which is looked at between faces.
SubdivisionSurface tessellate(const SubdivisionCage& cage, int rate, const std::string& where,
                              std::stop_token stop = {});

}  // namespace lumi

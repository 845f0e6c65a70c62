#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "math/transform.h"
#include "scene/mesh.h"

namespace lumi {

/// A vertex of a generated surface.
struct SurfaceVertex {
    Vec3 position{0};
    Vec3 normal{0, 1, 0};
    Vec2 uv{0};
};

/// Collects generated geometry, slot by slot. Vertices keep the order in which they were added.
class MeshBuilder {
public:
    /// Slot of the triangles added from here on: an index into ProceduralResult::slots.
    void useSlot(uint32_t slot) { slot_ = slot; }

    uint32_t addVertex(const SurfaceVertex& vertex);
    /// Counter-clockwise seen from the front. A triangle with two corners in the same place is left out.
    void addTriangle(uint32_t a, uint32_t b, uint32_t c);
    /// a b c d run counter-clockwise; split along the shorter diagonal.
    void addQuad(uint32_t a, uint32_t b, uint32_t c, uint32_t d);
    /// A flat four-sided patch with its own vertices, normal from its corners; uv (0,1) (1,1) (1,0) (0,0).
    void addPatch(const std::array<Vec3, 4>& corners, Vec2 uvScale = Vec2(1));

    /// (columns + 1) x (rows + 1) vertices; the front is where columns run to the right and rows upwards.
    using GridSurface = std::function<SurfaceVertex(int column, int row)>;
    void addGrid(int columns, int rows, const GridSurface& surface);

    /// Appends another mesh, carried by `transform`, in the present slot. Normals stay unit; mirroring flips the
    /// triangles so that fronts stay outside.
    void append(const Mesh& mesh, const Mat4& transform = Mat4(1));

    size_t triangleCount() const { return mesh_.triangles.size(); }
    /// Hands over the mesh; one slot throughout is stored as Mesh::material. The builder is empty afterwards.
    Mesh take(std::string name = {});

private:
    Mesh mesh_;
    std::vector<uint32_t> slots_;
    uint32_t slot_ = 0;
};

/// Point `index` of `count` on the unit circle; index `count` is bit-equal to index 0, so that seams close.
/// x is the cosine, y the sine.
Vec2 circlePoint(int index, int count);

}  // namespace lumi

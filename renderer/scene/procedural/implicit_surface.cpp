#include "scene/procedural/implicit_surface.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/parallel.h"

namespace lumi {
namespace {

/// Minimum that is smooth where the two are nearer than `width`: the quadratic polynomial of [Quilez 2013, "smooth
/// minimum"].
float smoothMin(float a, float b, float width) {
    if (width <= 0) return std::min(a, b);
    const float h = std::max(width - std::abs(a - b), 0.0f) / width;
    return std::min(a, b) - h * h * width * 0.25f;
}

/// Values of the field at the corners of cubes, x fastest.
class FieldGrid {
public:
    FieldGrid(const std::function<float(const Vec3&)>& field, const Bounds3& box, float cell)
        : field_(field), low_(box.lower), cell_(cell) {
        for (int axis = 0; axis < 3; ++axis)
            count_[axis] = static_cast<int>(std::ceil((box.upper[axis] - box.lower[axis]) / cell)) + 1;
        values_.resize(static_cast<size_t>(count_[0]) * static_cast<size_t>(count_[1]) *
                       static_cast<size_t>(count_[2]));
        const int blocks = (count_[2] + kBlock - 1) / kBlock;
        parallelFor(blocks, [&](int64_t block) { fillSlab(static_cast<int>(block) * kBlock); });
    }

    int count(int axis) const { return count_[axis]; }
    size_t index(int x, int y, int z) const {
        return (static_cast<size_t>(z) * static_cast<size_t>(count_[1]) + static_cast<size_t>(y)) *
                   static_cast<size_t>(count_[0]) +
               static_cast<size_t>(x);
    }
    float value(int x, int y, int z) const { return values_[index(x, y, z)]; }
    Vec3 corner(int x, int y, int z) const {
        return low_ + cell_ * Vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
    }

private:
    static constexpr int kBlock = 4;

    /// Far from the surface a block has one value: only its sign counts there.
    void fillSlab(int z0) {
        const float half = 0.5f * kBlock * cell_, far = 1.6f * 1.7321f * half;
        for (int y0 = 0; y0 < count_[1]; y0 += kBlock)
            for (int x0 = 0; x0 < count_[0]; x0 += kBlock) {
                const float middle = field_(corner(x0, y0, z0) + Vec3(half));
                for (int z = z0; z < std::min(z0 + kBlock, count_[2]); ++z)
                    for (int y = y0; y < std::min(y0 + kBlock, count_[1]); ++y)
                        for (int x = x0; x < std::min(x0 + kBlock, count_[0]); ++x)
                            values_[index(x, y, z)] = std::abs(middle) > far ? middle : field_(corner(x, y, z));
            }
    }

    const std::function<float(const Vec3&)>& field_;
    Vec3 low_;
    float cell_;
    int count_[3] = {};
    std::vector<float> values_;
};

/// Mean of the places where the cell's edges cross the surface; nothing if its corners lie on one side.
bool cellPoint(const FieldGrid& grid, int x, int y, int z, Vec3& point) {
    float corner[8];
    int inside = 0;
    for (int i = 0; i < 8; ++i) {
        corner[i] = grid.value(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2));
        inside += corner[i] < 0;
    }
    if (inside == 0 || inside == 8) return false;
    Vec3 sum(0);
    float crossings = 0;
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const int j = i | 1 << axis;
            if (i == j || (corner[i] < 0) == (corner[j] < 0)) continue;
            const Vec3 a = grid.corner(x + (i & 1), y + (i >> 1 & 1), z + (i >> 2)),
                       b = grid.corner(x + (j & 1), y + (j >> 1 & 1), z + (j >> 2));
            sum += glm::mix(a, b, corner[i] / (corner[i] - corner[j]));
            crossings += 1;
        }
    point = sum / crossings;
    return true;
}

Vec3 gradientAt(const std::function<float(const Vec3&)>& field, const Vec3& p, float step) {
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 offset(0);
        offset[axis] = step;
        gradient[axis] = (field(p + offset) - field(p - offset)) / (2 * step);
    }
    return gradient;
}

/// Two triangles, split along the shorter diagonal; `turned` faces the other way.
void addQuad(Mesh& mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool turned) {
    if (turned) std::swap(b, d);
    const auto apart = [&](uint32_t i, uint32_t j) { return glm::distance(mesh.positions[i], mesh.positions[j]); };
    if (apart(a, c) <= apart(b, d)) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
    }
}

/// A quad for every grid edge that crosses the surface, between the four cells around it.
void addFaces(const FieldGrid& grid, const std::vector<uint32_t>& vertexOf, Mesh& mesh) {
    for (int z = 1; z + 1 < grid.count(2); ++z)
        for (int y = 1; y + 1 < grid.count(1); ++y)
            for (int x = 1; x + 1 < grid.count(0); ++x) {
                const bool inside = grid.value(x, y, z) < 0;
                const auto cell = [&](int dx, int dy, int dz) { return vertexOf[grid.index(x - dx, y - dy, z - dz)]; };
                if ((grid.value(x + 1, y, z) < 0) != inside)
                    addQuad(mesh, cell(0, 1, 1), cell(0, 0, 1), cell(0, 0, 0), cell(0, 1, 0), !inside);
                if ((grid.value(x, y + 1, z) < 0) != inside)
                    addQuad(mesh, cell(1, 0, 1), cell(1, 0, 0), cell(0, 0, 0), cell(0, 0, 1), !inside);
                if ((grid.value(x, y, z + 1) < 0) != inside)
                    addQuad(mesh, cell(1, 1, 0), cell(0, 1, 0), cell(0, 0, 0), cell(1, 0, 0), !inside);
            }
}

Vec3 upward(const Vec3& gradient) {
    const float length = glm::length(gradient);
    return length > 0 ? gradient / length : Vec3(0, 1, 0);
}

/// In creases a few triangles may face against their normals: the shortest edge of each is drawn together, which takes
/// it away with its neighbour and leaves the surface closed.
void unfold(Mesh& mesh, const std::function<Vec3(const Vec3&)>& normalAt) {
    for (int pass = 0; pass < 8; ++pass) {
        std::map<uint32_t, uint32_t> drawnTo;
        for (const UVec3& t : mesh.triangles) {
            const Vec3 a = mesh.positions[t.x], face = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
            if (glm::dot(face, mesh.normals[t.x] + mesh.normals[t.y] + mesh.normals[t.z]) >= 0) continue;
            glm::length_t k = 0;
            const auto edge = [&](glm::length_t i) {
                return glm::distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]);
            };
            for (const glm::length_t i : {1, 2})
                if (edge(i) < edge(k)) k = i;
            const uint32_t kept = t[k], gone = t[(k + 1) % 3];
            if (drawnTo.count(kept) || drawnTo.count(gone)) continue;
            drawnTo[gone] = drawnTo[kept] = kept;
            mesh.positions[kept] = 0.5f * (mesh.positions[kept] + mesh.positions[gone]);
            mesh.normals[kept] = normalAt(mesh.positions[kept]);
        }
        if (drawnTo.empty()) return;
        for (UVec3& t : mesh.triangles)
            for (glm::length_t i = 0; i < 3; ++i)
                if (const auto found = drawnTo.find(t[i]); found != drawnTo.end()) t[i] = found->second;
        std::erase_if(mesh.triangles, [](const UVec3& t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
    }
}

}  // namespace

void SoftBody::addCone(const Vec3& a, const Vec3& b, float radiusA, float radiusB, float blend) {
    pieces_.push_back({a, b, radiusA, radiusB, blend, false, false});
}

void SoftBody::addEllipsoid(const Vec3& centre, const Vec3& radii, float blend) {
    pieces_.push_back({centre, radii, 0, 0, blend, true, false});
}

void SoftBody::carveCone(const Vec3& a, const Vec3& b, float radiusA, float radiusB, float blend) {
    pieces_.push_back({a, b, radiusA, radiusB, blend, false, true});
}

float SoftBody::Piece::distance(const Vec3& p) const {
    if (ellipsoid) {
        // No more than the distance, exact near the surface [Quilez, "distance to an ellipsoid": a bound].
        const float k0 = glm::length((p - a) / b), k1 = glm::length((p - a) / (b * b));
        return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({b.x, b.y, b.z});
    }
    const Vec3 way = b - a;
    const float squared = glm::dot(way, way),
                t = squared > 0 ? std::clamp(glm::dot(p - a, way) / squared, 0.0f, 1.0f) : 0;
    return glm::length(p - a - t * way) - glm::mix(radiusA, radiusB, t);
}

float SoftBody::distance(const Vec3& p) const {
    float d = 1e3f;
    for (const Piece& piece : pieces_) {
        const float own = piece.distance(p);
        d = piece.carved ? -smoothMin(-d, own, piece.blend) : smoothMin(d, own, piece.blend);
    }
    return d;
}

Mesh surfaceOf(const std::function<float(const Vec3&)>& field, const Bounds3& box, float cell) {
    const FieldGrid grid(field, box, cell);
    std::vector<uint32_t> vertexOf(static_cast<size_t>(grid.count(0)) * static_cast<size_t>(grid.count(1)) *
                                   static_cast<size_t>(grid.count(2)));
    Mesh mesh;
    for (int z = 0; z + 1 < grid.count(2); ++z)
        for (int y = 0; y + 1 < grid.count(1); ++y)
            for (int x = 0; x + 1 < grid.count(0); ++x)
                if (Vec3 point; cellPoint(grid, x, y, z, point)) {
                    vertexOf[grid.index(x, y, z)] = static_cast<uint32_t>(mesh.positions.size());
                    mesh.positions.push_back(point);
                }
    addFaces(grid, vertexOf, mesh);
    mesh.normals.resize(mesh.positions.size());
    parallelRanges(static_cast<int64_t>(mesh.positions.size()), 512, [&](int64_t begin, int64_t end) {
        for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            Vec3& p = mesh.positions[i];
            Vec3 gradient(0, 1, 0);
            for (int step = 0; step < 3; ++step) {
                gradient = gradientAt(field, p, 0.25f * cell);
                const Vec3 move = gradient * (field(p) / std::max(glm::dot(gradient, gradient), 0.05f));
                const float length = glm::length(move), most = 0.4f * cell;
                p -= length > most ? move * (most / length) : move;
            }
            mesh.normals[i] = upward(gradient);
        }
    });
    unfold(mesh, [&](const Vec3& p) { return upward(gradientAt(field, p, 0.25f * cell)); });
    mesh.uv[0].assign(mesh.positions.size(), Vec2(0));
    return mesh;
}

}  // namespace lumi

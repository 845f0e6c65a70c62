#include "scene/obj/obj_mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "base/error.h"
#include "math/hash.h"
#include "scene/mesh_edit.h"
#include "scene/obj/triangulate.h"

namespace lumi {
namespace {

constexpr size_t kPollStride = 256;  ///< faces between two looks at the stop

/// What makes two corners the same vertex. `group` tells corners without normal apart: smoothing group, or face.
struct Corner {
    int position = -1, uv = -1, normal = -1;
    int64_t group = 0;
    bool operator==(const Corner&) const = default;
};
struct CornerHash {
    size_t operator()(const Corner& c) const {
        const uint64_t a = (uint64_t(uint32_t(c.position)) << 32) | uint32_t(c.uv);
        return mixBits(mixBits(a) ^ mixBits((uint64_t(uint32_t(c.normal)) << 32) + static_cast<uint64_t>(c.group)));
    }
};

/// A triangle's unit normal times its angle at `here`: sums do not depend on how polygons were cut.
Vec3 weightedNormal(const Vec3& here, const Vec3& next, const Vec3& last) {
    const Vec3 a = next - here, b = last - here, normal = glm::cross(a, b);
    const float length = glm::length(normal);
    return length > 0 ? normal * (std::atan2(length, glm::dot(a, b)) / length) : Vec3(0);
}

class ShapeReader {
public:
    ShapeReader(const tinyobj::attrib_t& attributes, const tinyobj::shape_t& shape, uint32_t fallbackMaterial,
                const std::string& where, const std::stop_token& stop)
        : attributes_(attributes), source_(shape.mesh), fallback_(fallbackMaterial), where_(where), stop_(stop) {
        mesh_.name = shape.name;
        const size_t corners =
            std::accumulate(source_.num_face_vertices.begin(), source_.num_face_vertices.end(), size_t(0));
        if (corners != source_.indices.size())
            throwBadInput({.what = "a face has too many corners", .where = where, .expected = "at most 255"});
        for (const tinyobj::index_t& index : source_.indices) {
            checkIndex(index.vertex_index, attributes.vertices.size() / 3, false, "vertex");
            checkIndex(index.texcoord_index, attributes.texcoords.size() / 2, true, "texture coordinate");
            checkIndex(index.normal_index, attributes.normals.size() / 3, true, "normal");
            anyUv_ |= index.texcoord_index >= 0;
            anyNormal_ |= index.normal_index >= 0;
        }
        for (const unsigned int group : source_.smoothing_group_ids) anySmooth_ |= group != 0;
    }

    Mesh read() {
        size_t first = 0;
        for (size_t face = 0; face < source_.num_face_vertices.size(); ++face) {
            if (face % kPollStride == 0 && stop_.stop_requested())
                throw Error(ErrorKind::Interrupted, {.what = "loading was stopped", .where = where_});
            const size_t count = source_.num_face_vertices[face];
            if (count >= 3) addFace(face, first, count);
            first += count;
        }
        if (!normalSums_.empty()) finishNormals();
        std::vector<Mesh> parts;
        parts.push_back(std::move(mesh_));
        return mergeMeshes(std::move(parts));
    }

private:
    void checkIndex(int index, size_t count, bool optional, const char* what) const {
        if ((optional && index == -1) || (index >= 0 && static_cast<size_t>(index) < count)) return;
        throwBadInput({.what = std::string("a face refers to a ") + what + " that does not exist",
                       .where = where_,
                       .expected = "1 to " + std::to_string(count),
                       .found = std::to_string(index + 1)});
    }
    Vec3 positionOf(int i) const {
        const float* p = &attributes_.vertices[3 * static_cast<size_t>(i)];
        return {p[0], p[1], p[2]};
    }
    /// Normals are kept when the file has some or asks for smooth groups; else faces are flat without any.
    bool keepsNormals() const { return anyNormal_ || anySmooth_; }

    void addFace(size_t face, size_t first, size_t count) {
        std::vector<Vec3> corners(count);
        for (size_t c = 0; c < count; ++c) corners[c] = positionOf(source_.indices[first + c].vertex_index);
        const unsigned int smoothing =
            face < source_.smoothing_group_ids.size() ? source_.smoothing_group_ids[face] : 0;
        const int64_t group = smoothing != 0 ? int64_t(smoothing) : -1 - int64_t(face);
        const int id = face < source_.material_ids.size() ? source_.material_ids[face] : -1;
        for (const UVec3& t : triangulatePolygon(corners)) {
            UVec3 triangle;
            for (int c = 0; c < 3; ++c)
                triangle[c] = vertexOf(source_.indices[first + t[c]], group,
                                       weightedNormal(corners[t[c]], corners[t[(c + 1) % 3]], corners[t[(c + 2) % 3]]));
            mesh_.triangles.push_back(triangle);
            mesh_.triangleMaterial.push_back(id < 0 ? fallback_ : static_cast<uint32_t>(id));
        }
    }

    uint32_t vertexOf(const tinyobj::index_t& index, int64_t group, const Vec3& share) {
        const bool computed = keepsNormals() && index.normal_index < 0;
        const Corner corner{index.vertex_index, index.texcoord_index, index.normal_index, computed ? group : 0};
        const auto [found, isNew] = vertices_.try_emplace(corner, static_cast<uint32_t>(mesh_.positions.size()));
        if (isNew) addVertex(index);
        if (computed) {
            const Corner seam{index.vertex_index, -1, -1, group};
            normalSums_[seam] += share;
            seams_.emplace_back(found->second, seam);
        }
        return found->second;
    }

    void addVertex(const tinyobj::index_t& index) {
        mesh_.positions.push_back(positionOf(index.vertex_index));
        if (anyUv_) {
            const float* t = index.texcoord_index < 0
                                 ? nullptr
                                 : &attributes_.texcoords[2 * static_cast<size_t>(index.texcoord_index)];
            mesh_.uv[0].push_back(t ? Vec2(t[0], 1 - t[1]) : Vec2(0));
        }
        if (keepsNormals()) {
            Vec3 normal(0, 1, 0);
            if (index.normal_index >= 0) {
                const float* n = &attributes_.normals[3 * static_cast<size_t>(index.normal_index)];
                const float length = glm::length(Vec3(n[0], n[1], n[2]));
                if (length > 0 && std::isfinite(length)) normal = Vec3(n[0], n[1], n[2]) / length;
            }
            mesh_.normals.push_back(normal);
        }
        if (attributes_.colors.size() == attributes_.vertices.size()) {
            const float* c = &attributes_.colors[3 * static_cast<size_t>(index.vertex_index)];
            mesh_.colours.emplace_back(glm::max(Vec3(c[0], c[1], c[2]), Vec3(0)), 1.0f);
        }
    }

    /// Vertices of one position and smoothing group share their normal, whatever their texture coordinates.
    void finishNormals() {
        for (const auto& [vertex, seam] : seams_) {
            const Vec3 sum = normalSums_[seam];
            const float length = glm::length(sum);
            if (length > 0) mesh_.normals[vertex] = sum / length;
        }
    }

    const tinyobj::attrib_t& attributes_;
    const tinyobj::mesh_t& source_;
    uint32_t fallback_;
    const std::string& where_;
    const std::stop_token& stop_;
    bool anyUv_ = false, anyNormal_ = false, anySmooth_ = false;
    Mesh mesh_;
    std::unordered_map<Corner, uint32_t, CornerHash> vertices_;
    std::unordered_map<Corner, Vec3, CornerHash> normalSums_;
    std::vector<std::pair<uint32_t, Corner>> seams_;
};

}  // namespace

Mesh meshFromShape(const tinyobj::attrib_t& attributes, const tinyobj::shape_t& shape, uint32_t fallbackMaterial,
                   const std::string& where, const std::stop_token& stop) {
    return ShapeReader(attributes, shape, fallbackMaterial, where, stop).read();
}

}  // namespace lumi

#include "scene/gltf/primitive.h"

#include "scene/gltf/values.h"

#include <algorithm>
#include <cmath>

#include "math/transform.h"
#include "scene/gltf/accessor.h"
#include "scene/reach.h"

namespace lumi::gltf {
namespace {

/// The accessor of an attribute, or -1.
int find(const std::map<std::string, int>& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
}

/// Attributes of one primitive; knows how many vertices there must be.
class VertexReader {
public:
    VertexReader(const Document& document, const std::string& path, size_t vertices, const DracoMesh* draco)
        : document_(document), path_(path), vertices_(vertices), draco_(draco) {}

    /// Empty if the attribute is absent.
    template <class T>
    std::vector<T> read(const std::map<std::string, int>& attributes, const std::string& name) const {
        const int accessor = find(attributes, name);
        if (accessor < 0) return {};
        std::vector<T> values = readVectors<T>(document_, accessor, path_ + "/" + name, decoded(name));
        expectLength(values.size(), name);
        return values;
    }

    std::vector<Vec4> readColours(const std::map<std::string, int>& attributes) const {
        const int accessor = find(attributes, "COLOR_0");
        if (accessor < 0) return {};
        const float most = mostOfPlainIntegers(accessor);
        if (most > 1)
            document_.warn(path_ + "/COLOR_0: integers that are not marked as normalized; read as if they were");
        std::vector<Vec4> colours;
        if (componentCount(document_, accessor, path_ + "/COLOR_0") == 4) {
            colours = read<Vec4>(attributes, "COLOR_0");
        } else {
            const std::vector<Vec3> rgb = read<Vec3>(attributes, "COLOR_0");
            colours.reserve(rgb.size());
            for (const Vec3& c : rgb) colours.emplace_back(c, most);
        }
        if (most > 1)
            for (Vec4& c : colours) c /= most;
        return colours;
    }

    SkinWeights readSkin(const std::map<std::string, int>& attributes) const {
        std::vector<std::vector<uint32_t>> joints;
        std::vector<std::vector<Vec4>> weights;
        for (int set = 0; find(attributes, "JOINTS_" + std::to_string(set)) >= 0; ++set) {
            const std::string joint = "JOINTS_" + std::to_string(set), weight = "WEIGHTS_" + std::to_string(set);
            if (find(attributes, weight) < 0) document_.fail(path_ + "/" + joint, "has no " + weight + " beside it");
            joints.push_back(readIntegers(document_, find(attributes, joint), 4, path_ + "/" + joint, decoded(joint)));
            weights.push_back(read<Vec4>(attributes, weight));
            expectLength(joints.back().size() / 4, joint);
        }
        SkinWeights skin;
        if (!joints.empty()) compress(joints, weights, skin);
        return skin;
    }

private:
    /// What 1 would be if the accessor's integers, which are not normalised, were; 1 of all others.
    float mostOfPlainIntegers(int index) const {
        const std::vector<tinygltf::Accessor>& accessors = document_.model().accessors;
        if (static_cast<size_t>(index) >= accessors.size()) return 1;  // refused where it is read
        const tinygltf::Accessor& accessor = accessors[static_cast<size_t>(index)];
        if (accessor.normalized) return 1;
        if (accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return 255;
        return accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ? 65535.0f : 1.0f;
    }

    const DecodedElements* decoded(const std::string& name) const { return draco_ ? draco_->find(name) : nullptr; }

    void expectLength(size_t length, const std::string& name) const {
        if (length != vertices_)
            document_.fail(path_ + "/" + name, "has another count than POSITION", std::to_string(vertices_),
                           std::to_string(length));
    }

    /// Rows without zero weights, normalised; a vertex without any weight follows joint 0.
    void compress(const std::vector<std::vector<uint32_t>>& joints, const std::vector<std::vector<Vec4>>& weights,
                  SkinWeights& skin) const {
        skin.first.reserve(vertices_ + 1);
        skin.first.push_back(0);
        for (size_t v = 0; v < vertices_; ++v) {
            const size_t begin = skin.weight.size();
            float sum = 0;
            for (size_t set = 0; set < joints.size(); ++set)
                for (int c = 0; c < 4; ++c) {
                    const float weight = weights[set][v][c];
                    if (!(weight > 0) || !std::isfinite(weight)) continue;
                    skin.joint.push_back(joints[set][4 * v + static_cast<size_t>(c)]);
                    skin.weight.push_back(weight);
                    sum += weight;
                }
            if (skin.weight.size() == begin) {
                skin.joint.push_back(0);
                skin.weight.push_back(1);
                sum = 1;
            }
            for (size_t k = begin; k < skin.weight.size(); ++k) skin.weight[k] /= sum;
            skin.first.push_back(static_cast<uint32_t>(skin.weight.size()));
        }
    }

    const Document& document_;
    const std::string& path_;
    size_t vertices_;
    const DracoMesh* draco_;
};

/// Morph targets move positions, normals and tangents alone.
void warnOfLeftOut(const Document& document, const std::vector<std::map<std::string, int>>& targets) {
    for (const std::map<std::string, int>& target : targets)
        for (const auto& [name, accessor] : target)
            if (name.starts_with("TEXCOORD_") || name.starts_with("COLOR_"))
                document.warn("morph targets of " + name.substr(0, name.find('_')) + " are left out");
}

/// Replaces what is not finite in attributes that only decorate.
void makeHarmless(Mesh& mesh) {
    for (Vec3& n : mesh.normals) n = unitOr(n, Vec3(0, 1, 0));
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
        const Vec3 normal = mesh.normals.empty() ? Vec3(0, 1, 0) : mesh.normals[i];
        const Vec3 spare = Frame(normal).x;
        mesh.tangents[i] = Vec4(unitOr(Vec3(mesh.tangents[i]), spare), mesh.tangents[i].w < 0 ? -1.0f : 1.0f);
    }
    for (Vec4& c : mesh.colours)
        if (!isFinite(Vec3(c)) || !std::isfinite(c.w)) c = Vec4(1);
    for (Vec4& c : mesh.colours) c = glm::max(c, Vec4(0));
    for (MorphTarget& target : mesh.morphTargets)
        for (std::vector<Vec3>* deltas : {&target.positions, &target.normals, &target.tangents})
            for (Vec3& delta : *deltas)
                if (!isFinite(delta)) delta = Vec3(0);
}

}  // namespace

Mesh readVertices(const Document& document, const tinygltf::Primitive& primitive, const DracoMesh* draco,
                  const UvSets& uvSets, const std::string& path) {
    const std::map<std::string, int>& attributes = primitive.attributes;
    const std::string where = path + "/attributes";
    if (find(attributes, "POSITION") < 0) {
        document.warn(path + " has no positions and is left out");
        return {};
    }
    const size_t vertices = elementCount(document, find(attributes, "POSITION"), where + "/POSITION");
    const VertexReader reader(document, where, vertices, draco);
    const VertexReader targets(document, where, vertices, nullptr);
    Mesh mesh;
    mesh.positions = reader.read<Vec3>(attributes, "POSITION");
    mesh.normals = reader.read<Vec3>(attributes, "NORMAL");
    mesh.tangents = reader.read<Vec4>(attributes, "TANGENT");
    for (size_t set = 0; set < uvSets.size(); ++set)
        if (set == 0 || uvSets[1] != uvSets[0])
            mesh.uv[set] = reader.read<Vec2>(attributes, "TEXCOORD_" + std::to_string(uvSets[set]));
    mesh.colours = reader.readColours(attributes);
    mesh.skin = reader.readSkin(attributes);
    warnOfLeftOut(document, primitive.targets);
    for (const std::map<std::string, int>& target : primitive.targets)
        mesh.morphTargets.push_back({targets.read<Vec3>(target, "POSITION"), targets.read<Vec3>(target, "NORMAL"),
                                     targets.read<Vec3>(target, "TANGENT")});
    // glTF: without normals, faces are flat, and tangents do not count.
    if (mesh.normals.empty()) {
        mesh.tangents.clear();
        for (MorphTarget& target : mesh.morphTargets) target.normals.clear(), target.tangents.clear();
    }
    if (const size_t i = firstOutOfReach(mesh.positions); i < mesh.positions.size())
        document.fail(where + "/POSITION", "the position of vertex " + std::to_string(i) + " is out of range",
                      reachText(), outOfReachText(mesh.positions[i]));
    makeHarmless(mesh);
    return mesh;
}

std::vector<UVec3> readTriangles(const Document& document, const tinygltf::Primitive& primitive, const DracoMesh* draco,
                                 size_t vertexCount, const std::string& path) {
    const int mode = primitive.mode;
    if (mode >= 0 && mode < TINYGLTF_MODE_TRIANGLES) {
        document.warn("points and lines are not drawn");
        return {};
    }
    if (mode < 0 || mode > TINYGLTF_MODE_TRIANGLE_FAN)
        document.fail(path + "/mode", "no such primitive mode", "0 to 6", std::to_string(mode));

    if (draco) return draco->triangles;

    std::vector<uint32_t> indices;
    if (const int accessor = indicesOf(primitive); accessor >= 0) {
        indices = readIntegers(document, accessor, 1, path + "/indices");
        for (const uint32_t index : indices)
            if (index >= vertexCount)
                document.fail(path + "/indices", "refers to a vertex that does not exist",
                              "below " + std::to_string(vertexCount), std::to_string(index));
    } else {
        indices.resize(vertexCount);
        for (size_t i = 0; i < vertexCount; ++i) indices[i] = static_cast<uint32_t>(i);
    }
    std::vector<UVec3> triangles;
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        triangles.reserve(indices.size() / 3);
        for (size_t i = 0; i + 2 < indices.size(); i += 3)
            triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
        if (indices.size() % 3 != 0) document.warn(path + ": the last triangle is incomplete and left out");
    } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        // Every second triangle of a strip runs the other way round.
        for (size_t i = 0; i + 2 < indices.size(); ++i)
            triangles.emplace_back(indices[i], indices[i + 1 + i % 2], indices[i + 2 - i % 2]);
    } else {
        for (size_t i = 1; i + 1 < indices.size(); ++i) triangles.emplace_back(indices[i], indices[i + 1], indices[0]);
    }
    return triangles;
}

}  // namespace lumi::gltf

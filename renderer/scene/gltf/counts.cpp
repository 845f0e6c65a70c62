#include "scene/gltf/counts.h"

#include <algorithm>

#include "base/memory.h"
#include "scene/gltf/values.h"

namespace lumi::gltf {
namespace {

/// How much of a kind the file asks for, against what it may.
struct Budget {
    const char* what;
    uint64_t limit;
    uint64_t asked = 0;
};

class CountChecker {
public:
    CountChecker(const Document& document, const NodeTree& tree) : document_(document), tree_(tree) {
        const uint64_t bytes = document.byteCount();
        vertices_.limit = (uint64_t(1) << 16) + bytes;
        elements_.limit = (uint64_t(1) << 20) + 16 * bytes;
        instances_.limit = (uint64_t(1) << 16) + 4 * bytes;
        triangles_.limit = (uint64_t(1) << 22) + 8 * bytes;
    }

    void check() {
        const tinygltf::Model& model = document_.model();
        for (size_t m = 0; m < model.meshes.size(); ++m)
            for (size_t p = 0; tree_.usedMeshes()[m] && p < model.meshes[m].primitives.size(); ++p)
                addPrimitive(model.meshes[m].primitives[p],
                             "/meshes/" + std::to_string(m) + "/primitives/" + std::to_string(p));
        checkMemory("the geometry of " + document_.path().filename().string(), triangles_.asked * kTriangleBytes);
        for (size_t n = 0; n < model.nodes.size(); ++n)
            if (tree_.nodeOf(n) >= 0) addNode(model.nodes[n], "/nodes/" + std::to_string(n));
        for (size_t a = 0; a < model.animations.size(); ++a)
            addAnimation(model.animations[a], "/animations/" + std::to_string(a));
    }

private:
    /// Null if there is no such accessor, which is said where it is read.
    const tinygltf::Accessor* accessor(int index) const {
        const auto& accessors = document_.model().accessors;
        return index >= 0 && static_cast<size_t>(index) < accessors.size() ? &accessors[static_cast<size_t>(index)]
                                                                           : nullptr;
    }

    void spend(Budget& budget, uint64_t count, const std::string& path) const {
        const uint64_t left = budget.limit - budget.asked;
        if (count > left)
            document_.fail(path, std::string("absurd count of ") + budget.what + " for a file of its size",
                           "at most " + std::to_string(budget.limit) + " in the whole file",
                           std::to_string(budget.asked > 0 ? budget.asked : count) +
                               (budget.asked > 0 ? " before and " + std::to_string(count) + " here" : std::string()));
        budget.asked += count;
    }

    void addWithoutData(Budget& budget, int index, const std::string& path) const {
        const tinygltf::Accessor* found = accessor(index);
        if (found && found->bufferView < 0) spend(budget, found->count, path);
    }

    void addPrimitive(const tinygltf::Primitive& primitive, const std::string& path) {
        // Draco's data stand in for all of the accessors' own; their counts are checked with them.
        if (!extensionOf(primitive.extensions, "KHR_draco_mesh_compression")) {
            addTriangles(primitive, path);
            for (const auto& [name, index] : primitive.attributes)
                addWithoutData(name == "POSITION" ? vertices_ : elements_, index, path + "/attributes/" + name);
        }
        for (size_t t = 0; t < primitive.targets.size(); ++t)
            for (const auto& [name, index] : primitive.targets[t])
                addWithoutData(elements_, index, path + "/targets/" + std::to_string(t) + "/" + name);
    }

    /// Of what is no Draco mesh, whose counts are those that it decodes to.
    void addTriangles(const tinygltf::Primitive& primitive, const std::string& path) {
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return;
        const int indices = indicesOf(primitive);
        const tinygltf::Accessor* corners = accessor(indices >= 0 ? indices : position->second);
        if (!corners || primitive.mode < TINYGLTF_MODE_TRIANGLES) return;
        spend(triangles_, primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners->count / 3 : corners->count, path);
    }

    void addNode(const tinygltf::Node& node, const std::string& path) {
        const auto& skins = document_.model().skins;
        if (node.skin >= 0 && static_cast<size_t>(node.skin) < skins.size())
            addWithoutData(elements_, skins[static_cast<size_t>(node.skin)].inverseBindMatrices, path + "/skin");
        const auto* instancing = extensionOf(node.extensions, "EXT_mesh_gpu_instancing");
        if (node.mesh >= 0 && instancing)
            spend(instances_, instanceCount(document_, *instancing, path),
                  path + "/extensions/EXT_mesh_gpu_instancing");
    }

    void addAnimation(const tinygltf::Animation& animation, const std::string& path) {
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            if (channel.sampler < 0 || static_cast<size_t>(channel.sampler) >= animation.samplers.size()) continue;
            const auto& sampler = animation.samplers[static_cast<size_t>(channel.sampler)];
            const std::string samplerPath = path + "/samplers/" + std::to_string(channel.sampler);
            addWithoutData(elements_, sampler.input, samplerPath + "/input");
            addWithoutData(elements_, sampler.output, samplerPath + "/output");
        }
    }

    const Document& document_;
    const NodeTree& tree_;
    Budget vertices_{"vertices without data", 0}, elements_{"elements without data", 0}, instances_{"instances", 0},
        triangles_{"triangles", 0};
};

}  // namespace

void checkCounts(const Document& document, const NodeTree& tree) { CountChecker(document, tree).check(); }

}  // namespace lumi::gltf

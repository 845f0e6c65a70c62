#pragma once
#include <memory>
#include <vector>

#include "scene/gltf/document.h"
#include "scene/scene.h"

namespace lumi::gltf {

/// How many instances EXT_mesh_gpu_instancing makes of a node: the count that all of its accessors have, those of
/// custom attributes too. Throws Error(BadInput) if they differ or there are none.
size_t instanceCount(const Document& document, const tinygltf::Value& extension, const std::string& nodePath);

/// The node tree of the chosen scene, flattened parents first.
class NodeTree {
public:
    /// Walks the scene that the options name (or the file's default, or every root if the file has no scenes) and
    /// appends its nodes to `scene`. Throws Error(BadInput) for cycles, nodes with two parents and bad indices,
    /// Error(Usage) for a scene that does not exist.
    NodeTree(const Document& document, Scene& scene);

    /// Index into Scene::nodes of glTF node `index`, or -1 if it is not in the scene.
    int nodeOf(size_t index) const { return nodeOf_[index]; }
    /// Which meshes the scene's nodes show, by glTF mesh.
    const std::vector<bool>& usedMeshes() const { return usedMeshes_; }

    /// Places meshes, skins, cameras and lights at their nodes, in the order of the tree.
    void populate(const std::vector<std::shared_ptr<const Mesh>>& meshes);

private:
    std::vector<int> roots() const;
    void walk(int root, const std::string& rootPath);
    void addNode(int index, int parent);
    /// Throws unless what a node refers to is there, wherever it stands: of joints outside the scene too.
    void checkReferences(const tinygltf::Node& node, const std::string& path) const;
    void addInstances(size_t index);
    void addGpuInstances(size_t index, const Instance& prototype, const tinygltf::Value& extension);
    void addCamera(size_t index);
    void addLight(size_t index);
    int addSkin(int index);
    void checkJoints(const Instance& instance, const std::string& jsonPath) const;

    const Document& document_;
    Scene& scene_;
    std::vector<int> nodeOf_;
    std::vector<int> order_;  ///< glTF nodes in the order of the tree
    std::vector<bool> usedMeshes_;
    std::vector<int> skinOf_;  ///< glTF skin to Scene::skins
    std::vector<std::shared_ptr<const Mesh>> meshes_;
};

}  // namespace lumi::gltf

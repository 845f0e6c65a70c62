#include "scene/asset_placer.h"

#include <algorithm>
#include <set>

namespace lumi {
namespace {

/// Places one instance of an asset; the offsets say where its lists begin in the target.
class Placement {
public:
    Placement(Scene& target, PlacedAsset& asset, std::string instanceName, int root, const SlotFilling& filling)
        : target_(target), asset_(asset), name_(std::move(instanceName)), root_(root), filling_(filling) {
        firstNode_ = static_cast<int>(target.nodes.size());
        firstSkin_ = static_cast<int>(target.skins.size());
        firstLight_ = static_cast<int>(target.lights.size());
        asset_.ownMaterials.resize(asset_.content.materials.size(), -1);
    }

    void addNodes() const {
        for (Node node : asset_.content.nodes) {
            node.name = prefixed(node.name);
            node.parent = nodeIndex(node.parent);
            target_.nodes.push_back(std::move(node));
        }
        for (Skin skin : asset_.content.skins) {
            for (int& joint : skin.joints) joint = nodeIndex(joint);
            target_.skins.push_back(std::move(skin));
        }
        for (Animation animation : asset_.content.animations) {
            for (AnimationChannel& channel : animation.channels) channel.node = nodeIndex(channel.node);
            target_.animations.push_back(std::move(animation));
        }
    }

    void addInstances() {
        for (const Instance& source : asset_.content.instances) {
            Instance instance = source;
            instance.name = prefixed(source.name);
            instance.node = nodeIndex(source.node);
            if (source.skin >= 0) instance.skin = firstSkin_ + source.skin;
            if (source.light >= 0) instance.light = firstLight_ + source.light;
            fillSlots(source, instance);
            target_.instances.push_back(std::move(instance));
        }
    }

    void addLightsAndCameras() const {
        for (Light light : asset_.content.lights) {
            light.name = prefixed(light.name);
            light.node = nodeIndex(light.node);
            target_.lights.push_back(std::move(light));
        }
        for (SceneCamera camera : asset_.content.cameras) {
            // A camera without a node stands in asset space, which only a node can carry along.
            if (camera.node < 0) continue;
            camera.camera.name = prefixed(camera.camera.name);
            camera.node = nodeIndex(camera.node);
            target_.cameras.push_back(std::move(camera));
        }
    }

private:
    std::string prefixed(const std::string& name) const { return name.empty() ? name_ : name_ + "/" + name; }
    int nodeIndex(int index) const { return index < 0 ? root_ : firstNode_ + index; }

    /// Index in the target of the material in `slot`.
    int materialIn(uint32_t slot) {
        if (slot < filling_.size() && filling_[slot] >= 0) return filling_[slot];
        int& own = asset_.ownMaterials.at(slot);
        if (own < 0) {
            Material material = asset_.content.materials[slot];
            material.name = asset_.name + "/" + material.name;
            own = static_cast<int>(target_.materials.size());
            target_.materials.push_back(std::move(material));
        }
        return own;
    }

    /// Gives `instance` its mesh with the slots filled. Meshes that wear one material throughout are shared by all
    /// instances, whatever they wear; only a mix of materials needs a copy for each different filling.
    void fillSlots(const Instance& source, Instance& instance) {
        const Mesh& mesh = *source.mesh;
        std::set<uint32_t> used{mesh.material};
        if (!mesh.triangleMaterial.empty()) used = {mesh.triangleMaterial.begin(), mesh.triangleMaterial.end()};
        if (source.material >= 0) used = {static_cast<uint32_t>(source.material)};

        std::vector<int> materials;
        for (const uint32_t slot : used) materials.push_back(materialIn(slot));
        const bool uniform = std::equal(materials.begin() + 1, materials.end(), materials.begin());
        instance.material = -1;
        if (uniform) {
            const auto any = asset_.meshes.lower_bound({&mesh, {}});
            const bool known = any != asset_.meshes.end() && any->first.first == &mesh;
            instance.mesh = known ? any->second : storedMesh(source.mesh, {materials[0]}, used);
            if (!instance.mesh->triangleMaterial.empty() ||
                instance.mesh->material != static_cast<uint32_t>(materials[0]))
                instance.material = materials[0];
            return;
        }
        const auto same = asset_.meshes.find({&mesh, materials});
        instance.mesh = same != asset_.meshes.end() ? same->second : storedMesh(source.mesh, materials, used);
    }

    std::shared_ptr<const Mesh> storedMesh(const std::shared_ptr<const Mesh>& source, const std::vector<int>& materials,
                                           const std::set<uint32_t>& used) {
        auto& stored = asset_.meshes[{source.get(), materials}];
        auto mesh = std::make_shared<Mesh>(*source);
        mesh->material = static_cast<uint32_t>(materials[0]);
        if (materials.size() == 1) {
            mesh->triangleMaterial.clear();
        } else {
            std::map<uint32_t, int> filled;
            size_t i = 0;
            for (const uint32_t slot : used) filled[slot] = materials[i++];
            for (uint32_t& material : mesh->triangleMaterial) material = static_cast<uint32_t>(filled.at(material));
        }
        stored = std::move(mesh);
        return stored;
    }

    Scene& target_;
    PlacedAsset& asset_;
    std::string name_;
    int root_;
    const SlotFilling& filling_;
    int firstNode_ = 0, firstSkin_ = 0, firstLight_ = 0;
};

}  // namespace

void placeAsset(Scene& target, PlacedAsset& asset, const std::string& instanceName, int root,
                const SlotFilling& filling) {
    Placement placement(target, asset, instanceName, root, filling);
    placement.addNodes();
    placement.addInstances();
    placement.addLightsAndCameras();
}

Scene sceneFromProcedural(ProceduralResult result) {
    Scene scene;
    for (MaterialSlot& slot : result.slots) {
        scene.materials.push_back(std::move(slot.fallback));
        scene.materials.back().name = slot.name;
    }
    scene.nodes = std::move(result.nodes);
    scene.skins = std::move(result.skins);
    scene.animations = std::move(result.animations);
    for (ProceduralPart& part : result.parts)
        scene.instances.push_back({std::move(part.name), std::move(part.mesh), part.node, part.skin, part.slot, -1});
    return scene;
}

}  // namespace lumi

#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/procedural/procedural.h"
#include "scene/scene.h"

namespace lumi {

/// A loaded asset, ready to be placed any number of times. Its meshes are shared by all its instances.
struct PlacedAsset {
    std::string name;
    Scene content;  ///< in the asset's own space; its materials are the slots that an instance may fill

    std::vector<int> ownMaterials;  ///< index in the target scene of each of content's materials, -1 until used
    using MeshKey = std::pair<const Mesh*, std::vector<int>>;
    std::map<MeshKey, std::shared_ptr<const Mesh>> meshes;  ///< by source mesh and where its slots went
};

/// Which material of the target scene fills each slot of an asset: -1 is the asset's own.
using SlotFilling = std::vector<int>;

/// Appends the asset's nodes below node `root`, and with them its meshes, skins, lights, cameras and animations.
/// Names become "<instanceName>/<name>", materials "<asset>/<material>".
void placeAsset(Scene& target, PlacedAsset& asset, const std::string& instanceName, int root,
                const SlotFilling& filling);

/// A generated asset as a scene of its own.
Scene sceneFromProcedural(ProceduralResult result);

}  // namespace lumi

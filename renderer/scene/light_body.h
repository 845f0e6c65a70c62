#pragma once
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace lumi {

/// The visible shape of a rectangle, disk or sphere light in the light's own space (fronts where it emits), or null for
/// lights without extent. Flat bodies are exact; a sphere's facets have its exact area.
std::shared_ptr<const Mesh> lightBody(const Light& light);

/// Gives every light with extent that has none an instance that shows it (Instance::light, on the light's node), all
/// wearing one black material named "light body"; lights of one kind and size share a mesh. Bodies that stand already
/// are made again if their light's size changed; the rest of the scene keeps its order.
void addLightBodies(Scene& scene);

/// For each material of the scene: is it the one that addLightBodies() made, worn by bodies alone? It says nothing of
/// them: what a body shows is its light's.
std::vector<bool> bodyMaterials(const Scene& scene);

}  // namespace lumi

#pragma once
#include <memory>
#include <vector>

#include "base/messages.h"
#include "scene/posed_scene.h"

namespace lumi {

/// The visible shape of a rectangle, disk or sphere light in the light's own space (fronts where it emits), or null for
/// lights without extent. Flat bodies are exact; a sphere's facets have its exact area.
std::shared_ptr<const Mesh> lightBody(const Light& light);

/// Gives every light with extent that has none an instance that shows it (Instance::light, on the light's node), all
/// wearing one black material named "light body"; lights of one kind and size share a mesh. Bodies that stand already
/// are made again if their light's size changed; the rest of the scene keeps its order.
void addLightBodies(Scene& scene);

/// Factor on a sphere light's radius. Under axes of several lengths it stays a sphere, of the area of the ellipsoid
/// that it would be, by Thomsen's formula (within 1.1 %): what it shines all around stays the same.
float sphereScale(const Mat4& worldFromLight);
/// Names the sphere lights whose axes differ by more than 1 %, and says what is shown of them.
void warnOfStretchedLights(const PosedScene& posed, MessageLog& log);

/// For each material of the scene: is it the one that addLightBodies() made, worn by bodies alone? It says nothing of
/// them: what a body shows is its light's.
std::vector<bool> bodyMaterials(const Scene& scene);

}  // namespace lumi

#pragma once
#include "scene/gltf/nodes.h"

namespace lumi::gltf {

/// All animations of the file as looping animations of `scene`. An animation that moves what an earlier one moves is
/// left out, with a note: clips are alternatives, and the first is played. Throws Error(BadInput).
void loadAnimations(const Document& document, const NodeTree& tree, Scene& scene);

}  // namespace lumi::gltf

#pragma once
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lumi {

/// A scene's node tree at one moment.
struct NodePose {
    std::vector<Mat4> worldFromNode;               ///< for each node
    std::vector<std::vector<float>> morphWeights;  ///< for each node; the rest weights where nothing animates them
};

/// Evaluates all animations at `time` in seconds (looping ones wrap); no time gives the rest pose.
NodePose poseNodes(const Scene& scene, std::optional<float> time);

/// World matrix of one node alone: the chain of its ancestors. Looks at every channel once; for many nodes of one
/// moment, poseNodes() does.
Mat4 worldFromNodeAt(const Scene& scene, int node, std::optional<float> time);

/// How a node and its ancestors turn, scales left out but for mirroring: unit axes, also where a scale of 0 leaves none
/// to the world matrix. Looks at every channel once.
Mat3 worldTurnAt(const Scene& scene, int node, std::optional<float> time);

/// Stands a camera at its node: a rigid frame that looks along -Z, whatever the node's scale, with the camera's own
/// distance to its target.
void placeAtNode(Camera& camera, const Mat4& worldFromNode);

/// `time` as an animation sees it: wrapped into [0, duration] if it loops.
float localTime(const Animation& animation, float time);

/// World-space joint matrices of a skin: worldFromJoint * inverseBind.
std::vector<Mat4> jointMatrices(const Skin& skin, const NodePose& pose);

/// The same of a scene's skins, each worked out once however many instances share it. Not for several threads.
class PosedSkins {
public:
    PosedSkins(const Scene& scene, const NodePose& pose) : scene_(scene), pose_(pose), joints_(scene.skins.size()) {}
    /// Empty for -1, which is no skin.
    const std::vector<Mat4>& of(int skin);

private:
    const Scene& scene_;
    const NodePose& pose_;
    std::vector<std::vector<Mat4>> joints_;
};

}  // namespace lumi

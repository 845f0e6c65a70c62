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

/// World matrix of one node alone: the chain of its ancestors.
Mat4 worldFromNodeAt(const Scene& scene, int node, std::optional<float> time);

/// `time` as an animation sees it: wrapped into [0, duration] if it loops.
float localTime(const Animation& animation, float time);

/// World-space joint matrices of a skin: worldFromJoint * inverseBind.
std::vector<Mat4> jointMatrices(const Skin& skin, const NodePose& pose);

}  // namespace lumi

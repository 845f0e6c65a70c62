#include "scene/node_pose.h"

#include <algorithm>
#include <cmath>

namespace lumi {
namespace {

/// What animation makes of a node's own transform. An animated matrix node is taken apart no further: glTF forbids it.
Mat4 localMatrix(const Node& node, const Transform& local) { return node.hasMatrix ? node.matrix : local.matrix(); }

void apply(const AnimationChannel& channel, float time, Transform& local, std::vector<float>* morphWeights) {
    float v[4];
    switch (channel.property) {
        case AnimatedProperty::Translation:
            channel.evaluate(time, v);
            local.translation = {v[0], v[1], v[2]};
            break;
        case AnimatedProperty::Rotation:
            channel.evaluate(time, v);
            local.rotation = {v[3], v[0], v[1], v[2]};
            break;
        case AnimatedProperty::Scale:
            channel.evaluate(time, v);
            local.scale = {v[0], v[1], v[2]};
            break;
        case AnimatedProperty::MorphWeights:
            if (!morphWeights) break;
            morphWeights->resize(static_cast<size_t>(channel.components));
            channel.evaluate(time, morphWeights->data());
            break;
    }
}

}  // namespace

float localTime(const Animation& animation, float time) {
    if (!animation.loop || !(animation.duration > 0) || (time >= 0 && time <= animation.duration)) return time;
    return time - std::floor(time / animation.duration) * animation.duration;
}

NodePose poseNodes(const Scene& scene, std::optional<float> time) {
    const size_t count = scene.nodes.size();
    std::vector<Transform> locals(count);
    NodePose pose;
    pose.worldFromNode.resize(count);
    pose.morphWeights.resize(count);
    for (size_t i = 0; i < count; ++i) {
        locals[i] = scene.nodes[i].local;
        pose.morphWeights[i] = scene.nodes[i].morphWeights;
    }
    if (time)
        for (const Animation& animation : scene.animations) {
            const float local = localTime(animation, *time);
            for (const AnimationChannel& channel : animation.channels) {
                const size_t node = static_cast<size_t>(channel.node);
                apply(channel, local, locals[node], &pose.morphWeights[node]);
            }
        }
    for (size_t i = 0; i < count; ++i) {
        const Node& node = scene.nodes[i];
        const Mat4 local = localMatrix(node, locals[i]);
        pose.worldFromNode[i] = node.parent < 0 ? local : pose.worldFromNode[static_cast<size_t>(node.parent)] * local;
        if (node.sharesMorphWeights) pose.morphWeights[i] = pose.morphWeights[static_cast<size_t>(node.parent)];
    }
    return pose;
}

namespace {

/// A node and its ancestors at one moment, the root first.
struct Chain {
    std::vector<int> nodes;
    std::vector<Transform> locals;
};

Chain chainAt(const Scene& scene, int node, std::optional<float> time) {
    Chain chain;
    // Parents stand before their children: from the root down, the chain's indices ascend.
    for (int i = node; i >= 0; i = scene.nodes[static_cast<size_t>(i)].parent) chain.nodes.push_back(i);
    std::reverse(chain.nodes.begin(), chain.nodes.end());
    for (const int i : chain.nodes) chain.locals.push_back(scene.nodes[static_cast<size_t>(i)].local);
    if (!time) return chain;
    const auto begin = chain.nodes.begin(), end = chain.nodes.end();
    for (const Animation& animation : scene.animations) {
        const float local = localTime(animation, *time);
        for (const AnimationChannel& channel : animation.channels)
            if (const auto at = std::lower_bound(begin, end, channel.node); at != end && *at == channel.node)
                apply(channel, local, chain.locals[static_cast<size_t>(at - begin)], nullptr);
    }
    return chain;
}

/// Its axes made unit. One that vanished lies across the other two; what remains unknown is chosen.
Mat3 unitAxes(const Mat3& m) {
    const Vec3 none(0);
    Mat3 axes(unitOr(m[0], none), unitOr(m[1], none), unitOr(m[2], none));
    for (int i = 0; i < 3; ++i)
        if (axes[i] == none) axes[i] = unitOr(glm::cross(axes[(i + 1) % 3], axes[(i + 2) % 3]), none);
    for (int i = 0; i < 3; ++i) {
        if (axes[i] == none || (axes[(i + 1) % 3] != none && axes[(i + 2) % 3] != none)) continue;
        const Frame around(axes[i]);
        axes[(i + 1) % 3] = around.x, axes[(i + 2) % 3] = around.y;
    }
    return axes[0] == none ? Mat3(1) : axes;
}

Mat3 turnOf(const Node& node, const Transform& local) {
    if (node.hasMatrix) return unitAxes(Mat3(node.matrix));
    Mat3 turn = glm::mat3_cast(local.rotation);
    for (int i = 0; i < 3; ++i)
        if (local.scale[i] < 0) turn[i] = -turn[i];
    return turn;
}

}  // namespace

Mat4 worldFromNodeAt(const Scene& scene, int node, std::optional<float> time) {
    const Chain chain = chainAt(scene, node, time);
    Mat4 world(1);
    for (size_t i = 0; i < chain.nodes.size(); ++i)
        world = world * localMatrix(scene.nodes[static_cast<size_t>(chain.nodes[i])], chain.locals[i]);
    return world;
}

Mat3 worldTurnAt(const Scene& scene, int node, std::optional<float> time) {
    const Chain chain = chainAt(scene, node, time);
    Mat3 world(1);
    for (size_t i = 0; i < chain.nodes.size(); ++i)
        world = world * turnOf(scene.nodes[static_cast<size_t>(chain.nodes[i])], chain.locals[i]);
    return unitAxes(world);
}

void placeAtNode(Camera& camera, const Mat4& worldFromNode) {
    const float distance = glm::length(camera.target - camera.eye);
    const Vec3 back(worldFromNode[2]), up(worldFromNode[1]);
    const float length = glm::length(back), height = glm::length(up);
    const Vec3 forward = length > 0 && std::isfinite(length) ? back * (-1 / length) : Vec3(0, 0, -1);
    camera.eye = Vec3(worldFromNode[3]);
    camera.target = camera.eye + forward * (distance > 0 ? distance : 1.0f);
    camera.up = height > 0 && std::isfinite(height) ? glm::normalize(up) : Vec3(0, 1, 0);
}

std::vector<Mat4> jointMatrices(const Skin& skin, const NodePose& pose) {
    std::vector<Mat4> matrices(skin.joints.size());
    for (size_t j = 0; j < matrices.size(); ++j)
        matrices[j] = pose.worldFromNode[static_cast<size_t>(skin.joints[j])] * skin.inverseBind[j];
    return matrices;
}

const std::vector<Mat4>& PosedSkins::of(int skin) {
    static const std::vector<Mat4> kNone;
    if (skin < 0) return kNone;
    std::vector<Mat4>& joints = joints_[static_cast<size_t>(skin)];
    if (joints.empty()) joints = jointMatrices(scene_.skins[static_cast<size_t>(skin)], pose_);
    return joints;
}

}  // namespace lumi

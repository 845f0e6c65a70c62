#include "scene/pose_bounds.h"

#include <map>
#include <set>
#include <vector>

#include "base/error.h"
#include "scene/deform.h"
#include "scene/reach.h"
#include "scene/shared_shapes.h"

namespace lumi {
namespace {

constexpr int kMoments = 17, kFewMoments = 5;
constexpr size_t kMuch = size_t(1) << 18;  ///< nodes and vertices of a pose from which on fewer moments are looked at
constexpr size_t kMostLengths = 4;
constexpr float kMostGrowth = 4;
constexpr size_t kPollStride = 4096;  ///< instances between two looks at the stop

bool isSkinned(const Instance& instance) { return instance.skin >= 0 && !instance.mesh->skin.empty(); }

/// What one pose costs: nodes, and vertices once for each thing that moves them.
size_t costOf(const Scene& scene) {
    size_t cost = scene.nodes.size();
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = *instance.mesh;
        const size_t times = mesh.morphTargets.size() + (isSkinned(instance) ? 1 : 0);
        cost += times * mesh.positions.size();
    }
    return cost;
}

/// Moments of every length of animation, in order of time, without 0.
std::set<float> momentsOf(const Scene& scene) {
    std::set<float, std::greater<>> lengths;
    for (const Animation& animation : scene.animations)
        if (animation.duration > 0) lengths.insert(animation.duration);
    const int count = costOf(scene) > kMuch ? kFewMoments : kMoments;
    std::set<float> moments;
    size_t used = 0;
    for (const float length : lengths) {
        if (++used > kMostLengths) break;
        for (int i = 1; i < count; ++i) moments.insert(length * static_cast<float>(i) / static_cast<float>(count - 1));
    }
    return moments;
}

}  // namespace

void eachBounds(const Scene& scene, const NodePose& pose, MeshBounds& meshBounds,
                const std::function<void(const Bounds3&)>& visit) {
    PosedSkins skins(scene, pose);
    std::map<ShapeKey, Bounds3> shapes;
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = *instance.mesh;
        const bool skinned = isSkinned(instance);
        Mat4 worldFromObject(1);
        if (instance.node >= 0 && !skinned) worldFromObject = pose.worldFromNode[static_cast<size_t>(instance.node)];
        if (mesh.morphTargets.empty() && !skinned) {
            visit(transformedBounds(meshBounds.of(mesh), worldFromObject));
            continue;
        }
        std::vector<float> weights;
        if (instance.node >= 0) weights = pose.morphWeights[static_cast<size_t>(instance.node)];
        const std::vector<Mat4>& joints = skins.of(skinned ? instance.skin : -1);
        const auto [shape, isNew] = shapes.try_emplace(shapeKey(instance, weights, joints));
        if (isNew) shape->second = boundsOf(deform(mesh, weights, joints).positions);
        visit(transformedBounds(shape->second, worldFromObject));
    }
}

void checkLoadStop(const Scene& scene, const std::stop_token& stop) {
    if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"loading was stopped", scene.path, "", ""});
}

Bounds3 boundsOverTime(const Scene& scene, std::stop_token stop) {
    MeshBounds meshBounds;
    Bounds3 all;
    size_t seen = 0;
    const auto poll = [&] {
        if (seen++ % kPollStride == 0) checkLoadStop(scene, stop);
    };
    eachBounds(scene, poseNodes(scene, 0.0f), meshBounds, [&](const Bounds3& box) {
        poll();
        all.extend(box);
    });
    float most = kMostGrowth * all.radius();
    for (const float moment : momentsOf(scene)) {
        checkLoadStop(scene, stop);
        eachBounds(scene, poseNodes(scene, moment), meshBounds, [&](const Bounds3& box) {
            poll();
            if (box.empty() || !isInReach(box.lower) || !isInReach(box.upper)) return;
            Bounds3 both = all;
            both.extend(box);
            if (most > 0 && both.radius() > most) return;
            all = both;
        });
        // Where nothing is to be seen at first, what comes first is the measure.
        if (!(most > 0)) most = kMostGrowth * all.radius();
    }
    return all;
}

}  // namespace lumi

#include "scene/posed_shutter.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "scene/bounds.h"
#include "scene/reach.h"
#include "scene/shutter_segments.h"

namespace lumi {
namespace {

/// Does `holds(joint)` for one of the joints that bend the instance? Asks for those that its mesh names where these are
/// fewer than the skin's, so that many small parts of a large skeleton cost no more than their vertices do.
template <typename Holds>
bool anyJoint(const Instance& instance, size_t skinJoints, const Holds& holds) {
    const std::vector<uint32_t>& named = instance.mesh->skin.joint;
    if (named.size() < skinJoints) return std::any_of(named.begin(), named.end(), holds);
    for (size_t j = 0; j < skinJoints; ++j)
        if (holds(j)) return true;
    return false;
}

Mat4 between(const Mat4& a, const Mat4& b, float t) { return t > 0 ? a * (1 - t) + b * t : a; }

/// Does `truth`, at `part` of the way from a to b, lie off the straight way for some corner of the box?
bool strays(const Mat4& a, const Mat4& truth, const Mat4& b, float part, const Bounds3& box) {
    if (a == truth && a == b) return false;
    const Mat4 difference = between(a, b, part) - truth;
    const Bounds3 world = transformedBounds(box, truth);
    const float allowed = kMostShutterStray * std::max(world.radius(), 1e-6f);
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                     corner & 4 ? box.upper.z : box.lower.z);
        if (glm::length(Vec3(difference * Vec4(p, 1))) > allowed) return true;
    }
    return false;
}

/// The same where a joint goes straight from a to b while morph weights change by `change` in all. Vertices go along a
/// parabola then, J(t) (x + w(t) d), part (1 - part) times the product of both changes off the straight way; d is taken
/// for the box's size.
bool straysByBoth(const Mat4& a, const Mat4& b, float change, float part, const Bounds3& box) {
    if (a == b) return false;
    const Mat3 turn = Mat3(b) - Mat3(a);
    const Vec3 size = box.size();
    const float reach = glm::length(turn[0]) * size.x + glm::length(turn[1]) * size.y + glm::length(turn[2]) * size.z;
    const float allowed = kMostShutterStray * std::max(transformedBounds(box, a).radius(), 1e-6f);
    return part * (1 - part) * change * reach > allowed;
}

/// The same for all that moves or bends an instance.
bool strays(const Instance& instance, const PosedMoment& a, const PosedMoment& truth, const PosedMoment& b, float part,
            const Bounds3& meshBounds) {
    if (meshBounds.empty()) return false;
    if (strays(placementOf(instance, a), placementOf(instance, truth), placementOf(instance, b), part, meshBounds))
        return true;
    const auto weightsA = morphWeightsOf(instance, a), weights = morphWeightsOf(instance, truth),
               weightsB = morphWeightsOf(instance, b);
    float change = 0;
    for (size_t i = 0; i < weights.size() && i < weightsA.size() && i < weightsB.size(); ++i) {
        if (std::abs(glm::mix(weightsA[i], weightsB[i], part) - weights[i]) > kMostShutterStray) return true;
        change += std::abs(weightsB[i] - weightsA[i]);
    }
    const auto jointsA = jointsOf(instance, a), joints = jointsOf(instance, truth), jointsB = jointsOf(instance, b);
    return anyJoint(instance, joints.size(), [&](size_t j) {
        return strays(jointsA[j], joints[j], jointsB[j], part, meshBounds) ||
               (change > 0 && straysByBoth(jointsA[j], jointsB[j], change, part, meshBounds));
    });
}

/// A light's frame, see PosedLight.
Mat4 frameOf(const Scene& scene, const Light& light, const NodePose& nodes, float time) {
    if (light.node < 0) return Mat4(1);
    const Mat4& world = nodes.worldFromNode[static_cast<size_t>(light.node)];
    if (hasBody(light.type) || glm::length(Vec3(world[2])) > 1e-18f) return world;  // its square is a plain float
    Mat4 frame(worldTurnAt(scene, light.node, time));
    frame[3] = world[3];
    return frame;
}

/// The same for a light: its place, in a scene of this radius, and the axis along which it shines.
bool strays(const Light& light, const Mat4& from, const Mat4& there, const Mat4& to, float part, float sceneRadius) {
    if (from == to && from == there) return false;
    const Mat4 straight = between(from, to, part);
    const auto axis = [](const Mat4& frame) { return glm::normalize(Vec3(frame[2]) + Vec3(1e-30f)); };
    const float off = light.type == LightType::Directional ? 0 : glm::distance(Vec3(straight[3]), Vec3(there[3]));
    const float turned = light.type == LightType::Point ? 0 : glm::distance(axis(straight), axis(there));
    return off > kMostShutterStray * sceneRadius || turned > kMostShutterStray;
}

/// Of the scene at a moment: half the diagonal of its box; more than 0.
float radiusOf(const Scene& scene, const PosedMoment& moment, std::span<const Bounds3> meshBounds) {
    Bounds3 all;
    for (size_t k = 0; k < scene.instances.size(); ++k)
        if (!meshBounds[k].empty())
            all.extend(transformedBounds(meshBounds[k], placementOf(scene.instances[k], moment)));
    return all.empty() ? 1 : std::max(all.radius(), 1e-6f);
}

bool standsStill(const Instance& instance, std::span<const PosedMoment> moments) {
    const Mat4 first = placementOf(instance, moments[0]);
    const bool bends = deforms(instance);
    return std::all_of(moments.begin(), moments.end(), [&](const PosedMoment& moment) {
        return placementOf(instance, moment) == first && (!bends || deformsAlike(instance, moments[0], moment));
    });
}

/// Every `stride`-th moment is enough.
bool suffices(const Instance& instance, std::span<const PosedMoment> moments, size_t stride, const Bounds3& bounds) {
    for (size_t i = 0; i < moments.size(); ++i) {
        const size_t first = i / stride * stride;
        if (i == first) continue;
        const float part = static_cast<float>(i - first) / static_cast<float>(stride);
        if (strays(instance, moments[first], moments[i], moments[first + stride], part, bounds)) return false;
    }
    return true;
}

/// What is flat at a moment, as things are that grow from nothing, becomes a thousandth of what it is at the next
/// moment at which it is not, or else the last: rays cannot be carried into what is flat.
void unflatten(std::vector<Mat4>& places) {
    const std::vector<Mat4> truth = places;
    for (size_t i = 0; i < truth.size(); ++i) {
        if (carriesRays(truth[i])) continue;
        const auto carries = [](const Mat4& m) { return carriesRays(m); };
        const auto here = truth.begin() + static_cast<ptrdiff_t>(i);
        const auto later = std::find_if(here, truth.end(), carries);
        const auto earlier = std::find_if(std::make_reverse_iterator(here), truth.rend(), carries);
        if (later != truth.end()) places[i] = between(truth[i], *later, kMostShutterStray);
        else if (earlier != truth.rend()) places[i] = between(truth[i], *earlier, kMostShutterStray);
    }
}

}  // namespace

PosedMoment poseMoment(const Scene& scene, float time) {
    PosedMoment moment{poseNodes(scene, time), {}, {}};
    for (const Skin& skin : scene.skins) moment.joints.push_back(jointMatrices(skin, moment.nodes));
    for (const Light& light : scene.lights) moment.worldFromLight.push_back(frameOf(scene, light, moment.nodes, time));
    return moment;
}

bool isSkinned(const Instance& instance) { return instance.skin >= 0 && !instance.mesh->skin.empty(); }

bool deforms(const Instance& instance) { return !instance.mesh->morphTargets.empty() || isSkinned(instance); }

Mat4 placementOf(const Instance& instance, const PosedMoment& moment) {
    if (instance.node < 0 || isSkinned(instance)) return Mat4(1);
    return moment.nodes.worldFromNode[static_cast<size_t>(instance.node)];
}

std::span<const float> morphWeightsOf(const Instance& instance, const PosedMoment& moment) {
    if (instance.node < 0) return {};
    return moment.nodes.morphWeights[static_cast<size_t>(instance.node)];
}

std::span<const Mat4> jointsOf(const Instance& instance, const PosedMoment& moment) {
    if (!isSkinned(instance)) return {};
    return moment.joints[static_cast<size_t>(instance.skin)];
}

bool deformsAlike(const Instance& instance, const PosedMoment& a, const PosedMoment& b) {
    if (&a == &b) return true;
    if (!std::ranges::equal(morphWeightsOf(instance, a), morphWeightsOf(instance, b))) return false;
    const auto jointsA = jointsOf(instance, a), jointsB = jointsOf(instance, b);
    return !anyJoint(instance, jointsA.size(), [&](size_t j) { return jointsA[j] != jointsB[j]; });
}

std::shared_ptr<const DeformedVertices> deformAt(const Instance& instance, const PosedMoment& moment) {
    return moment.shapes->of(instance, morphWeightsOf(instance, moment), jointsOf(instance, moment));
}

std::vector<PosedMoment> shutterMoments(const Scene& scene, float open, float close,
                                        std::span<const Bounds3> meshBounds, const std::stop_token& stop) {
    const auto at = [&](float part) {
        if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
        return poseMoment(scene, glm::mix(open, close, part));
    };
    float sceneRadius = 0;
    const auto anyStrays = [&](const PosedMoment& a, const PosedMoment& truth, const PosedMoment& b, float part) {
        for (size_t k = 0; k < scene.instances.size(); ++k)
            if (strays(scene.instances[k], a, truth, b, part, meshBounds[k])) return true;
        if (sceneRadius == 0 && !scene.lights.empty()) sceneRadius = radiusOf(scene, a, meshBounds);
        for (size_t i = 0; i < scene.lights.size(); ++i)
            if (strays(scene.lights[i], a.worldFromLight[i], truth.worldFromLight[i], b.worldFromLight[i], part,
                       sceneRadius))
                return true;
        return false;
    };
    return straightSegments(shutterTurns(scene, open, close), at, anyStrays);
}

std::shared_ptr<const ShutterTrack> shutterTrack(const Instance& instance, std::span<const PosedMoment> moments,
                                                 const Bounds3& meshBounds,
                                                 std::shared_ptr<const DeformedVertices> deformed) {
    if (standsStill(instance, moments)) return nullptr;
    size_t stride = moments.size() - 1;
    while (stride > 1 && !suffices(instance, moments, stride, meshBounds)) stride /= 2;
    auto track = std::make_shared<ShutterTrack>();
    bool moves = false, bends = false;
    for (const PosedMoment& moment : moments) {
        moves |= placementOf(instance, moment) != placementOf(instance, moments[0]);
        bends |= deforms(instance) && !deformsAlike(instance, moments[0], moment);
    }
    for (size_t i = 0; i < moments.size(); i += stride) {
        if (moves || i == 0) track->worldFromObject.push_back(placementOf(instance, moments[i]));
        if (bends) track->deformed.push_back(i == 0 && deformed ? deformed : deformAt(instance, moments[i]));
    }
    unflatten(track->worldFromObject);
    return track;
}

std::vector<Mat4> shutterFrames(size_t light, std::span<const PosedMoment> moments) {
    std::vector<Mat4> frames;
    for (const PosedMoment& moment : moments) frames.push_back(moment.worldFromLight[light]);
    const bool still = std::all_of(frames.begin(), frames.end(), [&](const Mat4& m) { return m == frames[0]; });
    return still ? std::vector<Mat4>() : frames;
}

Mat4 ShutterTrack::worldFromObjectAt(float time) const {
    const TrackPlace place = trackPlace(worldFromObject.size(), time);
    if (place.fraction <= 0) return worldFromObject[place.first];
    return between(worldFromObject[place.first], worldFromObject[place.first + 1], place.fraction);
}

bool ShutterTrack::isMirroredAt(float time) const {
    const TrackPlace place = trackPlace(deformed.size(), time);
    const DeformedVertices& a = *deformed[place.first];
    if (place.fraction <= 0) return a.isMirrored();
    const DeformedVertices& b = *deformed[place.first + 1];
    // What mirrors at one end alone is flat at some time in between: where the straight way of the blend is.
    return a.isMirrored() == b.isMirrored() ? a.isMirrored() : isMirroring(between(a.blend, b.blend, place.fraction));
}

Mat4 PosedLight::worldFromLightAt(float time) const {
    if (track.empty()) return worldFromLight;
    const TrackPlace place = trackPlace(track.size(), time);
    return between(track[place.first], track[place.first + 1], place.fraction);
}

}  // namespace lumi

#include "scene/posed_scene.h"

#include <optional>

#include "base/parallel.h"
#include "scene/bounds.h"
#include "scene/deform.h"
#include "scene/node_pose.h"

namespace lumi {
namespace {

using Vertices = std::shared_ptr<const DeformedVertices>;

/// Node tree and joints at one moment.
struct Moment {
    NodePose nodes;
    std::vector<std::vector<Mat4>> joints;  ///< for each skin
};

Moment poseMoment(const Scene& scene, float time) {
    Moment moment{poseNodes(scene, time), {}};
    for (const Skin& skin : scene.skins) moment.joints.push_back(jointMatrices(skin, moment.nodes));
    return moment;
}

bool isSkinned(const Instance& instance) { return instance.skin >= 0 && !instance.mesh->skin.empty(); }

Mat4 placement(const Instance& instance, const Moment& moment) {
    if (instance.node < 0 || isSkinned(instance)) return Mat4(1);
    return moment.nodes.worldFromNode[static_cast<size_t>(instance.node)];
}

std::span<const float> weightsOf(const Instance& instance, const Moment& moment) {
    if (instance.node < 0) return {};
    return moment.nodes.morphWeights[static_cast<size_t>(instance.node)];
}

std::span<const Mat4> jointsOf(const Instance& instance, const Moment& moment) {
    if (!isSkinned(instance)) return {};
    return moment.joints[static_cast<size_t>(instance.skin)];
}

bool equalSpans(std::span<const float> a, std::span<const float> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}
bool equalSpans(std::span<const Mat4> a, std::span<const Mat4> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

bool deformsAlike(const Instance& instance, const Moment& a, const Moment& b) {
    return &a == &b || (equalSpans(weightsOf(instance, a), weightsOf(instance, b)) &&
                        equalSpans(jointsOf(instance, a), jointsOf(instance, b)));
}

bool deforms(const Instance& instance) { return !instance.mesh->morphTargets.empty() || isSkinned(instance); }

Vertices deformAt(const Instance& instance, const Moment& moment) {
    return std::make_shared<const DeformedVertices>(
        deform(*instance.mesh, weightsOf(instance, moment), jointsOf(instance, moment)));
}

/// Whether `earlier` is the frame that `previousOpen` means, with the same things in it: then what it showed is what
/// motion refers to, also when a user moved an object since.
bool continues(const PosedScene* earlier, const Scene& scene, const ShutterTimes& times) {
    if (!earlier || earlier->time != times.previousOpen || earlier->instances.size() != scene.instances.size())
        return false;
    for (size_t i = 0; i < scene.instances.size(); ++i)
        if (earlier->scene->instances[i].mesh != scene.instances[i].mesh) return false;
    return earlier->scene->lights.size() == scene.lights.size();
}

PosedInstance poseInstance(const Instance& instance, const Moment& open, const Moment& close, const Moment& previous,
                           const PosedInstance* earlier) {
    PosedInstance posed;
    posed.worldFromObject = placement(instance, open);
    posed.worldFromObjectClose = placement(instance, close);
    posed.worldFromObjectPrevious = earlier ? earlier->worldFromObject : placement(instance, previous);
    posed.normalFromObject = normalMatrix(posed.worldFromObject);
    if (deforms(instance)) {
        posed.deformed = earlier && earlier->deformed && deformsAlike(instance, open, previous)
                             ? earlier->deformed
                             : deformAt(instance, open);
        posed.deformedClose = deformsAlike(instance, open, close) ? posed.deformed : deformAt(instance, close);
        if (earlier && earlier->deformed)
            posed.deformedPrevious = earlier->deformed;
        else
            posed.deformedPrevious =
                deformsAlike(instance, open, previous) ? posed.deformed : deformAt(instance, previous);
    }
    posed.moves = posed.worldFromObject != posed.worldFromObjectClose ||
                  posed.worldFromObject != posed.worldFromObjectPrevious ||
                  posed.deformed != posed.deformedClose || posed.deformed != posed.deformedPrevious;
    return posed;
}

std::shared_ptr<const std::vector<Bounds3>> computeMeshBounds(const Scene& scene) {
    auto bounds = std::make_shared<std::vector<Bounds3>>(scene.instances.size());
    parallelFor(static_cast<int64_t>(bounds->size()), [&](int64_t i) {
        (*bounds)[static_cast<size_t>(i)] = boundsOf(scene.instances[static_cast<size_t>(i)].mesh->positions);
    });
    return bounds;
}

Bounds3 worldBounds(const PosedInstance& posed, const Bounds3& meshBounds) {
    return transformedBounds(posed.deformed ? boundsOf(posed.deformed->positions) : meshBounds, posed.worldFromObject);
}

void poseLights(const Moment& open, const Moment& previous, const PosedScene* earlier, PosedScene& posed) {
    const std::vector<Light>& lights = posed.scene->lights;
    const auto frame = [](const Light& light, const Moment& moment) {
        return light.node < 0 ? Mat4(1) : moment.nodes.worldFromNode[static_cast<size_t>(light.node)];
    };
    posed.lights.resize(lights.size());
    for (size_t i = 0; i < lights.size(); ++i) {
        posed.lights[i].worldFromLight = frame(lights[i], open);
        posed.lights[i].worldFromLightPrevious =
            earlier ? earlier->lights[i].worldFromLight : frame(lights[i], previous);
        posed.anythingMoves |= posed.lights[i].worldFromLight != posed.lights[i].worldFromLightPrevious;
    }
}

}  // namespace

size_t PosedScene::byteCount() const {
    size_t bytes = instances.size() * sizeof(PosedInstance) + lights.size() * sizeof(PosedLight);
    for (const PosedInstance& instance : instances)
        if (instance.deformed)
            bytes += sizeof(Vec3) * (instance.deformed->positions.size() + instance.deformed->normals.size() +
                                     instance.deformed->tangents.size());
    return bytes;
}

std::shared_ptr<const PosedScene> poseScene(std::shared_ptr<const Scene> scene, ShutterTimes times,
                                            const PosedScene* earlier) {
    if (!continues(earlier, *scene, times)) earlier = nullptr;
    const bool animated = !scene->animations.empty();
    const Moment open = poseMoment(*scene, times.open);
    std::optional<Moment> otherClose, otherPrevious;
    if (animated && times.close != times.open) otherClose = poseMoment(*scene, times.close);
    if (animated && times.previousOpen != times.open) otherPrevious = poseMoment(*scene, times.previousOpen);
    const Moment& close = otherClose ? *otherClose : open;
    const Moment& previous = otherPrevious ? *otherPrevious : open;
    const bool cut = times.previousOpen == times.open;

    auto posed = std::make_shared<PosedScene>();
    posed->scene = scene;
    posed->time = times.open;
    posed->previousTime = times.previousOpen;
    posed->meshBounds = earlier ? earlier->meshBounds : computeMeshBounds(*scene);
    posed->instances.resize(scene->instances.size());
    std::vector<Bounds3> bounds(scene->instances.size());
    const PosedScene* before = cut ? nullptr : earlier;
    parallelRanges(static_cast<int64_t>(bounds.size()), 16, [&](int64_t begin, int64_t end) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            posed->instances[i] =
                poseInstance(scene->instances[i], open, close, previous, before ? &before->instances[i] : nullptr);
            bounds[i] = worldBounds(posed->instances[i], (*posed->meshBounds)[i]);
        }
    });
    for (const Bounds3& b : bounds) posed->bounds.extend(b);
    for (const PosedInstance& instance : posed->instances)
        posed->anythingMoves |= instance.worldFromObject != instance.worldFromObjectPrevious ||
                                instance.deformed != instance.deformedPrevious;
    poseLights(open, previous, before, *posed);
    return posed;
}

}  // namespace lumi

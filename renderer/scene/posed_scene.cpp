#include "scene/posed_scene.h"

#include <optional>
#include <unordered_map>
#include <unordered_set>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/bounds.h"
#include "scene/posed_shutter.h"
#include "scene/reach.h"

namespace lumi {
namespace {

/// Whether `earlier` is the frame that `previousOpen` means, with the same things in it: then what it showed is what
/// motion refers to, also when a user moved an object since.
bool continues(const PosedScene* earlier, const Scene& scene, const ShutterTimes& times) {
    if (!earlier || earlier->time != times.previousOpen || earlier->instances.size() != scene.instances.size())
        return false;
    for (size_t i = 0; i < scene.instances.size(); ++i)
        if (earlier->scene->instances[i].mesh != scene.instances[i].mesh) return false;
    return earlier->scene->lights.size() == scene.lights.size();
}

/// What of the instance is otherwise at the other moments; it is made if need be, as it is at shutter open.
PosedMotion& motionOf(PosedInstance& posed) {
    if (!posed.motion)
        posed.motion = std::make_shared<PosedMotion>(PosedMotion{false, posed.worldFromObject, posed.worldFromObject,
                                                                 posed.deformed, posed.deformed, nullptr, nullptr});
    return *posed.motion;
}

PosedInstance poseInstance(const Instance& instance, const PosedMoment& open, const PosedMoment& close,
                           const PosedMoment& previous, const PosedInstance* earlier) {
    PosedInstance posed;
    posed.worldFromObject = placementOf(instance, open);
    const Mat4 atClose = placementOf(instance, close);
    const Mat4 before = earlier ? earlier->worldFromObject : placementOf(instance, previous);
    std::shared_ptr<const DeformedVertices> deformedClose, deformedPrevious;
    if (deforms(instance)) {
        posed.deformed = earlier && earlier->deformed && deformsAlike(instance, open, previous)
                             ? earlier->deformed
                             : deformAt(instance, open);
        deformedClose = deformsAlike(instance, open, close) ? posed.deformed : deformAt(instance, close);
        if (earlier && earlier->deformed) deformedPrevious = earlier->deformed;
        else deformedPrevious = deformsAlike(instance, open, previous) ? posed.deformed : deformAt(instance, previous);
    }
    if (posed.worldFromObject != atClose || posed.worldFromObject != before || posed.deformed != deformedClose ||
        posed.deformed != deformedPrevious)
        posed.motion = std::make_shared<PosedMotion>(PosedMotion{true, atClose, before, std::move(deformedClose),
                                                                 std::move(deformedPrevious), nullptr, nullptr});
    return posed;
}

void checkStop(const std::stop_token& stop) {
    if (stop.stop_requested()) throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
}

std::shared_ptr<const std::vector<Bounds3>> computeMeshBounds(const Scene& scene) {
    auto bounds = std::make_shared<std::vector<Bounds3>>(scene.instances.size());
    std::vector<const Mesh*> meshes;
    std::unordered_map<const Mesh*, size_t> placeOf;
    std::vector<size_t> places;
    places.reserve(scene.instances.size());
    for (const Instance& instance : scene.instances) {
        const auto [entry, isNew] = placeOf.try_emplace(instance.mesh.get(), meshes.size());
        if (isNew) meshes.push_back(instance.mesh.get());
        places.push_back(entry->second);
    }
    std::vector<Bounds3> ofMeshes(meshes.size());
    parallelFor(static_cast<int64_t>(meshes.size()), [&](int64_t i) {
        ofMeshes[static_cast<size_t>(i)] = boundsOf(meshes[static_cast<size_t>(i)]->positions);
    });
    for (size_t i = 0; i < places.size(); ++i) (*bounds)[i] = ofMeshes[places[i]];
    return bounds;
}

Bounds3 worldBounds(const PosedInstance& posed, const Bounds3& meshBounds) {
    return transformedBounds(posed.deformed ? boundsOf(posed.deformed->positions) : meshBounds, posed.worldFromObject);
}

void poseLights(const PosedMoment& open, const PosedMoment& previous, const PosedScene* earlier, PosedScene& posed) {
    posed.lights.resize(posed.scene->lights.size());
    for (size_t i = 0; i < posed.lights.size(); ++i) {
        posed.lights[i].worldFromLight = open.worldFromLight[i];
        posed.lights[i].worldFromLightPrevious =
            earlier ? earlier->lights[i].worldFromLight : previous.worldFromLight[i];
        posed.anythingMoves |= posed.lights[i].worldFromLight != posed.lights[i].worldFromLightPrevious;
    }
}

/// Motion vectors of a frame refer to the tracks of the frame before, whatever the shutter is now.
void keepPreviousTracks(const PosedScene& before, PosedScene& posed) {
    for (size_t i = 0; i < posed.instances.size(); ++i)
        if (before.instances[i].track()) motionOf(posed.instances[i]).previousTrack = before.instances[i].motion->track;
    for (size_t i = 0; i < posed.lights.size(); ++i) posed.lights[i].previousTrack = before.lights[i].track;
}

/// Fills in what moves while the shutter is open, in this frame and in the one before.
void openShutter(const ShutterTimes& times, bool cut, const PosedScene* before, PosedScene& posed,
                 const std::stop_token& stop) {
    const Scene& scene = *posed.scene;
    const std::vector<Bounds3>& bounds = *posed.meshBounds;
    const std::vector<PosedMoment> moments = shutterMoments(scene, times.open, times.close, bounds, stop);
    std::vector<PosedMoment> earlier;
    if (!cut && !before)
        earlier =
            shutterMoments(scene, times.previousOpen, times.previousOpen + times.close - times.open, bounds, stop);
    parallelRanges(
        static_cast<int64_t>(posed.instances.size()), 16,
        [&](int64_t begin, int64_t end) {
            for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
                if (stop.stop_requested()) return;
                PosedInstance& pose = posed.instances[i];
                std::shared_ptr<const ShutterTrack> track = shutterTrack(scene.instances[i], moments, bounds[i],
                                                                         pose.deformed),
                                                    previous;
                if (!earlier.empty())
                    previous = shutterTrack(scene.instances[i], earlier, bounds[i], pose.deformedPrevious());
                if (cut) previous = track;
                if (!track && !previous) continue;
                PosedMotion& motion = motionOf(pose);
                motion.moves |= track != nullptr;
                if (track) pose.worldFromObject = track->worldFromObject.front();
                if (previous) motion.worldFromObjectPrevious = previous->worldFromObject.front();
                motion.track = std::move(track), motion.previousTrack = std::move(previous);
            }
        },
        stop);
    checkStop(stop);
    for (size_t i = 0; i < posed.lights.size(); ++i) {
        PosedLight& light = posed.lights[i];
        light.track = shutterFrames(i, moments);
        if (!earlier.empty()) light.previousTrack = shutterFrames(i, earlier);
        if (cut) light.previousTrack = light.track;
    }
    if (before) keepPreviousTracks(*before, posed);
}

}  // namespace

size_t PosedScene::byteCount() const {
    size_t bytes = instances.size() * sizeof(PosedInstance) + lights.size() * sizeof(PosedLight);
    std::unordered_set<const DeformedVertices*> counted{nullptr};
    const auto addShape = [&](const std::shared_ptr<const DeformedVertices>& shape) {
        if (!counted.insert(shape.get()).second) return;
        bytes += sizeof(Vec3) *
                 (shape->positions.size() + shape->normals.size() + shape->tangents.size() + shape->bitangents.size());
    };
    for (const PosedInstance& instance : instances) {
        addShape(instance.deformed);
        if (instance.motion) bytes += sizeof(PosedMotion);
        const ShutterTrack* track = instance.track();
        for (size_t i = 0; track && i < track->deformed.size(); ++i) addShape(track->deformed[i]);
    }
    return bytes;
}

std::shared_ptr<const PosedScene> poseScene(std::shared_ptr<const Scene> scene, ShutterTimes times,
                                            const PosedScene* earlier, std::stop_token stop) {
    checkStop(stop);
    if (!continues(earlier, *scene, times)) earlier = nullptr;
    const bool animated = !scene->animations.empty();
    const PosedMoment open = poseMoment(*scene, times.open);
    std::optional<PosedMoment> otherClose, otherPrevious;
    if (animated && times.close != times.open) otherClose = poseMoment(*scene, times.close);
    if (animated && times.previousOpen != times.open) otherPrevious = poseMoment(*scene, times.previousOpen);
    const PosedMoment& close = otherClose ? *otherClose : open;
    const PosedMoment& previous = otherPrevious ? *otherPrevious : open;
    const bool cut = times.previousOpen == times.open;

    auto posed = std::make_shared<PosedScene>();
    posed->scene = scene;
    posed->time = times.open;
    posed->previousTime = times.previousOpen;
    posed->closeTime = times.close;
    posed->meshBounds = earlier ? earlier->meshBounds : computeMeshBounds(*scene);
    posed->instances.resize(scene->instances.size());
    std::vector<Bounds3> bounds(scene->instances.size());
    const PosedScene* before = cut ? nullptr : earlier;
    parallelRanges(
        static_cast<int64_t>(bounds.size()), 16,
        [&](int64_t begin, int64_t end) {
            for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
                if (stop.stop_requested()) return;
                posed->instances[i] =
                    poseInstance(scene->instances[i], open, close, previous, before ? &before->instances[i] : nullptr);
                bounds[i] = worldBounds(posed->instances[i], (*posed->meshBounds)[i]);
            }
        },
        stop);
    checkStop(stop);
    for (const Bounds3& b : bounds) posed->bounds.extend(b);
    for (const PosedInstance& instance : posed->instances)
        posed->anythingMoves |= instance.worldFromObject != instance.worldFromObjectPrevious() ||
                                instance.deformed != instance.deformedPrevious();
    poseLights(open, previous, before, *posed);
    if (animated && times.close != times.open) openShutter(times, cut, before, *posed, stop);
    else if (before) keepPreviousTracks(*before, *posed);
    requireReach(*posed, bounds);
    return posed;
}

}  // namespace lumi

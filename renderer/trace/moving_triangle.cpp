#include "trace/moving_triangle.h"

#include "trace/carried_steps.h"

namespace lumi {
namespace {

/// Copies a corner's values and lets `source` point to the copies; attributes that are not there stay so.
template <class T>
void take(const T*& source, const UVec3& t, T* copies) {
    if (!source) return;
    for (int c = 0; c < 3; ++c) copies[c] = source[t[c]];
    source = copies;
}

}  // namespace

MovingTriangle::MovingTriangle(const InstanceRecord& instance, uint32_t primitive, float time) : instance_(instance) {
    const ShutterTrack& track = *instance.track;
    const UVec3 t = instance.triangles[primitive];
    instance_.worldFromObject = track.worldFromObjectAt(time);
    instance_.normalFromObject = normalMatrix(instance_.worldFromObject);
    if (!track.deformed.empty()) instance_.turned = track.isMirroredAt(time);
    instance_.mirrored = isMirroring(instance_.worldFromObject) != instance_.turned;
    if (track.deformed.empty()) {
        take(instance_.positions, t, positions_);
        take(instance_.normals, t, normals_);
        take(instance_.deformedTangents, t, deformedTangents_);
        take(instance_.deformedBitangents, t, deformedBitangents_);
    } else {
        const TrackPlace place = trackPlace(track.deformed.size(), time);
        const DeformedVertices& a = *track.deformed[place.first];
        const DeformedVertices& b = *track.deformed[place.fraction > 0 ? place.first + 1 : place.first];
        const auto between = [&](const std::vector<Vec3>& from, const std::vector<Vec3>& to, Vec3* out) {
            for (int c = 0; c < 3; ++c) out[c] = from[t[c]] * (1 - place.fraction) + to[t[c]] * place.fraction;
        };
        between(a.positions, b.positions, positions_);
        instance_.positions = positions_;
        if (!a.normals.empty()) between(a.normals, b.normals, normals_), instance_.normals = normals_;
        instance_.deformedTangents = instance_.deformedBitangents = nullptr;
        if (!a.tangents.empty())
            between(a.tangents, b.tangents, deformedTangents_), instance_.deformedTangents = deformedTangents_;
        if (!a.bitangents.empty())
            between(a.bitangents, b.bitangents, deformedBitangents_),
                instance_.deformedBitangents = deformedBitangents_;
    }
    if (instance.carried) {
        const unsigned steps = carriedSteps(track);
        const TrackPlace place = trackPlace(steps, time);
        const auto step = static_cast<unsigned>(place.first);
        const CarriedStep from(track, instance.positions, step, steps),
            to(track, instance.positions, place.fraction > 0 ? step + 1 : step, steps);
        for (int c = 0; c < 3; ++c) positions_[c] = glm::mix(from.vertex(t[c]), to.vertex(t[c]), place.fraction);
        instance_.positions = positions_;
        instance_.inWorld = true;
    }
    take(instance_.restPositions, t, restPositions_);
    take(instance_.restNormals, t, restNormals_);
    take(instance_.tangents, t, tangents_);
    take(instance_.colours, t, colours_);
    take(instance_.uv[0], t, uv_[0]);
    take(instance_.uv[1], t, uv_[1]);
}

}  // namespace lumi

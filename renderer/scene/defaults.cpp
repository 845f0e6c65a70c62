#include "scene/defaults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "scene/deform.h"
#include "scene/pose_bounds.h"

namespace lumi {
namespace {

constexpr int kSpread = 48;         ///< directions over the sphere
constexpr int kRays = kSpread + 4;  ///< and the four horizontal axes: +x, -x, +z, -z

/// Directions spread evenly over the sphere by the golden angle, then the horizontal axes.
std::array<Vec3, kRays> spreadDirections() {
    std::array<Vec3, kRays> directions;
    for (int i = 0; i < kSpread; ++i) {
        const float y = 1 - (2 * static_cast<float>(i) + 1) / kSpread;
        const float r = std::sqrt(1 - y * y), angle = 2.39996323f * static_cast<float>(i);
        directions[static_cast<size_t>(i)] = {r * std::cos(angle), y, r * std::sin(angle)};
    }
    directions[kSpread] = {1, 0, 0}, directions[kSpread + 1] = {-1, 0, 0};
    directions[kSpread + 2] = {0, 0, 1}, directions[kSpread + 3] = {0, 0, -1};
    return directions;
}

/// The nearest triangle that each ray meets: its distance, and whether it shows the origin its front.
struct FirstHits {
    std::array<float, kRays> distance;
    std::array<bool, kRays> front{};
    FirstHits() { distance.fill(kInfinity); }

    void add(size_t ray, float at, bool isFront) {
        if (at > distance[ray] || (at == distance[ray] && front[ray])) return;
        distance[ray] = at;
        front[ray] = isFront;
    }
    void add(const FirstHits& other) {
        for (size_t i = 0; i < kRays; ++i)
            if (other.distance[i] < kInfinity) add(i, other.distance[i], other.front[i]);
    }
};

/// Adds the rays from the origin that meet the triangle a b c. A ray through the corner pyramid has the three edge
/// planes on one side; the triangle's own plane tells ahead from behind.
void addTriangle(const std::array<Vec3, kRays>& directions, const Vec3& a, const Vec3& b, const Vec3& c, bool mirrored,
                 FirstHits& hits) {
    const Vec3 ab = glm::cross(a, b), bc = glm::cross(b, c), ca = glm::cross(c, a);
    const float volume = glm::dot(a, bc);
    if (volume == 0) return;
    for (size_t i = 0; i < kRays; ++i) {
        const float u = glm::dot(directions[i], ab), v = glm::dot(directions[i], bc), w = glm::dot(directions[i], ca);
        const bool ahead = volume > 0 ? u >= 0 && v >= 0 && w >= 0 : u <= 0 && v <= 0 && w <= 0;
        // u + v + w is the triangle's normal times the direction: 0 for slivers that the ray runs along.
        if (ahead && u + v + w != 0) hits.add(i, volume / (u + v + w), (volume < 0) != mirrored);
    }
}

/// Whether a ray from `origin` may meet something in `box` nearer than what it has met: by the box's slabs, a little
/// widened against rounding.
bool mayMeet(const Bounds3& box, const Vec3& origin, const std::array<Vec3, kRays>& directions, const FirstHits& hits) {
    const Vec3 margin = 1e-4f * (box.upper - box.lower) + 1e-5f * glm::max(glm::abs(box.lower), glm::abs(box.upper)) +
                        1e-5f * glm::abs(origin);
    const Vec3 lower = box.lower - margin - origin, upper = box.upper + margin - origin;
    for (size_t i = 0; i < kRays; ++i) {
        float nearest = 0, farthest = kInfinity;
        for (int axis = 0; axis < 3; ++axis) {
            const float along = directions[i][axis];
            if (along == 0) {
                if (lower[axis] > 0 || upper[axis] < 0) farthest = -1;
                continue;
            }
            const float a = lower[axis] / along, b = upper[axis] / along;
            nearest = std::max(nearest, std::min(a, b)), farthest = std::min(farthest, std::max(a, b));
        }
        if (nearest <= farthest && nearest <= hits.distance[i]) return true;
    }
    return false;
}

/// Adds what the rays from `origin` meet of the instance at time 0.
void traceInstance(const NodePose& pose, PosedSkins& skins, const Instance& instance, const Vec3& origin,
                   const std::array<Vec3, kRays>& directions, FirstHits& hits) {
    const Mesh& mesh = *instance.mesh;
    const bool skinned = instance.skin >= 0 && !mesh.skin.empty();
    Mat4 worldFromObject(1);
    DeformedVertices deformed;
    if (instance.node >= 0 && !skinned) worldFromObject = pose.worldFromNode[static_cast<size_t>(instance.node)];
    if (mesh.deforms()) {
        const std::vector<Mat4>& joints = skins.of(skinned ? instance.skin : -1);
        deformed = deform(
            mesh, instance.node >= 0 ? pose.morphWeights[static_cast<size_t>(instance.node)] : std::vector<float>(),
            joints);
    }
    const std::vector<Vec3>& positions = mesh.deforms() ? deformed.positions : mesh.positions;
    const bool mirrored = isMirroring(worldFromObject) != deformed.isMirrored();
    std::mutex mutex;
    parallelRanges(static_cast<int64_t>(mesh.triangles.size()), 4096, [&](int64_t begin, int64_t end) {
        FirstHits found;
        for (int64_t i = begin; i < end; ++i) {
            const UVec3 t = mesh.triangles[static_cast<size_t>(i)];
            const auto corner = [&](uint32_t v) { return transformPoint(worldFromObject, positions[v]) - origin; };
            addTriangle(directions, corner(t.x), corner(t.y), corner(t.z), mirrored, found);
        }
        const std::lock_guard lock(mutex);
        hits.add(found);
    });
}

/// Distance from the centre of a box at which a square image of this half-angle, looking along -back, holds it all.
float framingDistance(const Vec3& halfSize, const Mat3& axes, float halfAngle) {
    const float slope = std::tan(halfAngle);
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p = halfSize * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        const float side = std::max(std::abs(glm::dot(p, axes[0])), std::abs(glm::dot(p, axes[1])));
        distance = std::max(distance, side / slope + glm::dot(p, axes[2]));
    }
    return distance;
}

/// Whether a material is there to light others. An emission texture without extra strength only paints glowing parts,
/// as on models that expect to be lit from outside; unlit surfaces are pictures of light, not lamps.
bool illuminates(const Material& material) {
    return material.emits() && !material.unlit && (!material.emissionTexture || maxComponent(material.emission) > 1);
}

/// Whether something in the scene wears a material of that kind.
bool someSurface(const Scene& scene, bool (*isOfKind)(const Material&)) {
    std::unordered_set<const Mesh*> seen;
    for (const Instance& instance : scene.instances) {
        if (instance.material >= 0) {
            if (isOfKind(scene.materials[static_cast<size_t>(instance.material)])) return true;
            continue;
        }
        if (!seen.insert(instance.mesh.get()).second) continue;
        if (instance.mesh->triangleMaterial.empty()) {
            if (isOfKind(scene.materials[instance.mesh->material])) return true;
            continue;
        }
        for (const uint32_t material : instance.mesh->triangleMaterial)
            if (isOfKind(scene.materials[material])) return true;
    }
    return false;
}

FirstHits lookAround(const Scene& scene, const Vec3& origin, const std::stop_token& stop = {}) {
    const std::array<Vec3, kRays> directions = spreadDirections();
    const NodePose pose = poseNodes(scene, 0.0f);
    PosedSkins skins(scene, pose);
    FirstHits hits;
    MeshBounds meshBounds;
    constexpr size_t kPollStride = 64;
    // Triangles that are traced of meshes once more: seconds, where thousands stand around one place.
    constexpr uint64_t kMostAgain = uint64_t(1) << 24;
    std::unordered_set<const Mesh*> traced;
    uint64_t again = 0;
    size_t next = 0;
    eachBounds(scene, pose, meshBounds, [&](const Bounds3& box) {
        if (next % kPollStride == 0) checkLoadStop(scene, stop);
        const Instance& instance = scene.instances[next++];
        if (!mayMeet(box, origin, directions, hits)) return;
        const bool isFirst = traced.insert(instance.mesh.get()).second;
        if (!isFirst) again += instance.mesh->triangles.size();
        if (isFirst || again <= kMostAgain) traceInstance(pose, skins, instance, origin, directions, hits);
    });
    return hits;
}

float enclosureOf(const FirstHits& hits) {
    return static_cast<float>(std::count(hits.front.begin(), hits.front.begin() + kSpread, true)) / kSpread;
}

/// Stands in a room and looks along its longer horizontal axis: from the middle, or, if the room is open at one end of
/// the axis, from there. False, and nothing done, if that is no place to look from: the first thing in sight is right
/// before the camera, both ways in a closed room.
bool standInside(const Vec3& centre, const Vec3& half, const FirstHits& hits, Camera& camera) {
    const auto isOpen = [&](int axis, int end) {
        return hits.distance[static_cast<size_t>(kSpread + 2 * axis + end)] == kInfinity;
    };
    const auto openEnds = [&](int axis) { return int(isOpen(axis, 0)) + int(isOpen(axis, 1)); };
    int axis = half.x >= half.z ? 0 : 1;
    const bool nearlySquare = std::min(half.x, half.z) > 0.95f * std::max(half.x, half.z);
    if (nearlySquare && openEnds(axis) != 1 && openEnds(1 - axis) == 1) axis = 1 - axis;
    const Vec3 along = axis == 0 ? Vec3(half.x, 0, 0) : Vec3(0, 0, half.z);
    const bool fromOpening = openEnds(axis) == 1;
    int end = fromOpening ? (isOpen(axis, 0) ? 1 : 0) : axis;
    const auto isBlocked = [&] {
        return hits.distance[static_cast<size_t>(kSpread + 2 * axis + end)] < 0.25f * half[2 * axis];
    };
    if (!fromOpening && isBlocked()) end = 1 - end;
    if (isBlocked()) return false;
    const Vec3 forward = end == 0 ? along : -along;
    camera.eye = fromOpening ? centre - 0.98f * forward : centre;
    camera.target = centre + forward;
    return true;
}

}  // namespace

float enclosure(const Scene& scene, const Vec3& origin) { return enclosureOf(lookAround(scene, origin)); }

Camera defaultCamera(const Scene& scene, std::stop_token stop) {
    Camera camera;
    const Bounds3 bounds = boundsOverTime(scene, stop);
    if (bounds.empty() || !isFinite(bounds.size())) return camera;
    const Vec3 centre = bounds.centre(), half = glm::max(0.5f * bounds.size(), Vec3(1e-6f));
    const FirstHits hits = lookAround(scene, centre, stop);
    if (enclosureOf(hits) < 0.75f || !standInside(centre, half, hits, camera)) {
        const Vec3 from = glm::normalize(Vec3(0.35f, 0.22f, 1));
        const Mat3 axes(lookAt(from, Vec3(0)));
        camera.target = centre;
        camera.eye = centre + from * (1.08f * framingDistance(half, axes, radians(0.5f * camera.fovYDeg)));
    }
    camera.focus = std::clamp(glm::distance(camera.eye, camera.target), 1e-3f, 1e6f);
    return camera;
}

bool hasLight(const Scene& scene) {
    return !scene.lights.empty() || scene.environment.visible() || someSurface(scene, illuminates);
}

void addDefaults(Scene& scene, MessageLog& log, bool allowSky, std::stop_token stop) {
    if (scene.cameras.empty())
        scene.cameras.push_back({defaultCamera(scene, std::move(stop)), -1, {}, Interpolation::CatmullRom});
    if (!allowSky || hasLight(scene)) return;
    const auto lit = [](const Material& material) { return !material.unlit; };
    if (!scene.instances.empty() && !someSurface(scene, lit)) return;
    scene.environment.standIn = std::make_shared<const Image>(makeDefaultSky());
    scene.environment.chooseStandIn();
    const auto emits = [](const Material& material) { return material.emits() && !material.unlit; };
    log.warning(scene.path +
                (someSurface(scene, emits)
                     ? ": no light, and emission only in textures of strength 1 or less, which paint glowing "
                       "parts; lit by the built-in sky unless another is set (environment.scale 0 takes it away)"
                     : ": no light and no emission; lit by the built-in sky unless another is set"));
}

}  // namespace lumi

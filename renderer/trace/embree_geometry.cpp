// Embree geometries of meshes and light bodies, and the filters that make them transparent and single-sided.
#include <algorithm>
#include <cstring>
#include <unordered_map>

#include "math/hash.h"
#include "trace/carried_steps.h"
#include "trace/coverage.h"
#include "trace/embree_parts.h"
#include "trace/packets.h"

namespace lumi {

RTCScene EmbreeScene::newScene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneProgressMonitorFunction(scene, &Monitor::goesOn, monitor_.get());
    return scene;
}

RTCGeometry EmbreeScene::newTriangles(unsigned steps, size_t vertexCount, const Mesh& mesh, bool filtered,
                                      const std::function<void(unsigned step, Vec3* vertices)>& place) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, steps);
    for (unsigned step = 0; step < steps; ++step) {
        auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                                                    RTC_FORMAT_FLOAT3, sizeof(Vec3), vertexCount));
        if (vertices) place(step, vertices);
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(UVec3), mesh.triangles.size());
    if (filtered) {
        rtcSetGeometryUserData(geometry, const_cast<EmbreeScene*>(this));
        rtcSetGeometryIntersectFilterFunction(geometry, &EmbreeScene::filter);
        rtcSetGeometryOccludedFilterFunction(geometry, &EmbreeScene::filter);
    }
    rtcCommitGeometry(geometry);
    return geometry;
}

RTCGeometry EmbreeScene::newMesh(const Mesh& mesh, bool filtered, const Mat4* transform) const {
    const std::vector<Vec3>& rest = mesh.positions;
    return newTriangles(1, rest.size(), mesh, filtered, [&](unsigned, Vec3* vertices) {
        if (transform)
            for (size_t i = 0; i < rest.size(); ++i) vertices[i] = transformPoint(*transform, rest[i]);
        else std::copy(rest.begin(), rest.end(), vertices);
    });
}

RTCGeometry EmbreeScene::newDeforming(const PosedScene& posed, uint32_t index, const Plan& plan) const {
    const PosedInstance& pose = posed.instances[index];
    const Mesh& mesh = posed.mesh(index);
    const ShutterTrack* track = pose.track();
    const std::vector<Vec3>& still = pose.deformed ? pose.deformed->positions : mesh.positions;
    const size_t count = still.size();
    if (track && plan.inWorld) {
        const unsigned steps = carriedSteps(*track);
        return newTriangles(steps, count, mesh, plan.filtered, [&](unsigned step, Vec3* vertices) {
            const CarriedStep carried(*track, still.data(), step, steps);
            for (size_t i = 0; i < count; ++i) vertices[i] = carried.vertex(i);
        });
    }
    const size_t shapes = track ? track->deformed.size() : 0;
    const auto steps = static_cast<unsigned>(std::max<size_t>(shapes, 1));
    return newTriangles(steps, count, mesh, plan.filtered, [&](unsigned step, Vec3* vertices) {
        const std::vector<Vec3>& shape = shapes > 0 ? track->deformed[step]->positions : still;
        std::copy(shape.begin(), shape.end(), vertices);
        if (!plan.inWorld) return;
        for (size_t i = 0; i < count; ++i) vertices[i] = transformPoint(pose.worldFromObject, vertices[i]);
    });
}

RTCGeometry EmbreeScene::newBody(const PosedScene& posed, uint32_t index) const {
    const Body body(posed, index);
    std::span<const LightShape> shapes = body.shutterShapes;
    if (shapes.empty()) shapes = {&body.shape, 1};
    const bool disk = body.shape.type == LightType::Disk;
    const bool circle = disk && shapes.size() == 1 && body.shape.isCircle();
    const bool quad = !circle && body.shape.type != LightType::Sphere;
    RTCGeometry geometry = rtcNewGeometry(device_, quad     ? RTC_GEOMETRY_TYPE_QUAD
                                                   : circle ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT
                                                            : RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(shapes.size()));
    const auto set = [&](RTCBufferType type, unsigned slot, RTCFormat format, const auto& values) {
        using Value = std::remove_cvref_t<decltype(values[0])>;
        void* data = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(Value), std::size(values));
        if (data) std::memcpy(data, &values[0], sizeof(values));
    };
    for (unsigned step = 0; step < shapes.size(); ++step) {
        const LightShape& s = shapes[step];
        if (quad) {
            const Vec3 corners[] = {s.centre - s.halfX - s.halfY, s.centre + s.halfX - s.halfY,
                                    s.centre + s.halfX + s.halfY, s.centre - s.halfX + s.halfY};
            set(RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, corners);
            continue;
        }
        const Vec4 point[] = {Vec4(s.centre, s.radius)};
        set(RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, point);
        const Vec3 normal[] = {s.normal};
        if (circle) set(RTC_BUFFER_TYPE_NORMAL, step, RTC_FORMAT_FLOAT3, normal);
    }
    const glm::uvec4 corners[] = {{0, 1, 2, 3}};
    if (quad) set(RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, corners);
    if (quad && disk) {
        rtcSetGeometryIntersectFilterFunction(geometry, &EmbreeScene::filterCorners);
        rtcSetGeometryOccludedFilterFunction(geometry, &EmbreeScene::filterCorners);
    }
    rtcCommitGeometry(geometry);
    return geometry;
}

void EmbreeScene::filterCorners(const RTCFilterFunctionNArguments* arguments) {
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        const float x = 2 * RTCHitN_u(arguments->hit, n, i) - 1, y = 2 * RTCHitN_v(arguments->hit, n, i) - 1;
        if (x * x + y * y > 1) arguments->valid[i] = 0;
    }
}

void EmbreeScene::filter(const RTCFilterFunctionNArguments* arguments) {
    const PosedScene& posed = *static_cast<const EmbreeScene*>(arguments->geometryUserPtr)->posed_;
    const unsigned n = arguments->N;
    for (unsigned i = 0; i < n; ++i) {
        if (arguments->valid[i] == 0) continue;
        const uint32_t placed = RTCHitN_instID(arguments->hit, n, i, 0);
        const uint32_t instance = placed != RTC_INVALID_GEOMETRY_ID ? placed : RTCHitN_geomID(arguments->hit, n, i);
        const uint32_t primitive = RTCHitN_primID(arguments->hit, n, i);
        const Material& material = posed.material(instance, primitive);
        if (material.alphaMode == AlphaMode::Opaque) continue;
        const Mesh& mesh = posed.mesh(instance);
        const auto data = [](const auto& values) { return values.empty() ? nullptr : values.data(); };
        const Vec2* const uv[2] = {data(mesh.uv[0]), data(mesh.uv[1])};
        const float alpha = alphaAt(material, mesh.triangles[primitive], data(mesh.colours), uv,
                                    {RTCHitN_u(arguments->hit, n, i), RTCHitN_v(arguments->hit, n, i)});
        const float least = material.alphaMode == AlphaMode::Mask
                                ? material.alphaCutoff
                                : unitFloat(hashCombine(RTCRayN_id(arguments->ray, n, i), instance, primitive));
        // A blended hit stands with probability alpha; a masked one at alpha >= cutoff.
        const bool stands = material.alphaMode == AlphaMode::Mask ? alpha >= least : alpha > least;
        if (!stands) arguments->valid[i] = 0;
    }
}

EmbreeScene::Context::Context(const EmbreeScene& of, std::span<const BatchRay> rays) : scene(&of) {
    rtcInitIntersectContext(this);
    const auto fromCamera = [](const BatchRay& ray) { return ray.fromCamera; };
    if (of.hidesBackFaces_ && std::any_of(rays.begin(), rays.end(), fromCamera)) filter = &EmbreeScene::filterBackFaces;
}

namespace {

/// glTF's back-face culling. Rays that leave glass meet its faces from behind: what transmits has two sides always.
bool isSingleSided(const Material& material) { return !material.doubleSided && material.transmission == 0; }

/// Of a triangle; an index out of range shades with the first material.
bool isSingleSided(const PosedScene& posed, uint32_t instance, uint32_t primitive) {
    const std::vector<Material>& materials = posed.scene->materials;
    const uint32_t index = posed.materialIndex(instance, primitive);
    return isSingleSided(materials[index < materials.size() ? index : 0]);
}

/// Where it is traced, in the world or in its own space: are its faces turned round at a time of the open shutter?
bool isTurnedAt(const PosedInstance& pose, bool inWorld, float time) {
    const ShutterTrack& track = *pose.track();
    const bool byJoints =
        track.deformed.empty() ? pose.deformed && pose.deformed->isMirrored() : track.isMirroredAt(time);
    return byJoints != (inWorld && isMirroring(track.worldFromObjectAt(time)));
}

/// Are they at one time and not at another?
bool turnsOver(const PosedInstance& pose, bool inWorld) {
    if (!pose.track()) return false;
    const auto& shapes = pose.track()->deformed;
    return inWorld || std::any_of(shapes.begin(), shapes.end(),
                                  [&](const auto& shape) { return shape->isMirrored() != shapes[0]->isMirrored(); });
}

}  // namespace

void EmbreeScene::findSides(const PosedScene& posed) {
    sides_.assign(plans_.size(), Sides());
    hidesBackFaces_ = false;
    const std::vector<Material>& materials = posed.scene->materials;
    const bool anywhere =
        std::any_of(materials.begin(), materials.end(), [](const Material& m) { return isSingleSided(m); });
    std::unordered_map<const Mesh*, bool> ofMeshes;  // those whose triangles have materials of their own
    const auto isSingle = [&](uint32_t i) {
        const std::vector<uint32_t>& ofTriangles = posed.mesh(i).triangleMaterial;
        if (posed.scene->instances[i].material >= 0 || ofTriangles.empty()) return isSingleSided(posed, i, 0);
        const auto [known, isNew] = ofMeshes.try_emplace(&posed.mesh(i), false);
        for (uint32_t t = 0; isNew && t < ofTriangles.size() && !known->second; ++t)
            known->second = isSingleSided(posed, i, t);
        return known->second;
    };
    for (uint32_t i = 0; anywhere && i < plans_.size(); ++i) {
        const Plan& plan = plans_[i];
        if (plan.mode == Mode::None || plan.mode == Mode::Body || plan.mode == Mode::MovingBody) continue;
        // What is not in world space is traced in its own, where glTF's front faces turn counter-clockwise, mirrored or
        // not, unless joints mirror them there.
        const PosedInstance& pose = posed.instances[i];
        const bool isPlaceMirrored = plan.inWorld && glm::determinant(glm::mat3(pose.worldFromObject)) < 0;
        sides_[i].turned = isPlaceMirrored != (pose.deformed && pose.deformed->isMirrored());
        sides_[i].turnsOver = turnsOver(pose, plan.inWorld);
        sides_[i].single = isSingle(i);
        hidesBackFaces_ |= sides_[i].single;
    }
}

void EmbreeScene::filterBackFaces(const RTCFilterFunctionNArguments* arguments) {
    const EmbreeScene& scene = *static_cast<const Context*>(arguments->context)->scene;
    const unsigned n = arguments->N;
    RTCRayN* ray = arguments->ray;
    RTCHitN* hit = arguments->hit;
    for (unsigned i = 0; i < n; ++i) {
        if (arguments->valid[i] == 0 || !(RTCRayN_flags(ray, n, i) & kFromCamera)) continue;
        const uint32_t placed = RTCHitN_instID(hit, n, i, 0);
        const uint32_t instance = placed != RTC_INVALID_GEOMETRY_ID ? placed : RTCHitN_geomID(hit, n, i);
        const Sides sides = scene.sides_[instance];
        if (!sides.single) continue;
        const float time = RTCRayN_time(ray, n, i);
        const float along = RTCHitN_Ng_x(hit, n, i) * RTCRayN_dir_x(ray, n, i) +
                            RTCHitN_Ng_y(hit, n, i) * RTCRayN_dir_y(ray, n, i) +
                            RTCHitN_Ng_z(hit, n, i) * RTCRayN_dir_z(ray, n, i);
        const bool turned = sides.turnsOver
                                ? isTurnedAt(scene.posed_->instances[instance], scene.plans_[instance].inWorld, time)
                                : sides.turned;
        const bool back = turned ? along < 0 : along > 0;
        if (back && isSingleSided(*scene.posed_, instance, RTCHitN_primID(hit, n, i))) arguments->valid[i] = 0;
    }
}

}  // namespace lumi

// Embree geometries of meshes and light bodies, and the filter that makes them transparent.
#include <cstring>

#include "math/hash.h"
#include "trace/coverage.h"
#include "trace/embree_parts.h"

namespace lumi {

RTCScene EmbreeScene::newScene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

RTCGeometry EmbreeScene::newTriangles(std::span<const Vec3* const> positions, size_t vertexCount, const Mesh& mesh,
                                      const Mat4* transform, bool filtered) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(positions.size()));
    for (unsigned step = 0; step < positions.size(); ++step) {
        auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                                                    RTC_FORMAT_FLOAT3, sizeof(Vec3), vertexCount));
        if (vertices && transform)
            for (size_t i = 0; i < vertexCount; ++i) vertices[i] = transformPoint(*transform, positions[step][i]);
        else if (vertices)
            std::memcpy(static_cast<void*>(vertices), positions[step], vertexCount * sizeof(Vec3));
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

RTCGeometry EmbreeScene::newDeforming(const Plan& plan, const DeformedVertices& open) const {
    std::vector<const Vec3*> steps;
    if (plan.track)
        for (const auto& shape : plan.track->deformed) steps.push_back(shape->positions.data());
    if (steps.empty()) steps.push_back(open.positions.data());
    return newTriangles(steps, open.positions.size(), *plan.mesh, nullptr, plan.filtered);
}

RTCGeometry EmbreeScene::newBody(const Plan& plan) const {
    std::span<const LightShape> shapes = plan.shutterShapes;
    if (shapes.empty()) shapes = {&plan.shape, 1};
    const bool rectangle = plan.shape.type == LightType::Rectangle, disk = plan.shape.type == LightType::Disk;
    RTCGeometry geometry = rtcNewGeometry(device_, rectangle ? RTC_GEOMETRY_TYPE_QUAD
                                                   : disk    ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT
                                                             : RTC_GEOMETRY_TYPE_SPHERE_POINT);
    rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(shapes.size()));
    const auto set = [&](RTCBufferType type, unsigned slot, RTCFormat format, const auto& values) {
        using Value = std::remove_cvref_t<decltype(values[0])>;
        void* data = rtcSetNewGeometryBuffer(geometry, type, slot, format, sizeof(Value), std::size(values));
        if (data) std::memcpy(data, &values[0], sizeof(values));
    };
    for (unsigned step = 0; step < shapes.size(); ++step) {
        const LightShape& s = shapes[step];
        if (rectangle) {
            const Vec3 corners[] = {s.centre - s.halfX - s.halfY, s.centre + s.halfX - s.halfY,
                                    s.centre + s.halfX + s.halfY, s.centre - s.halfX + s.halfY};
            set(RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, corners);
            continue;
        }
        const Vec4 point[] = {Vec4(s.centre, s.radius)};
        set(RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT4, point);
        const Vec3 normal[] = {s.normal};
        if (disk) set(RTC_BUFFER_TYPE_NORMAL, step, RTC_FORMAT_FLOAT3, normal);
    }
    const glm::uvec4 corners[] = {{0, 1, 2, 3}};
    if (rectangle) set(RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, corners);
    rtcCommitGeometry(geometry);
    return geometry;
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

}  // namespace lumi

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

RTCGeometry EmbreeScene::newTriangles(const Vec3* positions, size_t vertexCount, const Mesh& mesh,
                                      const Mat4* transform, bool filtered) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), vertexCount));
    if (vertices && transform)
        for (size_t i = 0; i < vertexCount; ++i) vertices[i] = transformPoint(*transform, positions[i]);
    else if (vertices)
        std::memcpy(static_cast<void*>(vertices), positions, vertexCount * sizeof(Vec3));
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

RTCGeometry EmbreeScene::newBody(const Plan& plan) const {
    const LightShape& shape = plan.shape;
    RTCGeometry geometry = nullptr;
    if (shape.type == LightType::Rectangle) {
        geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_QUAD);
        const Vec3 corners[] = {shape.centre - shape.halfX - shape.halfY, shape.centre + shape.halfX - shape.halfY,
                                shape.centre + shape.halfX + shape.halfY, shape.centre - shape.halfX + shape.halfY};
        const uint32_t indices[] = {0, 1, 2, 3};
        void* v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), 4);
        void* q = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, sizeof(indices), 1);
        if (v) std::memcpy(v, corners, sizeof(corners));
        if (q) std::memcpy(q, indices, sizeof(indices));
    } else {
        const bool disk = shape.type == LightType::Disk;
        geometry =
            rtcNewGeometry(device_, disk ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT : RTC_GEOMETRY_TYPE_SPHERE_POINT);
        const Vec4 point(shape.centre, shape.radius);
        void* v = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(Vec4), 1);
        if (v) std::memcpy(v, &point, sizeof(point));
        if (disk) {
            void* n = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), 1);
            if (n) std::memcpy(n, &shape.normal, sizeof(Vec3));
        }
    }
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

#include "trace/embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <mutex>
#include <unordered_map>

#include "base/error.h"
#include "base/isa.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "math/hash.h"
#include "trace/light_shape.h"

namespace lumi {

/// What decides how an instance is attached; a change of it rebuilds the top level.
struct EmbreeScene::Plan {
    Mode mode = Mode::None;
    bool filtered = false;
    const Mesh* mesh = nullptr;
    Mat4 worldFromObject{1};  ///< Direct and Instanced
    LightShape shape;         ///< bodies, radiance left out

    bool sameAttachment(const Plan& other) const {
        if (mode != other.mode || filtered != other.filtered || mesh != other.mesh) return false;
        if (mode == Mode::Direct) return worldFromObject == other.worldFromObject;
        return mode != Mode::Body || shape == other.shape;
    }
};

struct EmbreeScene::Attachment {
    RTCGeometry geometry = nullptr;
    RTCScene own = nullptr;  ///< of a deforming mesh or a moving body
    const Vec3* world = nullptr;
    std::shared_ptr<const DeformedVertices> deformed;  ///< that `own` was built from
};

struct EmbreeScene::MeshScene {
    const Mesh* mesh = nullptr;
    bool filtered = false;
    RTCScene scene = nullptr;
};

/// Embree's memory and its first error.
struct EmbreeScene::Monitor {
    std::atomic<int64_t> bytes{0};
    std::atomic<int64_t> allowed{INT64_MAX};
    std::atomic<bool> refused{false};
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string text;

    static bool memory(void* user, ssize_t change, bool /*after*/) {
        auto& monitor = *static_cast<Monitor*>(user);
        const int64_t now = monitor.bytes += change;
        if (change <= 0 || now <= monitor.allowed) return true;
        monitor.refused = true;
        return false;
    }
    static void error(void* user, RTCError code, const char* text) {
        auto& monitor = *static_cast<Monitor*>(user);
        std::lock_guard lock(monitor.mutex);
        if (monitor.code != RTC_ERROR_NONE) return;
        monitor.code = code;
        monitor.text = text ? text : "";
    }
};

namespace {

const char* deviceConfig() {
    switch (activeIsa()) {
        case Isa::V4: return "isa=avx512";
        case Isa::V3: return "isa=avx2";
        default: return "isa=sse2";
    }
}

/// For each node: does an animation move it or one of its parents?
std::vector<bool> animatedNodes(const Scene& scene) {
    std::vector<bool> animated(scene.nodes.size(), false);
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels)
            if (channel.property != AnimatedProperty::MorphWeights && channel.node >= 0)
                animated[static_cast<size_t>(channel.node)] = true;
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].parent >= 0 && animated[static_cast<size_t>(scene.nodes[i].parent)]) animated[i] = true;
    return animated;
}

bool hasAlpha(const Scene& scene, const Instance& instance) {
    const auto masked = [&](uint32_t material) {
        return material < scene.materials.size() && scene.materials[material].hasAlpha();
    };
    if (instance.material >= 0) return masked(static_cast<uint32_t>(instance.material));
    const Mesh& mesh = *instance.mesh;
    if (mesh.triangleMaterial.empty()) return masked(mesh.material);
    return std::any_of(mesh.triangleMaterial.begin(), mesh.triangleMaterial.end(), masked);
}

/// Coverage of a surface point: the material's alpha, its texture's and the vertices'.
float alphaAt(const Material& material, const Mesh& mesh, uint32_t primitive, float u, float v) {
    const UVec3 t = mesh.triangles[primitive];
    float alpha = material.alpha;
    if (!mesh.colours.empty())
        alpha *= mesh.colours[t.x].w * (1 - u - v) + mesh.colours[t.y].w * u + mesh.colours[t.z].w * v;
    if (const Texture& texture = material.baseColorTexture) {
        const auto& uv = mesh.uv[texture.uvSet == 1 ? 1 : 0];
        if (!uv.empty()) alpha *= texture.sampleAlpha(uv[t.x] * (1 - u - v) + uv[t.y] * u + uv[t.z] * v);
    }
    return alpha;
}

}  // namespace

EmbreeScene::EmbreeScene() : monitor_(std::make_unique<Monitor>()) {
    device_ = rtcNewDevice(deviceConfig());
    if (!device_)
        throw Error(ErrorKind::Resources, {"Embree does not start", "", "", std::string("isa ") + isaName(activeIsa())});
    rtcSetDeviceErrorFunction(device_, &Monitor::error, monitor_.get());
    rtcSetDeviceMemoryMonitorFunction(device_, &Monitor::memory, monitor_.get());
    if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) packetWidth_ = 16;
    else if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) packetWidth_ = 8;
    else if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED)) packetWidth_ = 4;
}

EmbreeScene::~EmbreeScene() {
    clear();
    rtcReleaseDevice(device_);
}

void EmbreeScene::clear() {
    for (Attachment& a : attachments_) {
        if (a.geometry) rtcReleaseGeometry(a.geometry);
        if (a.own) rtcReleaseScene(a.own);
    }
    for (MeshScene& m : meshScenes_)
        if (m.scene) rtcReleaseScene(m.scene);
    attachments_.clear();
    meshScenes_.clear();
    plans_.clear();
    if (top_) rtcReleaseScene(top_);
    top_ = nullptr;
}

const Vec3* EmbreeScene::worldPositions(uint32_t instance) const { return attachments_[instance].world; }

size_t EmbreeScene::byteCount() const { return static_cast<size_t>(std::max<int64_t>(0, monitor_->bytes)); }

void EmbreeScene::throwIfFailed(const char* step) const {
    std::lock_guard lock(monitor_->mutex);
    if (monitor_->code == RTC_ERROR_NONE && !monitor_->refused) return;
    const bool refused = monitor_->refused || monitor_->code == RTC_ERROR_OUT_OF_MEMORY;
    const std::string text = monitor_->text;
    monitor_->code = RTC_ERROR_NONE;
    monitor_->refused = false;
    if (refused)
        throw Error(ErrorKind::Resources,
                    {fmt::format("{} does not fit the memory limit of {}", step, formatBytes(memoryLimit())), "", "", ""});
    throw Error(ErrorKind::Resources, {fmt::format("{} failed in Embree: {}", step, text), "", "", ""});
}

void EmbreeScene::bind(const PosedScene& posed) {
    // Embree may take what the process has left; its own share of that is counted by the monitor.
    const auto resident = static_cast<int64_t>(std::min(residentBytes(), memoryLimit()));
    monitor_->allowed = static_cast<int64_t>(memoryLimit()) - resident + monitor_->bytes;
    posed_ = &posed;
    try {
        std::vector<Plan> plans = makePlans(posed);
        if (!top_ || !update(posed, plans)) rebuild(posed, std::move(plans));
    } catch (...) {
        clear();
        top_ = newScene();
        rtcCommitScene(top_);
        throw;
    }
}

std::vector<EmbreeScene::Plan> EmbreeScene::makePlans(const PosedScene& posed) const {
    const Scene& scene = *posed.scene;
    const std::vector<bool> animated = animatedNodes(scene);
    std::unordered_map<const Mesh*, int> uses;
    for (const Instance& instance : scene.instances) ++uses[instance.mesh.get()];

    std::vector<Plan> plans(scene.instances.size());
    for (size_t i = 0; i < plans.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const PosedInstance& pose = posed.instances[i];
        Plan& plan = plans[i];
        // What moved once may move again: it stays an instance.
        const bool moved = i < plans_.size() && plans_[i].mesh == instance.mesh.get() &&
                           (plans_[i].mode == Mode::Instanced || plans_[i].mode == Mode::MovingBody);
        const bool moves = pose.moves || moved ||
                           (instance.node >= 0 && animated[static_cast<size_t>(instance.node)]);
        plan.mesh = instance.mesh.get();
        plan.worldFromObject = pose.worldFromObject;
        if (instance.light >= 0 && hasBody(scene.lights[static_cast<size_t>(instance.light)].type)) {
            const auto light = static_cast<size_t>(instance.light);
            plan.mode = moves ? Mode::MovingBody : Mode::Body;
            plan.shape = lightShape(scene.lights[light], posed.lights[light].worldFromLight);
            plan.shape.radiance = Vec3(0);
        } else if (!plan.mesh || plan.mesh->triangles.empty()) {
            plan.mode = Mode::None;
        } else {
            plan.filtered = hasAlpha(scene, instance);
            plan.mode = pose.deformed                     ? Mode::Deforming
                        : moves || uses[plan.mesh] > 1 ? Mode::Instanced
                                                          : Mode::Direct;
        }
    }
    return plans;
}

RTCScene EmbreeScene::newScene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
}

RTCGeometry EmbreeScene::newTriangles(const Vec3* positions, size_t vertexCount, const Mesh& mesh,
                                      const Mat4* transform, bool filtered) const {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                sizeof(Vec3), vertexCount));
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
        geometry = rtcNewGeometry(device_, disk ? RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT : RTC_GEOMETRY_TYPE_SPHERE_POINT);
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

namespace {

void attachSingle(RTCScene scene, RTCGeometry geometry) {
    rtcAttachGeometryByID(scene, geometry, 0);
    rtcReleaseGeometry(geometry);
}

void setTransform(RTCGeometry instance, const Mat4& matrix) {
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix[0][0]);
    rtcCommitGeometry(instance);
}

}  // namespace

void EmbreeScene::makeAttachment(const PosedScene& posed, uint32_t index) {
    const Plan& plan = plans_[index];
    Attachment& a = attachments_[index];
    if (plan.mode == Mode::None) return;
    if (plan.mode == Mode::Body) {
        a.geometry = newBody(plan);
        return;
    }
    if (plan.mode == Mode::Direct) {
        a.geometry = newTriangles(plan.mesh->positions.data(), plan.mesh->positions.size(), *plan.mesh,
                                  &plan.worldFromObject, plan.filtered);
        a.world = static_cast<const Vec3*>(rtcGetGeometryBufferData(a.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
        return;
    }
    RTCScene target = nullptr;
    if (plan.mode == Mode::Instanced) {
        for (const MeshScene& m : meshScenes_)
            if (m.mesh == plan.mesh) target = m.scene;
    } else {
        target = a.own = newScene();
        if (plan.mode == Mode::MovingBody) {
            attachSingle(a.own, newBody(plan));
        } else {
            a.deformed = posed.instances[index].deformed;
            attachSingle(a.own, newTriangles(a.deformed->positions.data(), a.deformed->positions.size(), *plan.mesh,
                                             nullptr, plan.filtered));
        }
    }
    a.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(a.geometry, target);
    rtcSetGeometryTimeStepCount(a.geometry, 1);
    setTransform(a.geometry, plan.mode == Mode::MovingBody ? Mat4(1) : plan.worldFromObject);
}

void EmbreeScene::rebuild(const PosedScene& posed, std::vector<Plan> plans) {
    clear();
    plans_ = std::move(plans);
    attachments_.resize(plans_.size());
    top_ = newScene();

    // One scene for each mesh that several instances share or that moves.
    std::unordered_map<const Mesh*, size_t> sceneOf;
    for (const Plan& plan : plans_) {
        if (plan.mode != Mode::Instanced) continue;
        const auto [entry, isNew] = sceneOf.try_emplace(plan.mesh, meshScenes_.size());
        if (isNew) meshScenes_.push_back({plan.mesh, false, nullptr});
        meshScenes_[entry->second].filtered |= plan.filtered;
    }
    parallelFor(static_cast<int64_t>(meshScenes_.size()), [&](int64_t i) {
        MeshScene& m = meshScenes_[static_cast<size_t>(i)];
        m.scene = newScene();
        attachSingle(m.scene, newTriangles(m.mesh->positions.data(), m.mesh->positions.size(), *m.mesh, nullptr,
                                           m.filtered));
    });
    parallelFor(static_cast<int64_t>(plans_.size()), [&](int64_t i) { makeAttachment(posed, static_cast<uint32_t>(i)); });
    // Each build is parallel inside; builds inside our own loops wait for each other without end.
    for (const MeshScene& m : meshScenes_) rtcCommitScene(m.scene);
    for (uint32_t i = 0; i < attachments_.size(); ++i) {
        if (attachments_[i].own) rtcCommitScene(attachments_[i].own);
        if (!attachments_[i].geometry) continue;
        rtcCommitGeometry(attachments_[i].geometry);
        rtcAttachGeometryByID(top_, attachments_[i].geometry, i);
    }
    rtcCommitScene(top_);
    throwIfFailed("building the scene for ray tracing");
}

bool EmbreeScene::update(const PosedScene& posed, std::vector<Plan> plans) {
    if (plans.size() != plans_.size()) return false;
    for (size_t i = 0; i < plans.size(); ++i)
        if (!plans[i].sameAttachment(plans_[i])) return false;

    std::vector<uint8_t> changed(plans.size(), 0), rebuilt(plans.size(), 0);
    parallelFor(static_cast<int64_t>(plans.size()), [&](int64_t index) {
        const auto i = static_cast<size_t>(index);
        const Plan& plan = plans[i];
        Attachment& a = attachments_[i];
        const bool reshaped = plan.mode == Mode::MovingBody && !(plan.shape == plans_[i].shape);
        const bool deformed = plan.mode == Mode::Deforming && posed.instances[i].deformed != a.deformed;
        const bool carried = (plan.mode == Mode::Instanced || plan.mode == Mode::Deforming) &&
                             plan.worldFromObject != plans_[i].worldFromObject;
        if (!reshaped && !deformed && !carried) return;
        changed[i] = 1;
        if (reshaped || deformed) {
            rebuilt[i] = 1;
            rtcDetachGeometry(a.own, 0);
            if (deformed) a.deformed = posed.instances[i].deformed;
            attachSingle(a.own, reshaped ? newBody(plan)
                                         : newTriangles(a.deformed->positions.data(), a.deformed->positions.size(),
                                                        *plan.mesh, nullptr, plan.filtered));
        }
        if (carried) setTransform(a.geometry, plan.worldFromObject);
    });
    plans_ = std::move(plans);
    bool any = false;
    for (size_t i = 0; i < changed.size(); ++i) {
        if (rebuilt[i]) rtcCommitScene(attachments_[i].own);
        if (rebuilt[i]) rtcCommitGeometry(attachments_[i].geometry);
        any |= changed[i] != 0;
    }
    if (any) rtcCommitScene(top_);
    throwIfFailed("updating the scene for ray tracing");
    return true;
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
        const float alpha = alphaAt(material, posed.mesh(instance), primitive, RTCHitN_u(arguments->hit, n, i),
                                    RTCHitN_v(arguments->hit, n, i));
        const float least = material.alphaMode == AlphaMode::Mask
                                ? material.alphaCutoff
                                : unitFloat(hashCombine(RTCRayN_id(arguments->ray, n, i), instance, primitive));
        // A blended hit stands with probability alpha; a masked one at alpha >= cutoff.
        const bool stands = material.alphaMode == AlphaMode::Mask ? alpha >= least : alpha > least;
        if (!stands) arguments->valid[i] = 0;
    }
}

}  // namespace lumi

#include "trace/embree_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "base/error.h"
#include "base/isa.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "trace/embree_parts.h"

namespace lumi {

namespace {

const char* deviceConfig() {
    switch (activeIsa()) {
        case Isa::V4:
            return "isa=avx512";
        case Isa::V3:
            return "isa=avx2";
        default:
            return "isa=sse2";
    }
}

/// Triangles up to which bounce and shadow rays go in packets: box scenes of a few dozen gain a third to two thirds by them,
/// those of 100,000 and more lose up to a fifth.
constexpr size_t kSmallScene = 10000;

}  // namespace

EmbreeScene::EmbreeScene() : monitor_(std::make_unique<Monitor>()) {
    device_ = rtcNewDevice(deviceConfig());
    if (!device_)
        throw Error(ErrorKind::Resources,
                    {"Embree does not start", "", "", std::string("isa ") + isaName(activeIsa())});
    rtcSetDeviceErrorFunction(device_, &Monitor::error, monitor_.get());
    rtcSetDeviceMemoryMonitorFunction(device_, &Monitor::memory, monitor_.get());
    if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
        packetWidth_ = 16;
    else if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
        packetWidth_ = 8;
    else if (rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED))
        packetWidth_ = 4;
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

const Vec3* EmbreeScene::worldPositions(uint32_t instance) const {
    return attachments_[instance].world;
}

size_t EmbreeScene::byteCount() const {
    return static_cast<size_t>(std::max<int64_t>(0, monitor_->bytes));
}

void EmbreeScene::throwIfFailed(const char* step) const {
    std::lock_guard lock(monitor_->mutex);
    if (monitor_->code == RTC_ERROR_NONE && !monitor_->refused) return;
    const bool refused = monitor_->refused || monitor_->code == RTC_ERROR_OUT_OF_MEMORY;
    const std::string text = monitor_->text;
    monitor_->code = RTC_ERROR_NONE;
    monitor_->refused = false;
    if (refused)
        throw Error(
            ErrorKind::Resources,
            {fmt::format("{} does not fit the memory limit of {}", step, formatBytes(memoryLimit())), "", "", ""});
    throw Error(ErrorKind::Resources, {fmt::format("{} failed in Embree: {}", step, text), "", "", ""});
}

bool EmbreeScene::bind(const PosedScene& posed) {
    // Embree may take what the process has left; its own share of that is counted by the monitor.
    const auto resident = static_cast<int64_t>(std::min(residentBytes(), memoryLimit()));
    monitor_->allowed = static_cast<int64_t>(memoryLimit()) - resident + monitor_->bytes;
    posed_ = &posed;
    try {
        std::vector<Plan> plans = makePlans(posed);
        const bool updated = top_ && update(posed, plans);
        if (!updated) rebuild(posed, std::move(plans));
        findSides(posed);
        RTCBounds bounds;
        rtcGetSceneBounds(top_, &bounds);
        bounds_.lower = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
        bounds_.upper = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
        return !updated;
    } catch (...) {
        clear();
        bounds_ = {};
        top_ = newScene();
        rtcCommitScene(top_);
        throw;
    }
}

namespace {

void attachSingle(RTCScene scene, RTCGeometry geometry) {
    rtcAttachGeometryByID(scene, geometry, 0);
    rtcReleaseGeometry(geometry);
}

void setTransforms(RTCGeometry instance, std::span<const Mat4> matrices) {
    rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(matrices.size()));
    for (unsigned step = 0; step < matrices.size(); ++step)
        rtcSetGeometryTransform(instance, step, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrices[step][0][0]);
    rtcCommitGeometry(instance);
}

}  // namespace

void EmbreeScene::makeAttachment(const PosedScene& posed, uint32_t index, RTCScene meshScene) {
    const Plan& plan = plans_[index];
    Attachment& a = attachments_[index];
    if (plan.mode == Mode::None) return;
    if (plan.mode == Mode::Body) {
        a.geometry = newBody(plan);
        return;
    }
    if (plan.mode == Mode::Direct) {
        const Vec3* positions = plan.mesh->positions.data();
        a.geometry = newTriangles({&positions, 1}, plan.mesh->positions.size(), *plan.mesh, &plan.worldFromObject,
                                  plan.filtered);
        a.world = static_cast<const Vec3*>(rtcGetGeometryBufferData(a.geometry, RTC_BUFFER_TYPE_VERTEX, 0));
        return;
    }
    RTCScene target = nullptr;
    if (plan.mode == Mode::Instanced) {
        target = meshScene;
    } else {
        target = a.own = newScene();
        if (plan.mode == Mode::MovingBody) {
            attachSingle(a.own, newBody(plan));
        } else {
            a.deformed = posed.instances[index].deformed;
            attachSingle(a.own, newDeforming(plan, *a.deformed));
        }
    }
    a.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(a.geometry, target);
    setTransforms(a.geometry, plan.transforms());
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
        const Vec3* positions = m.mesh->positions.data();
        attachSingle(m.scene, newTriangles({&positions, 1}, m.mesh->positions.size(), *m.mesh, nullptr, m.filtered));
    });
    parallelFor(static_cast<int64_t>(plans_.size()), [&](int64_t i) {
        const Plan& plan = plans_[static_cast<size_t>(i)];
        const bool shared = plan.mode == Mode::Instanced;
        makeAttachment(posed, static_cast<uint32_t>(i), shared ? meshScenes_[sceneOf.at(plan.mesh)].scene : nullptr);
    });
    // Each build is parallel inside; builds inside our own loops wait for each other without end.
    for (const MeshScene& m : meshScenes_) rtcCommitScene(m.scene);
    for (uint32_t i = 0; i < attachments_.size(); ++i) {
        if (attachments_[i].own) rtcCommitScene(attachments_[i].own);
        if (!attachments_[i].geometry) continue;
        rtcCommitGeometry(attachments_[i].geometry);
        rtcAttachGeometryByID(top_, attachments_[i].geometry, i);
    }
    rtcCommitScene(top_);
    size_t triangles = 0;
    for (const Plan& plan : plans_)
        if (plan.mesh) triangles += plan.mesh->triangles.size();
    strayPacketWidth_ = triangles <= kSmallScene ? packetWidth_ : 1;
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
        const bool otherTrack = plan.track != plans_[i].track;
        const bool reshaped = plan.mode == Mode::MovingBody && (!(plan.shape == plans_[i].shape) ||
                                                                plan.shutterShapes != plans_[i].shutterShapes);
        const bool otherPlace = plan.worldFromObject != plans_[i].worldFromObject || plan.inWorld != plans_[i].inWorld;
        const bool deformed = plan.mode == Mode::Deforming && (posed.instances[i].deformed != a.deformed || otherTrack ||
                                                               (otherPlace && (plan.inWorld || plans_[i].inWorld)));
        const bool carried = (plan.mode == Mode::Instanced || plan.mode == Mode::Deforming) && (otherPlace || otherTrack);
        if (!reshaped && !deformed && !carried) return;
        changed[i] = 1;
        if (reshaped || deformed) {
            rebuilt[i] = 1;
            rtcDetachGeometry(a.own, 0);
            if (deformed) a.deformed = posed.instances[i].deformed;
            attachSingle(a.own, reshaped ? newBody(plan) : newDeforming(plan, *a.deformed));
        }
        if (carried) setTransforms(a.geometry, plan.transforms());
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

}  // namespace lumi

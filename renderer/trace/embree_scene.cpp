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
        case Isa::V4: return "isa=avx512";
        case Isa::V3: return "isa=avx2";
        default: return "isa=sse2";
    }
}

/// Triangles up to which bounce and shadow rays go in packets: box scenes of a few dozen gain a third to two thirds by
/// them, those of 100,000 and more lose up to a fifth.
constexpr size_t kSmallScene = 10000;

}  // namespace

EmbreeScene::EmbreeScene() : monitor_(std::make_unique<Monitor>()) {
    device_ = rtcNewDevice(deviceConfig());
    if (!device_)
        throw Error(ErrorKind::Resources,
                    {"Embree does not start", "", "", std::string("isa ") + isaName(activeIsa())});
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
    posed_ = nullptr;
}

const Vec3* EmbreeScene::worldPositions(uint32_t instance) const {
    if (plans_[instance].mode != Mode::Direct) return nullptr;
    return static_cast<const Vec3*>(
        rtcGetGeometryBufferData(attachments_[instance].geometry, RTC_BUFFER_TYPE_VERTEX, 0));
}

bool EmbreeScene::isCarried(uint32_t instance) const {
    return plans_[instance].mode == Mode::Deforming && plans_[instance].inWorld && posed_->instances[instance].track();
}

size_t EmbreeScene::byteCount() const {
    const size_t ofInstances = plans_.capacity() * sizeof(Plan) + attachments_.capacity() * sizeof(Attachment) +
                               sides_.capacity() * sizeof(Sides);
    return static_cast<size_t>(std::max<int64_t>(0, monitor_->bytes)) + ofInstances;
}

void EmbreeScene::throwIfStopped() const {
    if (!monitor_->stop.stop_requested()) return;
    // Embree reports a build that was ended as failed.
    std::lock_guard lock(monitor_->mutex);
    monitor_->code = RTC_ERROR_NONE;
    monitor_->refused = false;
    throw Error(ErrorKind::Interrupted, {"interrupted", "", "", ""});
}

void EmbreeScene::throwIfFailed(const char* step) const {
    throwIfStopped();
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

bool EmbreeScene::bind(const PosedScene& posed, std::stop_token stop, const std::function<void(double)>& progress) {
    // Embree may take what the process has left; its own share of that is counted by the monitor.
    const auto resident = static_cast<int64_t>(std::min(residentBytes(), memoryLimit()));
    monitor_->allowed = static_cast<int64_t>(memoryLimit()) - resident + monitor_->bytes;
    monitor_->stop = std::move(stop);
    monitor_->progress = &progress;
    bool anew = false;
    try {
        std::vector<Plan> plans = makePlans(posed, posed_);
        anew = !posed_ || !sameAttachments(*posed_, plans_, posed, plans);
        if (anew) rebuild(posed, std::move(plans));
        else update(posed, *posed_, std::move(plans));
        posed_ = &posed;
        findSides(posed);
    } catch (...) {
        clear();
        bounds_ = {};
        monitor_->stop = {}, monitor_->progress = nullptr;
        top_ = newScene();
        rtcCommitScene(top_);
        throw;
    }
    monitor_->stop = {}, monitor_->progress = nullptr;
    RTCBounds bounds;
    rtcGetSceneBounds(top_, &bounds);
    bounds_.lower = {bounds.lower_x, bounds.lower_y, bounds.lower_z};
    bounds_.upper = {bounds.upper_x, bounds.upper_y, bounds.upper_z};
    return anew;
}

namespace {

void attachSingle(RTCScene scene, RTCGeometry geometry) {
    rtcAttachGeometryByID(scene, geometry, 0);
    rtcReleaseGeometry(geometry);
}

/// Of an instance that is no body, at the moments of the open shutter, mostly one.
std::span<const Mat4> transformsOf(const PosedInstance& pose, bool inWorld) {
    static const Mat4 identity(1);
    if (inWorld) return {&identity, 1};
    if (pose.track()) return pose.track()->worldFromObject;
    return {&pose.worldFromObject, 1};
}

void setTransforms(RTCGeometry instance, std::span<const Mat4> matrices) {
    rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(matrices.size()));
    for (unsigned step = 0; step < matrices.size(); ++step)
        rtcSetGeometryTransform(instance, step, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrices[step][0][0]);
    rtcCommitGeometry(instance);
}

/// Instances between two looks at the stop.
constexpr size_t kPollStride = 1024;

}  // namespace

void EmbreeScene::makeAttachment(const PosedScene& posed, uint32_t index, RTCScene meshScene) {
    const Plan& plan = plans_[index];
    const PosedInstance& pose = posed.instances[index];
    Attachment& a = attachments_[index];
    if (plan.mode == Mode::None) return;
    if (plan.mode == Mode::Body) {
        a.geometry = newBody(posed, index);
        return;
    }
    if (plan.mode == Mode::Direct) {
        a.geometry = newMesh(posed.mesh(index), plan.filtered, &pose.worldFromObject);
        return;
    }
    RTCScene target = meshScene;
    if (plan.mode != Mode::Instanced) {
        target = a.own = newScene();
        attachSingle(a.own, plan.mode == Mode::MovingBody ? newBody(posed, index) : newDeforming(posed, index, plan));
    }
    a.geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(a.geometry, target);
    setTransforms(a.geometry, transformsOf(pose, plan.inWorld || plan.mode == Mode::MovingBody));
}

void EmbreeScene::rebuild(const PosedScene& posed, std::vector<Plan> plans) {
    clear();
    plans_ = std::move(plans);
    attachments_.resize(plans_.size());
    top_ = newScene();

    // One scene for each mesh that several instances share or that moves.
    std::unordered_map<const Mesh*, size_t> sceneOf;
    for (uint32_t i = 0; i < plans_.size(); ++i) {
        if (plans_[i].mode != Mode::Instanced) continue;
        const auto [entry, isNew] = sceneOf.try_emplace(&posed.mesh(i), meshScenes_.size());
        if (isNew) meshScenes_.push_back({&posed.mesh(i), false, nullptr});
        meshScenes_[entry->second].filtered |= plans_[i].filtered;
    }
    parallelFor(
        static_cast<int64_t>(meshScenes_.size()),
        [&](int64_t i) {
            MeshScene& m = meshScenes_[static_cast<size_t>(i)];
            m.scene = newScene();
            attachSingle(m.scene, newMesh(*m.mesh, m.filtered, nullptr));
        },
        monitor_->stop);
    throwIfStopped();
    parallelFor(
        static_cast<int64_t>(plans_.size()),
        [&](int64_t i) {
            const auto index = static_cast<uint32_t>(i);
            const bool shared = plans_[index].mode == Mode::Instanced;
            makeAttachment(posed, index, shared ? meshScenes_[sceneOf.at(&posed.mesh(index))].scene : nullptr);
        },
        monitor_->stop);
    throwIfStopped();
    attachAll(posed);
}

void EmbreeScene::attachAll(const PosedScene& posed) {
    // Each build is parallel inside; builds inside our own loops wait for each other without end.
    for (const MeshScene& m : meshScenes_) {
        throwIfStopped();
        rtcCommitScene(m.scene);
    }
    for (uint32_t i = 0; i < attachments_.size(); ++i) {
        if (attachments_[i].own || i % kPollStride == 0) throwIfStopped();
        if (attachments_[i].own) rtcCommitScene(attachments_[i].own);
        if (!attachments_[i].geometry) continue;
        rtcCommitGeometry(attachments_[i].geometry);
        rtcAttachGeometryByID(top_, attachments_[i].geometry, i);
    }
    throwIfStopped();
    rtcCommitScene(top_);
    size_t triangles = 0;
    for (const Instance& instance : posed.scene->instances)
        if (instance.mesh) triangles += instance.mesh->triangles.size();
    strayPacketWidth_ = triangles <= kSmallScene ? packetWidth_ : 1;
    throwIfFailed("building the scene for ray tracing");
}

void EmbreeScene::update(const PosedScene& posed, const PosedScene& before, std::vector<Plan> plans) {
    std::vector<uint8_t> changed(plans.size(), 0), rebuilt(plans.size(), 0);
    parallelFor(
        static_cast<int64_t>(plans.size()),
        [&](int64_t number) {
            const auto i = static_cast<uint32_t>(number);
            const Plan& plan = plans[i];
            const PosedInstance &pose = posed.instances[i], &earlier = before.instances[i];
            Attachment& a = attachments_[i];
            const bool inWorld = plan.inWorld || plans_[i].inWorld;
            const bool otherTrack = pose.track() != earlier.track();
            const bool reshaped = plan.mode == Mode::MovingBody && !(Body(posed, i) == Body(before, i));
            const bool otherPlace =
                pose.worldFromObject != earlier.worldFromObject || plan.inWorld != plans_[i].inWorld;
            const bool deformed = plan.mode == Mode::Deforming &&
                                  (pose.deformed != earlier.deformed || otherTrack || (otherPlace && inWorld));
            const bool carried =
                (plan.mode == Mode::Instanced || plan.mode == Mode::Deforming) && (otherPlace || otherTrack);
            if (!reshaped && !deformed && !carried) return;
            changed[i] = 1;
            if (reshaped || deformed) {
                rebuilt[i] = 1;
                rtcDetachGeometry(a.own, 0);
                attachSingle(a.own, reshaped ? newBody(posed, i) : newDeforming(posed, i, plan));
            }
            if (carried) setTransforms(a.geometry, transformsOf(pose, plan.inWorld));
        },
        monitor_->stop);
    throwIfStopped();
    plans_ = std::move(plans);
    bool any = false;
    for (size_t i = 0; i < changed.size(); ++i) {
        if (rebuilt[i]) throwIfStopped();
        if (rebuilt[i]) rtcCommitScene(attachments_[i].own);
        if (rebuilt[i]) rtcCommitGeometry(attachments_[i].geometry);
        any |= changed[i] != 0;
    }
    if (any) rtcCommitScene(top_);
    throwIfFailed("updating the scene for ray tracing");
}

}  // namespace lumi

#pragma once
#include <atomic>
#include <mutex>
#include <string>

#include "trace/embree_scene.h"
#include "trace/light_shape.h"

// What EmbreeScene is made of; for its own files only.
namespace lumi {

/// What decides how an instance is attached; a change of it rebuilds the top level.
struct EmbreeScene::Plan {
    Mode mode = Mode::None;
    bool filtered = false;
    bool inWorld = false;     ///< its triangles are Embree's in world space
    const Mesh* mesh = nullptr;
    Mat4 worldFromObject{1};  ///< of meshes
    LightShape shape;         ///< bodies, radiance left out
    std::shared_ptr<const ShutterTrack> track;  ///< meshes that move while the shutter is open
    std::vector<LightShape> shutterShapes;      ///< bodies that do, at equally spaced moments

    /// Of the instance at the moments of the open shutter, mostly one.
    std::span<const Mat4> transforms() const {
        static const Mat4 identity(1);
        if (mode == Mode::MovingBody || inWorld) return {&identity, 1};
        if (track) return track->worldFromObject;
        return {&worldFromObject, 1};
    }

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

}  // namespace lumi

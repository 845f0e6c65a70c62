#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <stop_token>
#include <string>

#include "trace/embree_scene.h"
#include "trace/light_shape.h"

// What EmbreeScene is made of; for its own files only.
namespace lumi {

/// How an instance is attached; the posed scene says the rest. There may be millions.
struct EmbreeScene::Plan {
    Mode mode = Mode::None;
    bool filtered = false;
    bool inWorld = false;  ///< its triangles are Embree's in world space
};

struct EmbreeScene::Attachment {
    RTCGeometry geometry = nullptr;
    RTCScene own = nullptr;  ///< of a deforming mesh or a moving body
};

/// Where a light's body is, without what it emits: at shutter open, and at moments of the open shutter if it moves.
struct EmbreeScene::Body {
    LightShape shape;
    std::vector<LightShape> shutterShapes;
    Body(const PosedScene& posed, uint32_t instance);
    bool operator==(const Body&) const = default;
};

struct EmbreeScene::MeshScene {
    const Mesh* mesh = nullptr;
    bool filtered = false;
    RTCScene scene = nullptr;
};

/// Embree's memory, its first error, and whether it is to go on.
struct EmbreeScene::Monitor {
    std::atomic<int64_t> bytes{0};
    std::atomic<int64_t> allowed{INT64_MAX};
    std::atomic<bool> refused{false};
    std::mutex mutex;
    RTCError code = RTC_ERROR_NONE;
    std::string text;

    std::stop_token stop;  ///< both of the call of bind() that is under way
    const std::function<void(double)>* progress = nullptr;

    /// Called by many threads while a scene is built; false ends that.
    static bool goesOn(void* user, double fraction) {
        const auto& monitor = *static_cast<const Monitor*>(user);
        if (monitor.progress && *monitor.progress) (*monitor.progress)(fraction);
        return !monitor.stop.stop_requested();
    }
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

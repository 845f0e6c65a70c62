#include "scene/camera_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"

namespace lumi {
using Json = nlohmann::ordered_json;
namespace {

constexpr const char* kFormat = "lumiscope-camera-path";
constexpr size_t kMostKeys = 1'000'000;

[[noreturn]] void throwBroken(const std::string& what, const std::string& where, const std::string& expected = "") {
    throwBadInput({what, where, expected, ""});
}

float numberOf(const Json& object, const char* key, float otherwise, const std::string& where) {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    const double value = found->is_number() ? found->get<double>() : std::nan("");
    if (!std::isfinite(value) || std::abs(value) > 1e9) throwBroken(fmt::format("\"{}\" is no number", key), where);
    return static_cast<float>(value);
}

template <size_t kCount>
std::array<float, kCount> numbersOf(const Json& object, const char* key, const std::string& where) {
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array() || found->size() != kCount)
        throwBroken(fmt::format("\"{}\" is missing or not {} numbers", key, kCount), where);
    std::array<float, kCount> values{};
    for (size_t i = 0; i < kCount; ++i) {
        const double value = (*found)[i].is_number() ? (*found)[i].get<double>() : std::nan("");
        if (!std::isfinite(value) || std::abs(value) > 1e9) throwBroken(fmt::format("\"{}\" is no number", key), where);
        values[i] = static_cast<float>(value);
    }
    return values;
}

Vec3 pointOf(const Json& object, const char* key, const std::string& where) {
    const auto v = numbersOf<3>(object, key, where);
    return {v[0], v[1], v[2]};
}

void checkKnown(const Json& object, std::initializer_list<std::string> known, const std::string& where) {
    for (const auto& [key, value] : object.items())
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            const std::string near = nearestName(key, known);
            throwBroken(fmt::format("unknown key \"{}\"", key), where, near.empty() ? "" : '"' + near + '"');
        }
}

void checkKeys(const CameraPath& path, const std::string& where) {
    if (path.keys.empty() || path.keys.size() > kMostKeys) throwBroken("the path has no keys, or too many", where);
    for (size_t i = 0; i < path.keys.size(); ++i) {
        const SceneCamera::Key& key = path.keys[i];
        const std::string at = fmt::format("{}: key {}", where, i);
        if (key.time < 0 || (i > 0 && key.time <= path.keys[i - 1].time))
            throwBroken("times do not ascend from 0 on", at);
        if (key.fovYDeg < 1 || key.fovYDeg > 170)
            throwBroken("the field of view is out of range", at, "1 to 170 degrees");
        if (!(key.focus > 0)) throwBroken("the distance in focus is not above 0", at);
        if (key.eye == key.target) throwBroken("the eye is where it looks at", at);
    }
}

CameraPath readOwn(const Json& file, const std::string& where) {
    checkKnown(file, {"format", "version", "interpolation", "aperture", "keys"}, where);
    if (file.value("version", Json()) != 1) throwBroken("the camera path has another version", where, "1");
    CameraPath path;
    const std::string kind = file.value("interpolation", Json("catmull-rom")) == "linear" ? "linear" : "catmull-rom";
    if (file.contains("interpolation") && file["interpolation"] != kind)
        throwBroken("\"interpolation\" is unknown", where, "\"catmull-rom\" or \"linear\"");
    path.interpolation = kind == "linear" ? Interpolation::Linear : Interpolation::CatmullRom;
    path.aperture = numberOf(file, "aperture", 0, where);
    for (const Json& entry : file.value("keys", Json::array())) {
        const std::string at = fmt::format("{}: key {}", where, path.keys.size());
        if (!entry.is_object()) throwBroken("is no object", at);
        checkKnown(entry, {"time", "eye", "look-at", "fov-y-deg", "focus"}, at);
        SceneCamera::Key key;
        key.time = numberOf(entry, "time", -1, at);
        key.eye = pointOf(entry, "eye", at);
        key.target = pointOf(entry, "look-at", at);
        key.fovYDeg = numberOf(entry, "fov-y-deg", 45, at);
        key.focus = numberOf(entry, "focus", glm::length(key.target - key.eye), at);
        path.keys.push_back(key);
    }
    return path;
}

CameraPath readInstantNgp(const Json& file, const std::string& where) {
    CameraPath path;
    if (numberOf(file, "spline_order", 3, where) == 1) path.interpolation = Interpolation::Linear;
    for (const Json& entry : file["path"]) {
        const std::string at = fmt::format("{}: path {}", where, path.keys.size());
        if (!entry.is_object()) throwBroken("is no object", at);
        const auto r = numbersOf<4>(entry, "R", at);
        const glm::quat rotation(r[3], r[0], r[1], r[2]);
        if (!(glm::length(rotation) > 1e-6f)) throwBroken("\"R\" is no rotation", at);
        const Vec3 forward = glm::mat3_cast(glm::normalize(rotation))[2];
        const float scale = numberOf(entry, "scale", 1, at), distance = scale > 1e-4f ? scale : 1.0f;
        SceneCamera::Key key;
        key.time = numberOf(entry, "timestamp", 0, at);
        key.eye = pointOf(entry, "T", at);
        key.target = key.eye + forward * distance;
        key.fovYDeg = numberOf(entry, "fov", 45, at);
        key.focus = std::max(distance + numberOf(entry, "slice", 0, at), 1e-3f);
        path.aperture = std::max(path.aperture, numberOf(entry, "aperture_size", 0, at));
        path.keys.push_back(key);
    }
    const size_t count = path.keys.size();
    const bool timed = std::any_of(path.keys.begin(), path.keys.end(), [](const auto& key) { return key.time != 0; });
    if (timed || count < 2) return path;
    const float duration = numberOf(file, "duration_seconds", 0, where);
    for (size_t i = 0; i < count; ++i)
        path.keys[i].time = static_cast<float>(i) * (duration > 0 ? duration / static_cast<float>(count - 1) : 1.0f);
    return path;
}

Json jsonOf(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Json instantNgpKey(const SceneCamera::Key& key, float aperture) {
    const Vec3 forward = glm::normalize(key.target - key.eye);
    const Vec3 up = std::abs(forward.y) < 0.9999f ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 right = glm::normalize(glm::cross(forward, up)), down = glm::cross(forward, right);
    const glm::quat r = glm::normalize(glm::quat_cast(Mat3(right, down, forward)));
    const float distance = glm::length(key.target - key.eye);
    return {{"R", {r.x, r.y, r.z, r.w}}, {"T", jsonOf(key.eye)}, {"slice", key.focus - distance},
            {"scale", distance},         {"fov", key.fovYDeg},   {"aperture_size", aperture},
            {"timestamp", key.time},     {"glow_mode", 0},       {"glow_y_cutoff", 0.0}};
}

}  // namespace

SceneCamera::Key CameraPath::at(float time) const {
    Scene scene;
    scene.cameras.emplace_back();
    scene.cameras[0].keys = keys;
    scene.cameras[0].interpolation = interpolation;
    const Camera camera = cameraAt(scene, 0, time);
    return {time, camera.eye, camera.target, camera.fovYDeg, camera.focus};
}

CameraPath readCameraPath(const std::filesystem::path& path) {
    const std::string where = path.string();
    const Json file = Json::parse(readTextFile(path, uint64_t(256) << 20), nullptr, false);
    const bool own = file.is_object() && file.value("format", Json()) == kFormat;
    const bool ngp = file.is_object() && file.contains("path") && file["path"].is_array();
    if (!own && !ngp)
        throwBroken("is no camera path", where, fmt::format("\"format\": \"{}\", or instant-ngp's \"path\"", kFormat));
    if (own && !file.value("keys", Json::array()).is_array()) throwBroken("\"keys\" is no list", where);
    CameraPath result = own ? readOwn(file, where) : readInstantNgp(file, where);
    checkKeys(result, where);
    return result;
}

std::string formatCameraPath(const CameraPath& path, CameraPathFormat format) {
    Json keys = Json::array();
    if (format == CameraPathFormat::InstantNgp) {
        for (const SceneCamera::Key& key : path.keys) keys.push_back(instantNgpKey(key, path.aperture));
        const Json file = {{"loop", false},
                           {"time", 0.0},
                           {"path", keys},
                           {"duration_seconds", path.duration()},
                           {"spline_order", path.interpolation == Interpolation::Linear ? 1 : 3}};
        return file.dump(1) + "\n";
    }
    for (const SceneCamera::Key& key : path.keys)
        keys.push_back({{"time", key.time},
                        {"eye", jsonOf(key.eye)},
                        {"look-at", jsonOf(key.target)},
                        {"fov-y-deg", key.fovYDeg},
                        {"focus", key.focus}});
    const Json file = {{"format", kFormat},
                       {"version", 1},
                       {"interpolation", path.interpolation == Interpolation::Linear ? "linear" : "catmull-rom"},
                       {"aperture", path.aperture},
                       {"keys", keys}};
    return file.dump(1) + "\n";
}

CameraPathFormat cameraPathFormatOf(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return stem.size() > 4 && stem.compare(stem.size() - 4, 4, ".ngp") == 0 ? CameraPathFormat::InstantNgp
                                                                            : CameraPathFormat::Lumiscope;
}

CameraPath cameraPathOf(const Scene& scene, int camera, float fps) {
    const SceneCamera& source = scene.cameras.at(static_cast<size_t>(camera));
    CameraPath path;
    path.aperture = source.camera.aperture;
    if (source.node < 0 && source.keys.size() > 1) {
        path.keys = source.keys;
        path.interpolation =
            source.interpolation == Interpolation::Linear ? Interpolation::Linear : Interpolation::CatmullRom;
        return path;
    }
    const double length = source.node >= 0 ? std::floor(static_cast<double>(scene.duration()) * fps) : 0;
    if (!(length < static_cast<double>(kMostKeys)))
        throw Error(ErrorKind::BadInput, {"the animation is too long to be written as a camera path", scene.path,
                                          fmt::format("fewer than {} frames (render.fps may be lower)", kMostKeys),
                                          fmt::format("{:.0f}", length)});
    const auto frames = static_cast<int>(length);
    path.interpolation = Interpolation::Linear;
    for (int frame = 0; frame <= frames; ++frame) {
        const float time = static_cast<float>(frame) / fps;
        const Camera now = cameraAt(scene, camera, time);
        path.keys.push_back({time, now.eye, now.target, now.fovYDeg, now.focus});
    }
    return path;
}

}  // namespace lumi

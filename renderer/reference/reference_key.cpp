#include "reference/reference_key.h"

#include <fmt/format.h>
#include <gnu/libc-version.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/isa.h"
#include "params/json.h"
#include "reference/source_digest.h"

namespace lumi {
using nlohmann::json;
namespace {

json numbersOf(const Mat4& m) {
    json values = json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) values.push_back(m[column][row]);
    return values;
}

json cameraOf(const CameraPose& camera) {
    return {{"world-from-camera", numbersOf(camera.worldFromCamera)},
            {"camera-from-world", numbersOf(camera.cameraFromWorld)},
            {"width", camera.extent.width},
            {"height", camera.extent.height},
            {"projection", static_cast<int>(camera.projection)},
            {"half-height", camera.halfHeight},
            {"aperture", camera.aperture},
            {"focus", camera.focus},
            {"blades", camera.blades},
            {"blade-rotation", camera.bladeRotation}};
}

json trackOf(const CameraTrack& track) {
    json poses = json::array();
    for (const CameraPose& camera : track) poses.push_back(cameraOf(camera));
    return poses;
}

json pathOf(PathSettings path) {
    json values = json::object();
    for (const ParameterInfo& info : listParameters([&](ParameterVisitor& v) { path.describe(v); }))
        values[info.id] = toJson(info.value);
    return values;
}

json flattened(const std::string& text) {
    const json value = json::parse(text, nullptr, false);
    return value.is_discarded() ? json::object() : value.flatten();
}

}  // namespace

std::string referenceKeyText(const ReferenceSpec& spec) {
    const json scene = json::parse(spec.sceneKey, nullptr, false);
    return json{{"scene", scene.is_discarded() ? json(spec.sceneKey) : scene},
                {"time", spec.time},
                {"open-seconds", spec.openSeconds},
                {"camera", cameraOf(spec.camera)},
                {"camera-track", trackOf(spec.cameraTrack)},
                {"path", pathOf(spec.path)},
                {"seed", spec.seed},
                {"jitter", static_cast<int>(spec.jitter)},
                {"isa", isaName(activeIsa())},
                {"sources", kSourceDigest},
                {"toolchain", kToolchain},
                {"libc", gnu_get_libc_version()}}  // its sines and cosines
        .dump();
}

std::string keyDifference(const std::string& a, const std::string& b) {
    const json first = flattened(a), second = flattened(b);
    for (const auto& [path, value] : first.items()) {
        const auto other = second.find(path);
        if (other != second.end() && *other == value) continue;
        std::string name = path.substr(1);
        std::replace(name.begin(), name.end(), '/', '.');
        return fmt::format("{}: {} and {}", name, value.dump(), other == second.end() ? "nothing" : other->dump());
    }
    return a == b ? "" : "more is set in one of them";
}

std::string referenceKey(const ReferenceSpec& spec) {
    const std::string text = referenceKeyText(spec);
    return digest({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace lumi

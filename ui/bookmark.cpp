#include "ui/bookmark.h"

namespace lumi {
namespace {

bool isPose(const std::string& id) { return id == "camera.eye" || id == "camera.look-at"; }
bool isKept(const std::string& id) { return id != "camera.select" && id != "camera.jitter"; }

/// As a shell reads it back.
std::string quoted(const std::string& text) {
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.,_+-";
    return text.find_first_not_of(kPlain) == std::string::npos ? text : '\'' + text + '\'';
}

}  // namespace

CameraBookmark bookmarkOf(const DocumentMirror& document) {
    CameraBookmark bookmark;
    for (const ParameterInfo* info : document.group("camera."))
        if (info->active && isKept(info->id)) bookmark[info->id] = formatParameter(info->value);
    return bookmark;
}

std::vector<std::pair<std::string, ParameterValue>> valuesOf(const CameraBookmark& bookmark,
                                                             const DocumentMirror& document) {
    std::vector<std::pair<std::string, ParameterValue>> values;
    for (const ParameterInfo* info : document.group("camera.")) {
        const auto stored = bookmark.find(info->id);
        if (stored == bookmark.end()) continue;
        ParameterValue value = parseParameter(*info, stored->second, "a bookmark");
        // The pose also where it is the present one: that stops a camera that moves.
        if (isPose(info->id) || value != info->value) values.emplace_back(info->id, std::move(value));
    }
    return values;
}

std::string cameraAsCommandLine(const DocumentMirror& document) {
    std::string text;
    for (const ParameterInfo* info : document.group("camera.")) {
        const bool told = isPose(info->id) || (document.changed(info->id) && info->id != "camera.jitter");
        if (!told || !info->active) continue;
        text += (text.empty() ? "--set " : " --set ") + info->id + '=' + quoted(formatParameter(info->value));
    }
    return text;
}

}  // namespace lumi

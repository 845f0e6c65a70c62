#include "session/reference_spec.h"

#include <nlohmann/json.hpp>

namespace lumi {
namespace {

/// Edits of the scene itself; camera, time, path and size stand in the spec as what they come to.
bool editsScene(const std::string& id) {
    for (const char* head : {"material.", "light.", "environment.", "scene."})
        if (id.compare(0, std::char_traits<char>::length(head), head) == 0) return true;
    return false;
}

/// All but the scene's key.
ReferenceSpec specWithoutKey(const Document& document) {
    ReferenceSpec spec;
    spec.scene = document.scene();
    spec.time = document.time();
    spec.openSeconds = document.camera().shutter / document.render().fps;
    spec.cameraTrack = document.cameraTrack();
    spec.camera = poseCamera(document.camera(), {document.render().width, document.render().height});
    spec.path = document.path();
    spec.seed = static_cast<uint32_t>(document.render().seed);
    spec.jitter = document.jitter() == Jitter::Auto ? Jitter::PerPixel : document.jitter();
    return spec;
}

}  // namespace

ReferenceSpec referenceSpec(const Document& document) {
    ReferenceSpec spec = specWithoutKey(document);
    nlohmann::json edits = nlohmann::json::object();
    const nlohmann::json changed = document.changedValues();
    for (const auto& [id, value] : changed.items())
        if (editsScene(id) && id != "environment.file") edits[id] = value;
    if (!document.environmentDigest().empty()) edits[Document::kEnvironmentDigest] = document.environmentDigest();
    spec.sceneKey = nlohmann::json{
        {"digest", document.loadedScene()->contentDigest},
        {"index", document.sceneChoice().index},
        {"variant", document.sceneChoice().variant},
        {"edits",
         edits}}.dump();
    return spec;
}

bool isReferenceOf(const ReferenceSpec& spec, const Document& document) {
    const ReferenceSpec present = specWithoutKey(document);
    return spec.scene == present.scene && spec.time == present.time && spec.openSeconds == present.openSeconds &&
           spec.camera == present.camera && spec.cameraTrack == present.cameraTrack && spec.path == present.path &&
           spec.jitter == present.jitter;
}

}  // namespace lumi

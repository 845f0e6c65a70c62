#include "session/changes.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lumi {
namespace {

bool timeJumps(const Document& before, const Document& now) {
    const float step = now.time() - before.time();
    return step < 0 || step > 1.5f / now.render().fps;
}

bool cameraJumps(const FrameState& before, const FrameState& now) {
    if (before.document.cameraIndex() != now.document.cameraIndex()) return true;
    if (before.camera.projection != now.camera.projection) return true;
    if (glm::dot(before.camera.forward(), now.camera.forward()) < 0) return true;
    const float distance = glm::length(now.camera.position() - before.camera.position());
    return distance > 0 && distance > 0.5f * now.document.sceneRadius();
}

bool lightsMove(const PosedScene& posed) {
    for (const PosedLight& light : posed.lights)
        if (light.worldFromLight != light.worldFromLightPrevious) return true;
    return false;
}

bool objectsMove(const PosedScene& posed) {
    for (const PosedInstance& instance : posed.instances)
        if (instance.worldFromObject != instance.worldFromObjectPrevious() ||
            instance.deformed != instance.deformedPrevious())
            return true;
    return false;
}

/// Which parts of the scene the documents' edits changed: a value that went there and back did not change.
void addEdits(const Document& before, const Document& now, Changes& changes) {
    if (before.scene() == now.scene()) return;
    const nlohmann::json edits = Document::difference(before, now);
    for (const auto& [id, value] : edits.items()) {
        const bool material = id.compare(0, 9, "material.") == 0;
        changes.materials |= material;
        changes.lights |= id.compare(0, 6, "light.") == 0 || id.compare(0, 12, "environment.") == 0 ||
                          (material && id.find(".emission") != std::string::npos);
    }
}

}  // namespace

bool isCut(const FrameState& before, const FrameState& now) {
    return before.document.loadedScene() != now.document.loadedScene() || before.camera.extent != now.camera.extent ||
           timeJumps(before.document, now.document) || cameraJumps(before, now);
}

Redo worstDifference(const Document& before, const Document& now) {
    const nlohmann::json changes = Document::difference(before, now);
    Redo worst = Redo::Display;
    const auto consider = [&](const std::vector<ParameterInfo>& parameters) {
        for (const ParameterInfo& info : parameters)
            if (changes.contains(info.id)) worst = std::max(worst, info.redo);
    };
    consider(now.list("", Document::Part::Others));
    consider(now.loadedScene() == before.loadedScene() ? now.listUnlike(*before.scene())
                                                       : now.list("", Document::Part::OfScene));
    return worst;
}

Changes differences(const FrameState& before, const FrameState& now, const PosedScene& posed) {
    const Document& a = before.document;
    const Document& b = now.document;
    Changes changes;
    changes.camera = before.camera != now.camera;
    changes.objects = objectsMove(posed);
    changes.lights = lightsMove(posed);
    addEdits(a, b, changes);
    changes.sampling = a.path() != b.path() || a.render().samplesPerPixel != b.render().samplesPerPixel ||
                       a.render().seed != b.render().seed || before.jitter != now.jitter ||
                       (now.camera.shutter > 0 && a.render().fps != b.render().fps);  // it is open for another time
    return changes;
}

}  // namespace lumi

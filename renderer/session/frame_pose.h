#pragma once
#include <initializer_list>

#include "base/error.h"
#include "scene/posed_scene.h"
#include "session/document.h"

namespace lumi {

/// Scene at the document's time, seen from `previousTime`; one of `known` (may be null) is taken if it is just that.
/// Null if it was stopped.
inline std::shared_ptr<const PosedScene> pose(const Document& document, float previousTime, const PosedScene* earlier,
                                              std::initializer_list<std::shared_ptr<const PosedScene>> known,
                                              const std::stop_token& stop = {}) {
    const float time = document.time(), close = time + document.camera().shutter / document.render().fps;
    for (const auto& posed : known)
        if (posed && posed->scene == document.scene() && posed->time == time && posed->closeTime == close &&
            posed->previousTime == previousTime)
            return posed;
    try {
        return poseScene(document.scene(), {time, close, previousTime}, earlier, stop);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::Interrupted) throw;
        return nullptr;
    }
}

}  // namespace lumi

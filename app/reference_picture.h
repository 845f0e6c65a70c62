#pragma once
#include <filesystem>
#include <string>

#include "reference/reference.h"
#include "session/document.h"
#include "session/export.h"
#include "session/frame_engine.h"
#include "session/state_log.h"

namespace lumi {

/// Everything about a reference's file but its pixels, known before the first sample is traced. As text it goes along
/// with parts, so that merging needs no scene.
struct ReferencePicture {
    CameraPose camera;
    ViewSettings view;
    bool half = false;
    std::string state;   ///< StateLog::json() of one frame, without the number of samples
    int initialSpp = 1;  ///< of the scene: a state does not tell what it would be anyway

    static ReferencePicture of(const Document& document, const SceneReference& scene, const std::string& buffers,
                               bool half);
    std::string text() const;
    /// Throws Error(BadInput) headed by `where`.
    static ReferencePicture parse(const std::string& text, const std::string& where);

    /// The state of an image of so many samples: `render --replay` makes it again.
    std::string stateOf(uint64_t samples) const;
    /// Writes .exr (R, G, B, A, Z and the signals of `buffers` that `signals` has) or .png. The bytes are those that
    /// `render` writes for the same samples. `signals` may be null. Throws Error(Usage) for other extensions.
    Written write(const std::filesystem::path& path, const Reference& reference, const std::string& buffers,
                  std::shared_ptr<const Signals> signals) const;
};

}  // namespace lumi

#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "base/messages.h"
#include "image/exr.h"
#include "session/frame_engine.h"

namespace lumi {

/// Buffers that go into an EXR as layers, besides the image and root Z.
struct BufferSelection {
    SignalSet signals;
    TapSet taps;  ///< of the view's module

    static BufferSelection all(const std::string& instance);
    /// `all`, or names separated by commas: signals, taps, `<module>-<tap>`. Throws Error(Usage) naming the nearest.
    static BufferSelection parse(const std::string& text, const std::string& instance, const std::string& where);
};

/// What was written: what a replay needs besides the frames to write the same file again.
struct OutputChoice {
    int view = 0;         ///< whose module and picture
    std::string buffers;  ///< as for --buffers
    bool half = false;    ///< colours of an EXR as half

    nlohmann::json json() const;
    static OutputChoice parse(const nlohmann::json& value, const std::string& where);
};

/// R, G, B (the module's result), A, root Z (where the frame has depth), then the selected layers; colours named
/// `<signal>.R`, taps `<module>-<tap>.Y`; attributes: the state, worldToCamera, worldToNDC.
ExrLayers exportLayers(const FrameOutput& frame, const std::string& instance, const BufferSelection& buffers,
                       const std::string& state);

/// A file that was written: its name, and how many colours were beyond half and are clamped, see encodeExr().
struct Written {
    std::filesystem::path path;
    size_t clamped = 0;
    /// Says so in one line, if there are any.
    void warn(MessageLog& log) const;
};

/// Writes what a view shows as .exr (linear, with the layers of `buffers`, colours as half if wanted) or .png (as
/// shown). Throws Error(Usage) for other extensions.
Written writeView(const std::filesystem::path& path, const FrameOutput& frame, const ViewSettings& view,
                  const BufferSelection& buffers, bool half, const std::string& state);

/// The bytes of such a file; `name` says which kind. `clamped` as of encodeExr().
std::vector<uint8_t> encodeView(const std::filesystem::path& name, const FrameOutput& frame, const ViewSettings& view,
                                const BufferSelection& buffers, bool half, const std::string& state,
                                size_t* clamped = nullptr);

/// The same of one of a document's views. `document` is the one that the frame was drawn from.
Written exportView(const std::filesystem::path& path, const FrameOutput& frame, const Document& document,
                   const OutputChoice& choice, const std::string& state);
/// The same over no other file: see writeNewFile().
Written exportNewView(const std::filesystem::path& path, const FrameOutput& frame, const Document& document,
                      const OutputChoice& choice, const std::string& state);

/// Camera space to normalised device coordinates: x right, y up, both in [-1, 1] over the image.
Mat4 ndcFromCamera(const CameraPose& camera);

}  // namespace lumi

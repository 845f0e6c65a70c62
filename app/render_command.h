#pragma once
#include <memory>
#include <string>
#include <vector>

#include "app/progress_line.h"
#include "image/video.h"
#include "session/export.h"
#include "session/frame_engine.h"
#include "session/state_log.h"

namespace lumi {

/// The files of one `render`: those with a frame number are written each frame, videos grow, the others get the last
/// frame. Nothing is left half written.
class RenderOutputs {
public:
    /// Checks every name before the first ray. Without an ffmpeg program a video becomes numbered PNGs, and a warning.
    /// Throws Error(Usage).
    RenderOutputs(const std::vector<std::string>& names, const OutputChoice& choice, double fps, MessageLog& log);

    /// Does the frame go into an EXR, so that its layers have to be there?
    bool wantsLayers(bool last) const;
    void write(const FrameOutput& frame, const Document& document, const StateLog& log, bool last);
    void finish();
    const std::vector<std::string>& files() const { return files_; }

private:
    struct Output {
        std::string name;
        std::string extension;
        bool numbered = false;
    };
    struct Video {
        std::filesystem::path path;
        std::unique_ptr<VideoPipe> pipe;
    };
    void writeVideo(const Output& output, const FrameOutput& frame, const Document& document);

    std::vector<Output> outputs_;
    std::vector<Video> videos_;
    OutputChoice choice_;
    double fps_;
    std::vector<std::string> files_;
};

/// `pattern` with `%d`, `%04d` replaced by the number and `%%` by `%`. Throws Error(Usage) for anything else after `%`.
std::string numberedName(const std::string& pattern, int64_t number, bool* hasNumber = nullptr);

}  // namespace lumi

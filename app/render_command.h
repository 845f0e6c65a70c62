#pragma once
#include <memory>
#include <string>
#include <vector>

#include "app/progress_line.h"
#include "image/video.h"
#include "session/export.h"
#include "session/frame_engine.h"
#include "session/replay.h"

namespace lumi {

/// The files of one `render`: those with a frame number are written each frame, the others get the last frame. A frame
/// that is there already with the same state is left alone; one with another state is never overwritten. The frames of
/// a video are kept as PNGs in `<video>.frames` until it is complete, so that it goes on after an interruption. Nothing
/// is left half written.
class RenderOutputs {
public:
    /// Checks every name before the first ray, and that its folder, which is created, can be written. Without an ffmpeg
    /// program a video becomes numbered PNGs, and a warning. `log` outlives this. Throws Error(Usage),
    /// Error(Resources).
    RenderOutputs(const std::vector<std::string>& names, const OutputChoice& choice, double fps, MessageLog& log);

    /// Does the frame go into an EXR, so that its layers have to be there?
    bool wantsLayers(bool last) const;
    void write(const FrameOutput& frame, const Document& document, const StateLog& log, bool last);
    /// Is the frame what its files hold, to the byte? Throws Error(Usage) naming one that holds something else.
    void verify(const FrameOutput& frame, const Document& document, const StateLog& log) const;
    /// Makes the videos of frames [begin, end). Throws Error(Interrupted); the frames stay then.
    void finish(int64_t begin, int64_t end, std::stop_token stop = {});

    const std::vector<std::string>& files() const { return files_; }  ///< written, videos but not their frames
    std::vector<std::string> numberedFiles(int64_t frame) const;
    static bool allThere(const std::vector<std::string>& names);
    bool hasLastFrameFiles() const;  ///< files without a number
    [[noreturn]] static void throwOtherState(const std::string& name);

private:
    struct Output {
        std::string name;
        std::string extension;
        bool numbered = false;
        std::filesystem::path video;  ///< that these frames are of; empty: of none
    };
    Output videoFrames(const std::string& name) const;
    void finishVideo(const Output& output, int64_t begin, int64_t end, std::stop_token stop);

    std::vector<Output> outputs_;
    OutputChoice choice_;
    double fps_;
    MessageLog& log_;
    std::vector<std::string> files_;
};

/// `pattern` with `%d`, `%04d` replaced by the number and `%%` by `%`. Throws Error(Usage) for anything else after `%`.
std::string numberedName(const std::string& pattern, int64_t number, bool* hasNumber = nullptr);

}  // namespace lumi

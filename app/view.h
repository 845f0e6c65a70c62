#pragma once
#include <filesystem>
#include <optional>

#include "app/frame_range.h"
#include "app/window.h"

namespace lumi {

struct ViewOptions {
    StartOptions start;
    Extent2 size{1280, 800};  ///< of the window's content, in pixels
    std::filesystem::path
        script;  ///< input events, one a line (see app/view_script.h); empty: wait for an image, one shot
    std::filesystem::path out;         ///< folder for the PNGs; made if it is missing
    std::optional<FrameRange> frames;  ///< one PNG of each, named by its number; only without a script
    int64_t warmUp = 0;                ///< frames to draw before the first of them
    std::string buffers;               ///< not empty: the picture goes into an EXR beside each PNG, with these layers
    bool half = false;                 ///< colours of the EXR as half
    Progress progress = Progress::Auto;
    int samples = 16;    ///< without a script: how many samples a pixel the shot waits for
    bool json = false;   ///< prints one JSON value on stdout: files written, frames, UI time
    bool quiet = false;  ///< nothing on stderr but errors
};

/// Draws the window's content without a display, driven by a script. Returns the exit code.
/// Throws what StartCheck throws; Error(NoDisplay) when neither EGL nor OSMesa gives an OpenGL 3.3 context,
/// Error(BadInput) with `script.txt:12` for a line it does not understand, Error(CheckFailed) when a `wait` of the
/// script runs out of time.
int runView(const ViewOptions& options);

}  // namespace lumi

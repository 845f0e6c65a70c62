#pragma once
#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"

namespace lumi {

/// A video file being written: frames go to the `ffmpeg` program as raw RGB and come out as H.264, yuv420p, BT.709,
/// padded to even sides. One writer on one thread.
class VideoPipe {
public:
    /// Starts ffmpeg. Throws Error(Usage): `path` exists, no ffmpeg program (the message says what to do); the sides
    /// are 1 to 16384 and fps above 0.
    VideoPipe(const std::filesystem::path& path, Extent2 extent, double fps);
    /// A pipe that was not finished ends ffmpeg and removes the incomplete file.
    ~VideoPipe();
    VideoPipe(const VideoPipe&) = delete;
    VideoPipe& operator=(const VideoPipe&) = delete;

    /// Appends a frame of the extent given before. Throws Error(Resources) with ffmpeg's own words if it has ended.
    void write(const Image8& frame);
    /// Completes the file. Throws Error(Resources) with ffmpeg's own words if it failed or no frame was written.
    void finish();

    /// Is there an ffmpeg program in $PATH?
    static bool available();

private:
    [[noreturn]] void fail(const std::string& what);
    void closeInput();
    int waitForExit();

    std::filesystem::path path_, partial_;  ///< where it is in the end; where it is written
    Extent2 extent_;
    pid_t process_ = -1;
    int input_ = -1;     ///< our end of ffmpeg's standard input
    int messages_ = -1;  ///< file in memory that takes ffmpeg's standard error
    int64_t frames_ = 0;
    std::vector<uint8_t> pixels_;
};

}  // namespace lumi

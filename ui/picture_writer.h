#pragma once
#include <filesystem>
#include <future>
#include <vector>

#include "base/messages.h"
#include "image/image.h"

namespace lumi {

/// Writes pictures as PNG in the background, so that the UI thread never encodes.
class PictureWriter {
public:
    explicit PictureWriter(MessageLog& log) : log_(log) {}
    /// Over no other file: see writeNewFile(). Success and failure are messages.
    void write(Image8 picture, const std::filesystem::path& path);

private:
    MessageLog& log_;
    std::vector<std::future<void>> pending_;  ///< their destructors wait for the files
};

}  // namespace lumi

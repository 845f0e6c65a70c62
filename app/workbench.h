#pragma once
#include "app/window.h"
#include "session/session.h"
#include "ui/interface.h"

namespace lumi {

/// Opens what the options name, with their parameters.
void openAtStart(Session& session, AppState& state, const StartOptions& start);

/// Writes pictures as PNG in the background, so that the UI thread never encodes.
class PictureWriter {
public:
    explicit PictureWriter(MessageLog& log) : log_(log) {}
    /// Success and failure are messages.
    void write(Image8 picture, const std::filesystem::path& path);

private:
    MessageLog& log_;
    std::vector<std::future<void>> pending_;  ///< their destructors wait for the files
};

}  // namespace lumi

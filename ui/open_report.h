#pragma once
#include <filesystem>

#include "base/messages.h"

namespace lumi {

/// The report that a dropped path stands for: a .html file, or `report.html` in a folder that a study wrote; empty if
/// none.
std::filesystem::path reportAt(const std::filesystem::path& path);

/// Shows a file in the desktop's browser (`xdg-open`), in a process of its own. What comes of it is a message.
void openInBrowser(const std::filesystem::path& file, MessageLog& log);

}  // namespace lumi

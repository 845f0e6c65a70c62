#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>

#include "base/error.h"
#include "scene/load.h"
#include "scene/scene_file.h"

namespace lumi::test {

/// A scene from text; file names in it are sought in `folder`.
inline Scene parseScene(const std::string& text, const std::filesystem::path& folder = {}) {
    MessageLog log;
    return parseSceneFile(text, "s.json", folder, log);
}

/// The message with which a scene's text is refused; empty if it is not. Checks that the fault counts as bad input.
inline std::string refusal(const std::string& text, const std::filesystem::path& folder = {}) {
    try {
        parseScene(text, folder);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::BadInput) << error.what();
        return error.what();
    }
    return {};
}

}  // namespace lumi::test

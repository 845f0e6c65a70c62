#pragma once
#include <filesystem>
#include <string>

#include "scene/load.h"

namespace lumi {

constexpr uint64_t kMaxSceneFileBytes = uint64_t(256) << 20;

/// Loads our own scene file (JSON; DESIGN and README, "Scene files"). Keys that nobody knows, values out of range and
/// names that nothing defines are Error(BadInput) at file:line:column. Cameras may be absent; see addDefaults(). Its
/// paths may lead out of its folder, which those inside glTF and OBJ files may not: who writes a scene file chooses
/// what it reads.
Scene loadSceneFile(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options = {});

/// The same from text: `file` heads messages, relative paths start at `folder`.
Scene parseSceneFile(const std::string& text, const std::string& file, const std::filesystem::path& folder,
                     MessageLog& log, const LoadOptions& options = {});

/// The title of a scene file without loading what it names; empty if it has none or cannot be read.
std::string sceneFileTitle(const std::filesystem::path& path);

/// A JSON Schema (draft 2020-12) of the scene file, made from the declarations of all that it can set. Shipped as
/// scenes/scene.schema.json.
std::string sceneFileSchema();

}  // namespace lumi

#pragma once
#include <filesystem>
#include <string>

namespace lumi {

/// Scene and study files may name files that are too large to come with the program: `assets:` and a path under a
/// folder of assets, $LUMISCOPE_ASSETS or else ../shared/assets beside the source folder.
bool isAssetName(const std::string& name);

/// The file that an asset's name stands for. Throws Error(BadInput) that says where it was sought and what to do if it
/// is not there, or if the name leads out of the folder.
std::filesystem::path findAsset(const std::string& name);

/// What findAsset() would say of the first asset in a scene file that is not there; empty if all are, or if the file
/// cannot be read.
std::string missingAsset(const std::filesystem::path& sceneFile);

}  // namespace lumi

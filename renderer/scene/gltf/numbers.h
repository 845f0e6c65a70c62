#pragma once
#include <nlohmann/json_fwd.hpp>

#include "scene/file_warnings.h"

namespace lumi::gltf {

/// Puts the numbers of materials, in a tree that has passed checkStructure(), into their ranges: the nearest number is
/// taken for one that is out of its range, the default for what is no number, with one warning each. Returns whether
/// any was. The table in numbers.cpp has all.
bool checkNumbers(nlohmann::json& tree, FileWarnings& warnings);

}  // namespace lumi::gltf

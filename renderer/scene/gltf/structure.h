#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "scene/file_warnings.h"

namespace lumi::gltf {

/// Checks the form of a glTF's JSON before tinygltf reads it, which drops what it cannot use or refuses it without
/// saying where: its version is one that is read, sections hold objects, what must be there is, numbers are whole and
/// within their range, indices refer to what there is. The table in structure_table.cpp is all that is checked; the
/// rest is where it is used. Numbers like 4.0 become 4, as tinygltf wants them; what some write for "absent", null, an
/// index of -1 or an empty array for an extension, goes, with one warning for the file. Returns whether anything has
/// changed. Throws Error(BadInput) headed "file: jsonPath".
bool checkStructure(nlohmann::json& tree, FileWarnings& warnings);

/// What an index may be: "0 to 3", or that there is nothing to refer to.
std::string expectedIndex(size_t count, const std::string& collection);

}  // namespace lumi::gltf

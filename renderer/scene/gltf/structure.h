#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace lumi::gltf {

/// Checks the form of a glTF's JSON before tinygltf reads it, which drops what it cannot use or refuses it without
/// saying where: sections hold objects, what must be there is, numbers are whole and within their range, indices refer
/// to what there is. The table in structure.cpp is all that is checked; the rest is where it is used. Numbers like 4.0
/// become 4, as tinygltf wants them. Returns whether any did. Throws Error(BadInput) headed "where: jsonPath".
bool checkStructure(nlohmann::json& tree, const std::string& where);

/// What an index may be: "0 to 3", or that there is nothing to refer to.
std::string expectedIndex(size_t count, const std::string& collection);

}  // namespace lumi::gltf

#pragma once
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// What must be known of a file's JSON before it is given to tinygltf.
struct JsonSummary {
    std::vector<std::string> requiredExtensions;  ///< "extensionsRequired"
    uint64_t treeBytes = 0;                       ///< of the values as a tree in memory, about: many times the text
};

/// Deepest nesting that is accepted: tinygltf recurses, and overflows its stack on hostile files.
inline constexpr int kMaxJsonDepth = 128;

/// Where makeReadable() puts indices without bytes of their own, as {"indices": accessor}.
inline constexpr const char* kIndicesAlone = "LUMISCOPE_indices_alone";

/// Is it data rather than a file [RFC 2397]?
bool isDataUri(std::string_view uri);

/// Puts a tree that has passed checkStructure() in a form that tinygltf accepts: every fallback buffer is one byte long
/// and embedded, so that nothing is read for it; data URIs in base64 of other kinds than tinygltf knows, or of none
/// [RFC 2397], are bytes; plus signs and lone percent signs in names of files are escaped; the indices of Draco
/// primitives and those of accessors without a bufferView, which tinygltf wants bytes for, stand in extensions. Returns
/// whether anything has changed.
bool makeReadable(nlohmann::json& tree);

/// Reads through the JSON without building a tree and without recursion. Throws Error(BadInput): a syntax error (with
/// line and column), or nesting deeper than kMaxJsonDepth. `where` heads messages.
JsonSummary inspectJson(std::string_view json, const std::string& where);

}  // namespace lumi::gltf

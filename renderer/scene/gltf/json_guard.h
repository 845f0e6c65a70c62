#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// What must be known of a file's JSON before it is given to tinygltf.
struct JsonSummary {
    struct Buffer {
        bool hasUri = false;      ///< false: the GLB's own binary chunk
        bool external = false;    ///< a file, not a data URI
        bool isFallback = false;  ///< EXT_meshopt_compression: only for readers without it; nothing need be there
        uint64_t byteLength = 0;
    };
    std::vector<Buffer> buffers;                  ///< in document order
    bool hasDraco = false;                        ///< some primitive is under KHR_draco_mesh_compression
    bool hasOtherUris = false;                    ///< some that tinygltf takes for others
    bool hasSparseAlone = false;                  ///< a sparse accessor without a bufferView
    std::vector<std::string> requiredExtensions;  ///< "extensionsRequired"
    uint64_t treeBytes = 0;                       ///< of the values as a tree in memory, about: many times the text
};

/// Deepest nesting that is accepted: tinygltf recurses, and overflows its stack on hostile files.
inline constexpr int kMaxJsonDepth = 128;

/// Where readableByTinygltf() puts indices that are all in a sparse accessor, as {"indices": accessor}.
inline constexpr const char* kSparseIndices = "LUMISCOPE_sparse_indices";

/// Is it data rather than a file [RFC 2397]?
bool isDataUri(std::string_view uri);

/// The JSON in a form that tinygltf accepts: every fallback buffer is one byte long and embedded, so that nothing is
/// read for it; data URIs in base64 of other kinds than tinygltf knows, or of none [RFC 2397], are bytes; plus signs
/// and lone percent signs in names of files are escaped; the indices of Draco primitives and those of sparse accessors
/// alone, which tinygltf wants bytes for, stand in extensions.
std::string readableByTinygltf(std::string_view json);

/// Reads through the JSON without building a tree and without recursion. Throws Error(BadInput): a syntax error (with
/// line and column), or nesting deeper than kMaxJsonDepth. `where` heads messages.
JsonSummary inspectJson(std::string_view json, const std::string& where);

}  // namespace lumi::gltf

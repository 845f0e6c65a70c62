#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// Where the bytes of a file's buffers are.
struct Sources {
    struct File {
        size_t buffer;
        uint64_t byteLength;
    };
    std::vector<File> files;   ///< buffers in files of their own, in document order
    uint64_t binaryBytes = 0;  ///< of the buffers in a GLB's binary chunk
    bool hasCut = false;       ///< data longer than their buffer were cut, since tinygltf wants the exact length
};

/// Checks that buffers and images have a source, that names of files stay inside `folder`, and that data URIs and the
/// GLB's binary chunk of `chunkBytes` hold what their buffers say. The tree has passed checkStructure() and
/// makeReadable(). Throws Error(BadInput) headed "where: jsonPath".
Sources checkSources(nlohmann::json& tree, const std::filesystem::path& folder, uint64_t chunkBytes,
                     const std::string& where);

/// The beginning of a long name or data URI, for messages.
std::string shortened(std::string_view uri);

}  // namespace lumi::gltf

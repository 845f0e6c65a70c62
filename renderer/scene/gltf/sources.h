#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace lumi::gltf {

/// Where the bytes of a file's buffers are.
struct Sources {
    struct File {
        size_t buffer;
        uint64_t byteLength;
    };
    /// An image that is not read, whose uri is empty now, and why.
    struct ImageFault {
        size_t image;
        std::string text;
    };
    std::vector<File> files;   ///< buffers in files of their own, in document order
    uint64_t binaryBytes = 0;  ///< of the buffers in a GLB's binary chunk
    std::vector<ImageFault> imageFaults;
    bool hasChanged = false;  ///< of data, since tinygltf wants plain base64 of the exact length, or of such images
};

/// Checks that buffers have a source, that names of their files stay inside `folder`, and that data URIs and the GLB's
/// binary chunk of `chunkBytes` hold what their buffers say. Images may fail such: they have a fault then. The tree has
/// passed checkStructure() and makeReadable(). Throws Error(BadInput) headed "where: jsonPath".
Sources checkSources(nlohmann::json& tree, const std::filesystem::path& folder, uint64_t chunkBytes,
                     const std::string& where);

}  // namespace lumi::gltf

#pragma once
#include <tiny_gltf.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scene/file_warnings.h"
#include "scene/gltf/sources.h"
#include "scene/load.h"

namespace lumi::gltf {

/// Where the encoded bytes of an image are.
struct ImageSource {
    std::filesystem::path file;  ///< an external file, or empty
    int bufferView = -1;         ///< inside a buffer, or -1
    std::vector<uint8_t> bytes;  ///< of a data URI
    std::string name;            ///< for messages
    std::string fault;           ///< why there are none, if that is known
};

/// A parsed glTF file. Its JSON has the form of a glTF (checkStructure) and its buffers are complete; what the
/// form does not say is checked where it is used.
class Document {
public:
    /// Reads and parses the file and its buffers; images stay where they are. Throws Error(BadInput) or
    /// Error(Resources), and Error(Interrupted) once `options` are stopped.
    Document(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options);

    const tinygltf::Model& model() const { return model_; }
    const std::vector<ImageSource>& images() const { return images_; }
    const LoadOptions& options() const { return options_; }
    const std::filesystem::path& path() const { return path_; }
    /// Bytes of the file, of its buffers' files and of what its compressed views decompress to.
    uint64_t byteCount() const { return byteCount_; }
    /// Digest of the file and of its buffers' files, without images.
    uint64_t contentDigest() const { return digest_; }

    /// Throws Error(BadInput) headed "file.gltf: jsonPath".
    [[noreturn]] void fail(const std::string& jsonPath, const std::string& what, const std::string& expected = {},
                           const std::string& found = {}) const;
    /// One line in the message log, headed by the file.
    void warn(const std::string& text) const { warnings_.warn(text); }
    void tellOfMore() const { warnings_.tellOfMore(); }
    void info(const std::string& text) const { log_.info(name_ + ": " + text); }

    /// Throws unless `index` is a valid index into a collection of `count` things called `collection`.
    void checkIndex(int64_t index, size_t count, const std::string& jsonPath, const char* collection) const;
    /// The bytes of a buffer view, range checked, decompressed if need be.
    std::span<const uint8_t> bufferView(int index, const std::string& jsonPath) const;

    /// Part of a buffer, range checked; `jsonPath` names what refers to it.
    std::span<const uint8_t> bufferBytes(int buffer, size_t offset, size_t length, const std::string& jsonPath) const;

    /// Reports a step; throws Error(Interrupted) if the load was stopped.
    void progress(float fraction, const std::string& step) const;
    void pollStop() const;

    // Called by tinygltf's file callbacks.
    bool fileExists(const std::string& tinygltfPath);
    bool readWholeFile(std::vector<unsigned char>& out, const std::string& tinygltfPath);
    void keepImage(int index, std::span<const uint8_t> bytes);

private:
    void parse(std::span<const uint8_t> file);
    /// Checks the JSON and notes its sources. What tinygltf should read in its place, or empty.
    std::string checkedJson(std::string_view json, uint64_t chunkBytes);
    void decompressViews();
    void checkRequiredExtensions(const std::vector<std::string>& names) const;
    std::filesystem::path resolve(const std::string& tinygltfPath) const;

    std::filesystem::path path_;
    std::string name_;  ///< file name, heads every message
    MessageLog& log_;
    mutable FileWarnings warnings_;
    const LoadOptions& options_;
    tinygltf::Model model_;
    std::vector<ImageSource> images_;
    std::vector<std::vector<uint8_t>> decompressed_;  ///< by buffer view; empty where it is not compressed
    Sources sources_;
    size_t buffersRead_ = 0;  ///< of those in files of their own
    std::filesystem::path lastImageFile_;
    uint64_t digest_ = 0;
    uint64_t byteCount_ = 0;
};

}  // namespace lumi::gltf

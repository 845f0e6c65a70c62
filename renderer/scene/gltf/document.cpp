#include "scene/gltf/document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "scene/gltf/glb.h"
#include "scene/gltf/json_guard.h"
#include "scene/gltf/meshopt.h"
#include "scene/gltf/numbers.h"
#include "scene/gltf/structure.h"
#include "scene/gltf/uri.h"

namespace lumi::gltf {
namespace {

/// Stands for the asset's folder in the paths that tinygltf makes, so that no other place is ever looked at.
const std::string kFolder = "@asset";

constexpr uint64_t kMaxFileBytes = (uint64_t(1) << 32) - 1;  ///< GLB lengths are 32-bit

/// Extensions that the loader understands, in the order of the glTF registry.
constexpr std::array kSupportedExtensions = {"EXT_mesh_gpu_instancing",
                                             "EXT_meshopt_compression",
                                             "KHR_draco_mesh_compression",
                                             "KHR_lights_punctual",
                                             "KHR_materials_anisotropy",
                                             "KHR_materials_clearcoat",
                                             "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",
                                             "KHR_materials_iridescence",
                                             "KHR_materials_pbrSpecularGlossiness",
                                             "KHR_materials_sheen",
                                             "KHR_materials_specular",
                                             "KHR_materials_transmission",
                                             "KHR_materials_unlit",
                                             "KHR_materials_variants",
                                             "KHR_materials_volume",
                                             "KHR_mesh_quantization",
                                             "KHR_texture_transform"};

/// Texture formats that are shown as stand-ins, with a warning of their own (TextureLibrary).
constexpr std::array kStandInExtensions = {"EXT_texture_avif", "EXT_texture_webp", "KHR_texture_basisu",
                                           "MSFT_texture_dds"};

bool isSupported(const std::string& extension) {
    const auto in = [&](const auto& list) { return std::find(list.begin(), list.end(), extension) != list.end(); };
    return in(kSupportedExtensions) || in(kStandInExtensions);
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find_first_of("\r\n")); }

tinygltf::FsCallbacks callbacksFor(Document& document) {
    tinygltf::FsCallbacks callbacks{};
    callbacks.user_data = &document;
    callbacks.ExpandFilePath = [](const std::string& path, void*) { return path; };
    callbacks.FileExists = [](const std::string& path, void* user) {
        return static_cast<Document*>(user)->fileExists(path);
    };
    callbacks.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void* user) {
        return static_cast<Document*>(user)->readWholeFile(*out, path);
    };
    return callbacks;
}

bool keepEncoded(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void* user) {
    const bool embedded = image->bufferView < 0 && image->uri.empty();
    static_cast<Document*>(user)->keepImage(
        index, embedded ? std::span(bytes, static_cast<size_t>(std::max(size, 0))) : std::span<const uint8_t>());
    return true;
}

}  // namespace

Document::Document(const std::filesystem::path& path, MessageLog& log, const LoadOptions& options)
    : path_(path), name_(path.filename().string()), log_(log), warnings_(name_, log), options_(options) {
    progress(0, "Reading " + name_);
    const std::vector<uint8_t> file = readFile(path, kMaxFileBytes);
    digest_ = digest64(file);
    byteCount_ = file.size();
    try {
        parse(file);
        decompressViews();
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::Resources, {.what = "not enough memory to read the file", .where = name_});
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        throwBadInput({.what = "damaged glTF: " + firstLine(e.what()), .where = name_});
    }
    for (const std::string& name : model_.extensionsUsed)
        if (!isSupported(name)) warn("the extension \"" + name + "\" is not supported; what it adds is left out");
}

void Document::parse(std::span<const uint8_t> file) {
    const bool binary = isBinary(file);
    const std::string_view json =
        binary ? jsonChunk(file, name_) : std::string_view(reinterpret_cast<const char*>(file.data()), file.size());
    if (!binary && lowerExtension(path_) == ".glb")
        throwBadInput({.what = "not a GLB file", .where = name_, .expected = "the magic bytes \"glTF\""});
    const std::string patched = checkedJson(json, binary ? binaryChunkBytes(file) : 0);
    checkMemory("the buffers of " + name_, sources_.binaryBytes);

    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks(callbacksFor(*this));
    reader.SetImageLoader(keepEncoded, this);
    std::string error, warning;
    const bool good = [&] {
        if (binary) {
            const bool isAsRead = patched.empty() && !hasOtherChunk(file);
            const std::vector<uint8_t> glb =
                isAsRead ? std::vector<uint8_t>() : withJsonChunk(file, patched.empty() ? std::string(json) : patched);
            const std::span<const uint8_t> whole = isAsRead ? file : std::span<const uint8_t>(glb);
            return reader.LoadBinaryFromMemory(&model_, &error, &warning, whole.data(),
                                               static_cast<unsigned int>(whole.size()), kFolder);
        }
        const std::string_view text = patched.empty() ? json : std::string_view(patched);
        return reader.LoadASCIIFromString(&model_, &error, &warning, text.data(),
                                          static_cast<unsigned int>(text.size()), kFolder);
    }();
    if (!good) throwBadInput({.what = "damaged glTF: " + firstLine(error), .where = name_});

    images_.resize(model_.images.size());
    for (size_t i = 0; i < images_.size(); ++i) {
        const tinygltf::Image& image = model_.images[i];
        images_[i].bufferView = image.bufferView;
        images_[i].name = isDataUri(image.uri)  ? shortened(image.uri)
                          : !image.uri.empty()  ? image.uri
                          : !image.name.empty() ? image.name
                                                : "image " + std::to_string(i);
    }
    for (const Sources::ImageFault& fault : sources_.imageFaults) images_[fault.image].fault = fault.text;
}

std::string Document::checkedJson(std::string_view json, uint64_t chunkBytes) {
    const JsonSummary summary = inspectJson(json, name_);
    checkRequiredExtensions(summary.requiredExtensions);
    checkMemory("the JSON of " + name_, summary.treeBytes);
    nlohmann::json tree = nlohmann::json::parse(json.begin(), json.end());
    bool hasChanged = checkStructure(tree, warnings_);
    hasChanged |= checkNumbers(tree, warnings_);
    hasChanged |= makeReadable(tree);
    sources_ = checkSources(tree, path_.parent_path(), chunkBytes, name_);
    if (!hasChanged && !sources_.hasChanged) return {};
    return tree.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void Document::checkRequiredExtensions(const std::vector<std::string>& names) const {
    for (size_t i = 0; i < names.size(); ++i)
        if (!isSupported(names[i]))
            fail("/extensionsRequired/" + std::to_string(i),
                 "the file requires the extension \"" + names[i] + "\", which is not supported");
}

void Document::fail(const std::string& jsonPath, const std::string& what, const std::string& expected,
                    const std::string& found) const {
    throwBadInput({.what = what, .where = name_ + ": " + jsonPath, .expected = expected, .found = found});
}

void Document::checkIndex(int64_t index, size_t count, const std::string& jsonPath, const char* collection) const {
    if (index >= 0 && static_cast<uint64_t>(index) < count) return;
    fail(jsonPath, "no such entry in /" + std::string(collection), expectedIndex(count, collection),
         std::to_string(index));
}

std::span<const uint8_t> Document::bufferView(int index, const std::string& jsonPath) const {
    checkIndex(index, model_.bufferViews.size(), jsonPath, "bufferViews");
    const tinygltf::BufferView& view = model_.bufferViews[static_cast<size_t>(index)];
    if (isMeshopt(view)) return decompressed_[static_cast<size_t>(index)];
    return bufferBytes(view.buffer, view.byteOffset, view.byteLength, "/bufferViews/" + std::to_string(index));
}

std::span<const uint8_t> Document::bufferBytes(int index, size_t offset, size_t length,
                                               const std::string& jsonPath) const {
    checkIndex(index, model_.buffers.size(), jsonPath + "/buffer", "buffers");
    const std::vector<unsigned char>& buffer = model_.buffers[static_cast<size_t>(index)].data;
    if (offset > buffer.size() || length > buffer.size() - offset)
        fail(jsonPath, "reaches past the end of its buffer", "at most " + std::to_string(buffer.size()) + " bytes",
             std::to_string(offset) + " + " + std::to_string(length));
    return {buffer.data() + offset, length};
}

void Document::decompressViews() {
    decompressed_.resize(model_.bufferViews.size());
    parallelFor(static_cast<int64_t>(decompressed_.size()), [&](int64_t i) {
        const auto index = static_cast<size_t>(i);
        pollStop();
        const tinygltf::BufferView& view = model_.bufferViews[index];
        if (isMeshopt(view)) decompressed_[index] = decodeMeshopt(*this, view, "/bufferViews/" + std::to_string(index));
    });
    for (const std::vector<uint8_t>& view : decompressed_) byteCount_ += view.size();
}

void Document::progress(float fraction, const std::string& step) const {
    pollStop();
    if (options_.progress) options_.progress(fraction, step);
}

void Document::pollStop() const {
    if (options_.stop.stop_requested())
        throw Error(ErrorKind::Interrupted, {.what = "loading was stopped", .where = name_});
}

std::filesystem::path Document::resolve(const std::string& tinygltfPath) const {
    if (!tinygltfPath.starts_with(kFolder + "/")) return {};
    return pathInside(path_.parent_path(), tinygltfPath.substr(kFolder.size() + 1)).value_or("");
}

bool Document::fileExists(const std::string& tinygltfPath) {
    const std::filesystem::path file = resolve(tinygltfPath);
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(file, ignored);
    const bool isFile = !file.empty() && std::filesystem::is_regular_file(status);
    if (isFile || buffersRead_ == sources_.files.size()) return isFile;
    const std::string shown = "the buffer file \"" + tinygltfPath.substr(kFolder.size() + 1).substr(0, 200) + '"';
    const char* fault = std::filesystem::is_directory(status) ? " is a directory"
                        : std::filesystem::exists(status)     ? " is not a regular file"
                                                              : " does not exist";
    fail("/buffers/" + std::to_string(sources_.files[buffersRead_].buffer) + "/uri", shown + fault);
}

bool Document::readWholeFile(std::vector<unsigned char>& out, const std::string& tinygltfPath) {
    pollStop();
    const std::filesystem::path file = resolve(tinygltfPath);
    if (buffersRead_ == sources_.files.size()) {
        // All buffers are read: this is an image, which is read and decoded later, in parallel.
        lastImageFile_ = file;
        out.assign(1, 0);
        return true;
    }
    const Sources::File& wanted = sources_.files[buffersRead_++];
    const std::string name = file.filename().string();
    std::error_code ignored;
    checkMemory("the buffer " + name, std::filesystem::file_size(file, ignored));
    out = readFile(file, kMaxFileBytes);
    digest_ = digest64(out, digest_);
    byteCount_ += out.size();
    if (out.size() < wanted.byteLength)
        fail("/buffers/" + std::to_string(wanted.buffer) + "/byteLength",
             "is more than the file \"" + name + "\" holds", "at most " + std::to_string(out.size()),
             std::to_string(wanted.byteLength));
    // A file may be longer than its buffer; tinygltf insists on the exact length.
    out.resize(static_cast<size_t>(wanted.byteLength));
    return true;
}

void Document::keepImage(int index, std::span<const uint8_t> bytes) {
    images_.resize(std::max(images_.size(), static_cast<size_t>(index) + 1));
    ImageSource& source = images_[static_cast<size_t>(index)];
    source.file = std::exchange(lastImageFile_, {});
    source.bytes.assign(bytes.begin(), bytes.end());
}

}  // namespace lumi::gltf

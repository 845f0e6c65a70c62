#include "scene/gltf/sources.h"

#include <tiny_gltf.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "scene/gltf/json_guard.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

/// A file's name as it is meant [RFC 3986].
std::string unescaped(std::string_view uri) {
    std::string name;
    for (size_t at = 0; at < uri.size(); ++at) {
        unsigned char byte = 0;
        const char* const hex = uri.data() + at + 1;
        const bool escapes = uri[at] == '%' && at + 2 < uri.size();
        if (escapes && std::from_chars(hex, hex + 2, byte, 16).ptr == hex + 2) name += static_cast<char>(byte), at += 2;
        else name += uri[at];
    }
    return name;
}

class SourceChecker {
public:
    SourceChecker(const std::filesystem::path& folder, uint64_t chunkBytes, const std::string& where)
        : folder_(folder), chunkBytes_(chunkBytes), where_(where) {}

    void checkBuffer(Json& buffer, size_t index) {
        const std::string path = "/buffers/" + std::to_string(index);
        const uint64_t length = buffer["byteLength"].get<uint64_t>();
        if (!buffer.contains("uri") || buffer["uri"].get_ref<const std::string&>().empty()) {
            if (chunkBytes_ == 0)
                fail(path + "/uri", "is missing, and the file has no binary chunk", "the name of a file or a data URI");
            if (length > chunkBytes_) failLength(path, "the file's binary chunk", chunkBytes_, length);
            sources_.binaryBytes += length;
            return;
        }
        auto& uri = buffer["uri"].get_ref<std::string&>();
        if (isDataUri(uri)) return checkData(uri, length, path);
        checkName(uri, path + "/uri");
        sources_.files.push_back({index, length});
    }

    void checkImage(const Json& image, size_t index) const {
        const std::string path = "/images/" + std::to_string(index);
        if (image.contains("uri") == image.contains("bufferView"))
            fail(path, image.contains("uri") ? "has both a uri and a bufferView" : "has no source",
                 "a uri or a bufferView");
        if (!image.contains("uri")) return;
        const auto& uri = image["uri"].get_ref<const std::string&>();
        if (!isDataUri(uri)) checkName(uri, path + "/uri");
        else if (tinygltf::IsDataURI(uri) && dataBytes(uri) == 0)
            fail(path + "/uri", "the data URI holds no bytes", {}, '"' + shortened(uri) + '"');
    }

    Sources take() { return std::move(sources_); }

private:
    /// Of the base64 in a data URI, up to the first character that is none.
    static uint64_t dataBytes(const std::string& uri) {
        constexpr const char* kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        const size_t begin = uri.find(',') + 1;
        return (std::min(uri.find_first_not_of(kAlphabet, begin), uri.size()) - begin) * 3 / 4;
    }

    void checkData(std::string& uri, uint64_t length, const std::string& path) {
        if (!tinygltf::IsDataURI(uri))
            fail(path + "/uri", "a buffer has an unsupported kind of data URI, \"" + shortened(uri) + '"');
        const uint64_t bytes = dataBytes(uri);
        if (length > bytes) failLength(path, "the data URI \"" + shortened(uri) + '"', bytes, length);
        if (length == bytes) return;
        uri.resize(uri.find(',') + 1 + static_cast<size_t>(length * 4 + 2) / 3);
        sources_.hasCut = true;
    }

    void checkName(const std::string& uri, const std::string& path) const {
        const std::string name = unescaped(uri);
        if (name.find("://") != name.npos || !pathInside(folder_, name))
            fail(path, "the file name \"" + shortened(name) + "\" leads out of the asset's folder");
    }

    [[noreturn]] void failLength(const std::string& path, const std::string& source, uint64_t bytes,
                                 uint64_t length) const {
        fail(path + "/byteLength", "is more than " + source + " holds", "at most " + std::to_string(bytes),
             std::to_string(length));
    }
    [[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& expected = {},
                           const std::string& found = {}) const {
        throwBadInput({.what = what, .where = where_ + ": " + path, .expected = expected, .found = found});
    }

    const std::filesystem::path& folder_;
    uint64_t chunkBytes_;
    const std::string& where_;
    Sources sources_;
};

}  // namespace

Sources checkSources(Json& tree, const std::filesystem::path& folder, uint64_t chunkBytes, const std::string& where) {
    SourceChecker checker(folder, chunkBytes, where);
    const auto each = [&](const char* section, const auto& visit) {
        for (size_t i = 0; tree.contains(section) && i < tree[section].size(); ++i) visit(tree[section][i], i);
    };
    each("buffers", [&](Json& buffer, size_t i) { checker.checkBuffer(buffer, i); });
    each("images", [&](const Json& image, size_t i) { checker.checkImage(image, i); });
    return checker.take();
}

std::string shortened(std::string_view uri) { return std::string(uri.substr(0, 40)) + (uri.size() > 40 ? "..." : ""); }

}  // namespace lumi::gltf

#include "scene/gltf/sources.h"

#include <tiny_gltf.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "scene/gltf/json_guard.h"
#include "scene/gltf/uri.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

constexpr const char* kBadCharacter = "the base64 of the data URI has a character that is none";

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
        if (const std::string fault = faultOfName(uri); !fault.empty()) fail(path + "/uri", fault);
        sources_.files.push_back({index, length});
    }

    /// What cannot be read is a fault that is shown in the image's stead.
    void checkImage(Json& image, size_t index) {
        const bool isNamed = image.contains("uri");
        const bool isEmpty = isNamed && image["uri"].get_ref<const std::string&>().empty();
        if (image.contains("bufferView")) {
            if (isNamed && !isEmpty)
                fail("/images/" + std::to_string(index), "has both a uri and a bufferView", "a uri or a bufferView");
            sources_.hasChanged |= image.erase("uri") > 0;
            return;
        }
        std::string fault = !isNamed  ? "has no source, neither a uri nor a bufferView"
                            : isEmpty ? "has no source, its uri is empty"
                                      : faultOfImage(image["uri"].get_ref<std::string&>());
        if (fault.empty()) return;
        image["uri"] = "";
        sources_.imageFaults.push_back({index, std::move(fault)});
        sources_.hasChanged = true;
    }

    Sources take() { return std::move(sources_); }

private:
    void checkData(std::string& uri, uint64_t length, const std::string& path) {
        if (!isKnownData(uri))
            fail(path + "/uri", "a buffer has an unsupported kind of data URI, \"" + shortened(uri) + '"');
        const Base64 data = plainBase64(uri);
        const uint64_t bytes = data.byteCount();
        sources_.hasChanged |= data.hasChanged;
        if (length > bytes && !data.badCharacter.empty())
            fail(path + "/uri", kBadCharacter, "A to Z, a to z, 0 to 9, + and /", data.badCharacter);
        if (length > bytes) failLength(path, "the data URI \"" + shortened(uri) + '"', bytes, length);
        if (length == bytes) return;
        uri.resize(data.begin + static_cast<size_t>(length * 4 + 2) / 3);
        sources_.hasChanged = true;
    }

    /// Why an image's URI is not read, or empty.
    std::string faultOfImage(std::string& uri) {
        if (!isDataUri(uri)) return faultOfName(uri);
        if (!isKnownData(uri)) return {};
        const Base64 data = plainBase64(uri);
        sources_.hasChanged |= data.hasChanged;
        if (!data.badCharacter.empty()) return std::string(kBadCharacter) + ", " + data.badCharacter;
        return data.byteCount() > 0 ? std::string() : "the data URI \"" + shortened(uri) + "\" holds no bytes";
    }

    /// Why a file's name is not followed, or empty.
    std::string faultOfName(const std::string& uri) const {
        const std::string name = unescaped(uri);
        if (name.find("://") == name.npos && pathInside(folder_, name)) return {};
        return "the file name \"" + shortened(name) + "\" leads out of the asset's folder";
    }

    /// Is it base64 that tinygltf reads? It looks for its beginnings anywhere in what it gets.
    static bool isKnownData(const std::string& uri) { return tinygltf::IsDataURI(uri.substr(0, 64)); }

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
    each("images", [&](Json& image, size_t i) { checker.checkImage(image, i); });
    return checker.take();
}

}  // namespace lumi::gltf

#include "scene/gltf/json_guard.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// Bytes of a value in the parser's tree (twice: its arrays grow by doubling), of an object's or array's body, and of
/// a member's key in an object's tree of keys, each with what the allocator adds.
constexpr uint64_t kValueBytes = 2 * sizeof(Json), kBodyBytes = 64, kMemberBytes = 96;

/// Bytes of what tinygltf's model holds for an object this deep in a top-level array: its entries are at 3, what lies
/// in an entry's arrays at 5, morph targets at 7.
uint64_t modelBytes(std::string_view section, int depth) {
    if (depth == 5 && section == "meshes") return sizeof(tinygltf::Primitive);
    if (depth == 7 && section == "meshes") return sizeof(std::map<std::string, int>);
    if (depth == 5 && section == "animations")
        return std::max(sizeof(tinygltf::AnimationChannel), sizeof(tinygltf::AnimationSampler));
    if (depth != 3) return 0;
    if (section == "cameras") return sizeof(tinygltf::Camera);
    if (section == "accessors") return sizeof(tinygltf::Accessor);
    if (section == "bufferViews") return sizeof(tinygltf::BufferView);
    if (section == "images") return sizeof(tinygltf::Image);
    if (section == "materials") return sizeof(tinygltf::Material);
    if (section == "meshes") return sizeof(tinygltf::Mesh);
    return sizeof(tinygltf::Node);
}

/// The object's member if it is there and has such members of its own, else null.
Json* objectIn(Json& object, const char* name) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(name);
    return found != object.end() && found->is_object() ? &*found : nullptr;
}

/// The extension of that name, or null.
Json* extensionIn(Json& object, const char* name) {
    Json* extensions = objectIn(object, "extensions");
    return extensions ? objectIn(*extensions, name) : nullptr;
}

bool isHex(char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; }

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return std::tolower(c); });
    return result;
}

/// Where the base64 begins in a data URI that tinygltf takes for a file, since it does not know the kind; else 0.
size_t otherDataAt(const std::string& uri) {
    if (!isDataUri(uri)) return 0;
    const size_t comma = uri.find(',');
    if (comma == uri.npos) return 0;
    const std::string head = uri.substr(0, comma + 1);
    return lower(head).ends_with(";base64,") && !tinygltf::IsDataURI(head) ? head.size() : 0;
}

/// Of a file's name, whether `at` holds what tinygltf decodes otherwise than RFC 3986: a plus, or a percent sign that
/// escapes nothing.
bool isMisread(std::string_view name, size_t at) {
    const bool escapes = at + 2 < name.size() && isHex(name[at + 1]) && isHex(name[at + 2]);
    return name[at] == '+' || (name[at] == '%' && !escapes);
}

/// Returns whether the URI has changed.
bool makeUriReadable(Json& owner) {
    if (!owner.contains("uri")) return false;
    auto& uri = owner["uri"].get_ref<std::string&>();
    if (const size_t data = otherDataAt(uri); data > 0) {
        uri.replace(0, data, "data:application/octet-stream;base64,");
        return true;
    }
    if (isDataUri(uri)) return false;
    std::string escaped;
    for (size_t at = 0; at < uri.size(); ++at)
        if (isMisread(uri, at)) escaped += uri[at] == '+' ? "%2B" : "%25";
        else escaped += uri[at];
    uri.swap(escaped);
    return uri != escaped;
}

/// Moves the indices of a primitive into an extension.
void moveIndices(Json& primitive, const char* extension) {
    primitive["extensions"][extension]["indices"] = primitive["indices"];
    primitive.erase("indices");
}

/// Bytes beyond ASCII as \xNN: what the parser cites ends where it is no UTF-8.
std::string printable(const std::string& text) {
    std::string shown;
    for (const char c : text)
        if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte >= 0x7f)
            shown += fmt::format("\\x{:02x}", byte);
        else shown += c;
    return shown;
}

/// Follows the parser's events; keeps only what JsonSummary asks for. Every event returns whether to go on.
class Guard final : public nlohmann::json_sax<Json> {
public:
    Guard(std::string_view json, const std::string& where) : json_(json), where_(where) {}
    JsonSummary summary;

    bool null() override { return count(); }
    bool boolean(bool) override { return count(); }
    bool number_integer(number_integer_t) override { return count(); }
    bool number_unsigned(number_unsigned_t) override { return count(); }
    bool number_float(number_float_t, const string_t&) override { return count(); }
    bool string(string_t& value) override {
        if (depth_ == 2 && section_ == "extensionsRequired") summary.requiredExtensions.push_back(value);
        return count(kBodyBytes + value.size());
    }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override {
        enter();
        if (freeDepth_ == 0) summary.treeBytes += 2 * modelBytes(section_, depth_);
        return true;
    }
    bool end_object() override { return leave(); }
    bool start_array(std::size_t) override {
        enter();
        return true;
    }
    bool end_array() override { return leave(); }
    bool key(string_t& value) override {
        if (depth_ == 1) section_ = value;
        if (freeDepth_ == 0 || depth_ == freeDepth_)
            freeDepth_ = value == "extras" || value == "extensions" ? depth_ : 0;
        summary.treeBytes += section_ == "meshes" ? 2 * kMemberBytes : kMemberBytes;  // attributes are kept as maps
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
        const std::string_view before = json_.substr(0, std::min(position > 0 ? position - 1 : 0, json_.size()));
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const size_t lineStart = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
        std::string what = error.what();
        if (const size_t text = what.find("syntax error"); text != what.npos) what = what.substr(text);
        throwBadInput(
            {.what = "not valid JSON: " + printable(what),
             .where = where_ + ":" + std::to_string(line) + ":" + std::to_string(before.size() - lineStart + 1)});
    }

private:
    bool count(uint64_t beyondValue = 0) {
        // What has no fixed form is kept as a tree of tinygltf's own, too.
        summary.treeBytes += kValueBytes + beyondValue + (freeDepth_ > 0 ? 2 * sizeof(tinygltf::Value) : 0);
        return true;
    }
    void enter() {
        if (++depth_ > kMaxJsonDepth)
            throwBadInput({.what = "the JSON is nested too deeply",
                           .where = where_,
                           .expected = "at most " + std::to_string(kMaxJsonDepth) + " levels"});
        count(kBodyBytes);
    }
    bool leave() {
        if (--depth_ < freeDepth_) freeDepth_ = 0;
        return true;
    }

    std::string_view json_;
    const std::string& where_;
    int depth_ = 0;
    int freeDepth_ = 0;  ///< that of the "extras" or "extensions" being read, else 0
    std::string section_;
};

}  // namespace

bool isDataUri(std::string_view uri) { return lower(uri.substr(0, 5)) == "data:"; }

bool makeReadable(Json& tree) {
    bool hasChanged = false;
    const auto each = [](Json& parent, const char* name, const auto& visit) {
        if (parent.contains(name))
            for (Json& entry : parent[name]) visit(entry);
    };
    each(tree, "buffers", [&](Json& buffer) {
        hasChanged |= makeUriReadable(buffer);
        const Json* meshopt = extensionIn(buffer, kMeshopt);
        if (!meshopt || !meshopt->contains("fallback") || (*meshopt)["fallback"] != true) return;
        buffer["uri"] = "data:application/octet-stream;base64,AA==";
        buffer["byteLength"] = 1;
        hasChanged = true;
    });
    each(tree, "images", [&](Json& image) { hasChanged |= makeUriReadable(image); });
    each(tree, "meshes", [&](Json& mesh) {
        each(mesh, "primitives", [&](Json& primitive) {
            if (!primitive.contains("indices")) return;
            const bool isDraco = extensionIn(primitive, kDraco) != nullptr;
            if (!isDraco && tree["accessors"][primitive["indices"].get<size_t>()].contains("bufferView")) return;
            moveIndices(primitive, isDraco ? kDraco : kIndicesAlone);
            hasChanged = true;
        });
    });
    return hasChanged;
}

JsonSummary inspectJson(std::string_view json, const std::string& where) {
    Guard guard(json, where);
    Json::sax_parse(json.begin(), json.end(), &guard);
    return std::move(guard.summary);
}

}  // namespace lumi::gltf

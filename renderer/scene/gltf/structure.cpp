#include "scene/gltf/structure.h"

#include <cmath>
#include <limits>
#include <string_view>

#include "base/error.h"
#include "scene/gltf/json_walk.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

enum class Kind { Object, Text, Word, Whole, Index };
enum class Need { Optional, Required };

constexpr uint64_t kAny = std::numeric_limits<uint64_t>::max();
constexpr uint64_t kMostInt = std::numeric_limits<int>::max();  ///< of what tinygltf keeps as an int

/// What stands at a path, which is a pattern of JsonWalk. What is on the way to it is optional, but of the right type.
struct Rule {
    std::string_view path;
    Kind kind;
    std::string_view of = {};  ///< Word: the words, with '|' between; Index: the section that it counts in
    Need need = Need::Optional;
    uint64_t least = 0, most = kAny, step = 1;  ///< Whole
};

constexpr Rule object(std::string_view path) { return {path, Kind::Object, {}, Need::Required}; }
constexpr Rule text(std::string_view path, Need need = Need::Optional) { return {path, Kind::Text, {}, need}; }
constexpr Rule word(std::string_view path, std::string_view words) { return {path, Kind::Word, words, Need::Required}; }
constexpr Rule whole(std::string_view path, uint64_t least = 0, uint64_t most = kAny, uint64_t step = 1) {
    return {path, Kind::Whole, {}, Need::Optional, least, most, step};
}
constexpr Rule index(std::string_view path, std::string_view section) { return {path, Kind::Index, section}; }
constexpr Rule required(Rule rule) {
    rule.need = Need::Required;
    return rule;
}

constexpr Rule kRules[] = {
    object("asset"),
    text("asset/version", Need::Required),

    object("accessors/[]"),
    object("animations/[]"),
    object("bufferViews/[]"),
    object("buffers/[]"),
    object("cameras/[]"),
    object("images/[]"),
    object("materials/[]"),
    object("meshes/[]"),
    object("nodes/[]"),
    object("samplers/[]"),
    object("scenes/[]"),
    object("skins/[]"),
    object("textures/[]"),

    required(whole("buffers/[]/byteLength", 1)),
    text("buffers/[]/uri"),
    required(index("bufferViews/[]/buffer", "buffers")),
    whole("bufferViews/[]/byteOffset"),
    required(whole("bufferViews/[]/byteLength")),
    whole("bufferViews/[]/byteStride", 0, 252, 4),
    index("bufferViews/[]/extensions/EXT_meshopt_compression/buffer", "buffers"),

    index("accessors/[]/bufferView", "bufferViews"),
    whole("accessors/[]/byteOffset"),
    required(whole("accessors/[]/componentType", 5120, 5130)),
    required(whole("accessors/[]/count")),
    word("accessors/[]/type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4"),
    required(whole("accessors/[]/sparse/count", 0, kMostInt)),
    object("accessors/[]/sparse/indices"),
    required(index("accessors/[]/sparse/indices/bufferView", "bufferViews")),
    whole("accessors/[]/sparse/indices/byteOffset", 0, kMostInt),
    required(whole("accessors/[]/sparse/indices/componentType", 0, kMostInt)),
    object("accessors/[]/sparse/values"),
    required(index("accessors/[]/sparse/values/bufferView", "bufferViews")),
    whole("accessors/[]/sparse/values/byteOffset", 0, kMostInt),

    text("images/[]/uri"),
    index("images/[]/bufferView", "bufferViews"),
    whole("samplers/[]/magFilter", 0, kMostInt),
    whole("samplers/[]/minFilter", 0, kMostInt),
    whole("samplers/[]/wrapS", 0, kMostInt),
    whole("samplers/[]/wrapT", 0, kMostInt),
    index("textures/[]/source", "images"),
    index("textures/[]/sampler", "samplers"),
    required(index("materials/[]/*Texture/index", "textures")),
    required(index("materials/[]/pbrMetallicRoughness/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_anisotropy/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_clearcoat/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_iridescence/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_pbrSpecularGlossiness/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_sheen/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_specular/*Texture/index", "textures")),
    required(index("materials/[]/extensions/KHR_materials_transmission/*Texture/index", "textures")),

    object("meshes/[]/primitives/[]/attributes"),
    index("meshes/[]/primitives/[]/attributes/{}", "accessors"),
    index("meshes/[]/primitives/[]/indices", "accessors"),
    index("meshes/[]/primitives/[]/material", "materials"),
    whole("meshes/[]/primitives/[]/mode", 0, 6),
    index("meshes/[]/primitives/[]/targets/[]/{}", "accessors"),
    index("meshes/[]/primitives/[]/extensions/KHR_draco_mesh_compression/bufferView", "bufferViews"),

    word("cameras/[]/type", "perspective|orthographic"),
    index("skins/[]/inverseBindMatrices", "accessors"),
    index("skins/[]/skeleton", "nodes"),
    index("skins/[]/joints/[]", "nodes"),
    index("nodes/[]/mesh", "meshes"),
    index("nodes/[]/skin", "skins"),
    index("nodes/[]/camera", "cameras"),
    index("nodes/[]/children/[]", "nodes"),
    index("nodes/[]/extensions/EXT_mesh_gpu_instancing/attributes/{}", "accessors"),
    required(whole("nodes/[]/extensions/KHR_lights_punctual/light", 0, kMostInt)),
    index("scenes/[]/nodes/[]", "nodes"),
    index("scene", "scenes"),

    required(index("animations/[]/samplers/[]/input", "accessors")),
    required(index("animations/[]/samplers/[]/output", "accessors")),
    required(whole("animations/[]/channels/[]/sampler", 0, kMostInt)),
    object("animations/[]/channels/[]/target"),
    index("animations/[]/channels/[]/target/node", "nodes"),
};

/// The words with commas between.
std::string listed(std::string_view words) {
    std::string list;
    for (const char c : words)
        if (c == '|') list += ", ";
        else list += c;
    return list;
}

class Checker final : JsonWalk {
public:
    Checker(Json& tree, const std::string& where) : tree_(tree), where_(where) {}

    void check(const Rule& rule) {
        rule_ = &rule;
        count_ = 0;
        if (rule.kind == Kind::Index && tree_.is_object())
            if (const auto section = tree_.find(rule.of); section != tree_.end() && section->is_array())
                count_ = section->size();
        walk(tree_, rule.path);
    }
    bool hasRewritten() const { return hasRewritten_; }

private:
    void onMissing() override {
        if (rule_->need == Need::Required) fail("is missing", expected(), {});
    }
    void onOtherType(const Json& value, const char* expected) override {
        fail("has the wrong type", expected, shown(value));
    }
    void onValue(Json& value) override {
        switch (rule_->kind) {
            case Kind::Object:
                if (!value.is_object()) fail("has the wrong type", expected(), shown(value));
                return;
            case Kind::Text:
                if (!value.is_string()) fail("has the wrong type", expected(), shown(value));
                return;
            case Kind::Word: return checkWord(value);
            case Kind::Whole: return checkWhole(value);
            case Kind::Index: return checkIndex(value);
        }
    }

    void checkWord(const Json& value) const {
        std::string_view words = rule_->of;
        for (size_t bar = 0; value.is_string() && bar != words.npos; words.remove_prefix(bar + 1)) {
            bar = words.find('|');
            if (words.substr(0, bar) == value.get_ref<const std::string&>()) return;
            if (bar == words.npos) break;
        }
        fail("is none of those that there are", expected(), shown(value));
    }

    void checkWhole(Json& value) {
        makeWhole(value);
        const uint64_t number = value.is_number_unsigned() ? value.get<uint64_t>() : 0;
        if (!value.is_number()) fail("has the wrong type", expected(), shown(value));
        if (!value.is_number_unsigned() || number < rule_->least || number > rule_->most || number % rule_->step != 0)
            fail("is out of range", expected(), shown(value));
    }

    void checkIndex(Json& value) {
        makeWhole(value);
        if (!value.is_number()) fail("has the wrong type", expected(), shown(value));
        if (!value.is_number_unsigned() || value.get<uint64_t>() >= count_)
            fail("no such entry in /" + std::string(rule_->of), expected(), shown(value));
    }

    /// 4.0 is 4; beyond 2^53, numbers with a fraction have none.
    void makeWhole(Json& value) {
        if (!value.is_number_float()) return;
        const double number = value.get<double>();
        if (!(number >= 0 && number <= 9007199254740992.0) || number != std::floor(number)) return;
        value = static_cast<uint64_t>(number);
        hasRewritten_ = true;
    }

    std::string expected() const {
        const Rule& rule = *rule_;
        switch (rule.kind) {
            case Kind::Object: return "an object";
            case Kind::Text: return "a string";
            case Kind::Word: return listed(rule.of);
            case Kind::Index: return expectedIndex(count_, std::string(rule.of));
            case Kind::Whole: break;
        }
        const std::string number = rule.step > 1 ? "a multiple of " + std::to_string(rule.step) : "a whole number";
        if (rule.most < kMostInt)
            return number + " from " + std::to_string(rule.least) + " to " + std::to_string(rule.most);
        return number + ", at least " + std::to_string(rule.least);
    }

    [[noreturn]] void fail(const std::string& what, const std::string& expected, const std::string& found) const {
        throwBadInput({.what = what, .where = where_ + ": " + path(), .expected = expected, .found = found});
    }

    Json& tree_;
    const std::string& where_;
    const Rule* rule_ = nullptr;
    size_t count_ = 0;  ///< Index: of the section's entries
    bool hasRewritten_ = false;
};

}  // namespace

bool checkStructure(Json& tree, const std::string& where) {
    Checker checker(tree, where);
    for (const Rule& rule : kRules) checker.check(rule);
    return checker.hasRewritten();
}

std::string expectedIndex(size_t count, const std::string& collection) {
    return count == 0 ? "none, since there are no " + collection : "0 to " + std::to_string(count - 1);
}

}  // namespace lumi::gltf

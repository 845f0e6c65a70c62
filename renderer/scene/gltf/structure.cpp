#include "scene/gltf/structure.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "base/error.h"
#include "scene/gltf/json_walk.h"
#include "scene/gltf/structure_table.h"

namespace lumi::gltf {
namespace {

using Json = nlohmann::json;

/// The words with commas between.
std::string listed(std::string_view words) {
    std::string list;
    for (const char c : words)
        if (c == '|') list += ", ";
        else list += c;
    return list;
}

bool isAmong(std::string_view words, std::string_view wanted) {
    for (size_t bar = 0; bar != words.npos; words.remove_prefix(bar == words.npos ? 0 : bar + 1)) {
        bar = words.find('|');
        if (words.substr(0, bar) == wanted) return true;
    }
    return false;
}

/// The largest unsigned number, which would compare as equal, is none.
bool isMinusOne(const Json& value) { return value.is_number() && !value.is_number_unsigned() && value == -1; }

/// The rules and their patterns.
struct RuleSet {
    std::vector<Rule> rules;
    JsonPatterns patterns;

    void add(const Rule& rule, const std::string& place) {
        patterns.add(place + std::string(rule.path), rules.size());
        rules.push_back(rule);
    }
};

RuleSet setOf(std::span<const Rule> rules) {
    RuleSet set;
    for (const Rule& rule : rules) set.add(rule, "");
    return set;
}

const RuleSet& assetSet() {
    static const RuleSet set = setOf(assetRules());
    return set;
}

const RuleSet& formSet() {
    static const RuleSet set = setOf(formRules());
    return set;
}

const RuleSet& ruleSet() {
    static const RuleSet set = [] {
        RuleSet made = setOf(rules());
        for (const std::string_view texture : texturePaths())
            for (const Rule& rule : textureRules()) made.add(rule, "materials/[]/" + std::string(texture));
        return made;
    }();
    return set;
}

class Checker final : JsonWalk {
public:
    Checker(Json& tree, const std::string& where) : tree_(tree), where_(where) {}

    void check(const RuleSet& set) {
        set_ = &set;
        counts_.clear();
        for (const Rule& rule : set.rules) counts_.push_back(rule.kind == Kind::Index ? entriesOf(rule.of) : 0);
        walk(tree_, set.patterns);
    }

    /// glTF: any 2.x may be read by who knows 2.0, unless minVersion asks for more.
    void checkVersion() const {
        const Json& asset = tree_["asset"];
        const auto refuse = [&](const std::string& name, const char* what, const char* expected) {
            const std::string found = asset[name].get<std::string>().substr(0, 40);
            throwBadInput(
                {.what = what, .where = where_ + ": /asset/" + name, .expected = expected, .found = '"' + found + '"'});
        };
        if (!asset["version"].get_ref<const std::string&>().starts_with("2."))
            refuse("version", "not a version of glTF that is read", "\"2.0\" or another of 2.x");
        const auto least = asset.find("minVersion");
        if (least != asset.end() && least->is_string() && *least != "" && *least != "2.0")
            refuse("minVersion", "the file requires a newer version of glTF", "\"2.0\"");
    }

    void warnOfAbsent(FileWarnings& warnings) const {
        if (absent_ == 0) return;
        const std::string more = absent_ == 2  ? ", as in 1 more place"
                                 : absent_ > 2 ? ", as in " + std::to_string(absent_ - 1) + " more places"
                                               : "";
        warnings.warn(firstAbsent_ + " is read as absent" + more);
    }
    bool hasChanged() const { return hasRewritten_ || absent_ > 0; }

private:
    size_t entriesOf(std::string_view section) const {
        const Json::json_pointer pointer("/" + std::string(section));
        return tree_.is_object() && tree_.contains(pointer) && tree_[pointer].is_array() ? tree_[pointer].size() : 0;
    }

    void onMissing(size_t number) override {
        if (set_->rules[number].need == Need::Required) fail("is missing", expected(number), {});
    }

    Seen onOtherType(const Json& value, const char* expected) override {
        // Some write an empty array for an object without members.
        const bool isExtension = name() == "extensions" || name(1) == "extensions";
        if (!name().empty() && (value.is_null() || (isExtension && value.is_array() && value.empty())))
            return absent(value);
        fail("has the wrong type", expected, shown(value));
    }

    Seen onValue(size_t number, Json& value) override {
        const Rule& rule = set_->rules[number];
        if (isAbsent(rule, value)) return absent(value);
        switch (rule.kind) {
            case Kind::Object: expectType(value.is_object(), number, value); break;
            case Kind::Array: expectType(value.is_array(), number, value); break;
            case Kind::Text: expectType(value.is_string(), number, value); break;
            case Kind::Number: expectType(value.is_number(), number, value); break;
            case Kind::Numbers: checkNumbers(number, value); break;
            case Kind::Whole: checkWhole(number, value); break;
            case Kind::Index: checkIndex(number, value); break;
            case Kind::Typed: checkTyped(rule, value); break;
            case Kind::Texture: return checkTexture(value);
            case Kind::Code:
                makeWhole(value);
                expectType(value.is_number(), number, value);
                if (!isAmong(rule.of, shown(value)))
                    fail("is none of those that there are", expected(number), shown(value));
                break;
            case Kind::Word:
                if (!value.is_string() || !isAmong(rule.of, value.get_ref<const std::string&>()))
                    fail("is none of those that there are", expected(number), shown(value));
                break;
        }
        return Seen::Stays;
    }

    bool isAbsent(const Rule& rule, const Json& value) const {
        if (rule.need == Need::Required || name().empty()) return false;
        if (value.is_null()) return true;
        if (rule.kind == Kind::Numbers) return value.is_array() && value.empty();
        if (rule.kind != Kind::Index) return rule.orMinusOne && isMinusOne(value);
        if (rule.path == "scene" && entriesOf(rule.of) == 0) return wholeNumber(value) == 0;
        // Members of attributes whose names are not glTF's may be anything.
        const bool isForeign = rule.path.ends_with("{}") && !std::isupper(static_cast<unsigned char>(name().front()));
        const auto isEntry = [&] {
            const std::optional<uint64_t> number = wholeNumber(value);
            return number && *number < entriesOf(rule.of);
        };
        return isMinusOne(value) || (isForeign && !isEntry());
    }

    Seen absent(const Json& value, const std::string& inside = {}) {
        const bool isEmpty = value.is_array() && value.empty();
        if (absent_++ == 0) firstAbsent_ = path() + inside + ": " + (isEmpty ? "an empty array" : shown(value));
        return Seen::IsAbsent;
    }

    void expectType(bool isRight, size_t number, const Json& value) const {
        if (!isRight) fail("has the wrong type", expected(number), shown(value));
    }

    void checkNumbers(size_t number, const Json& value) const {
        expectType(value.is_array(), number, value);
        for (size_t i = 0; i < value.size(); ++i)
            if (!value[i].is_number()) fail("has the wrong type", "a number", shown(value[i]), "/" + std::to_string(i));
        if (const uint64_t count = set_->rules[number].most; value.size() != count)
            fail("has the wrong length", std::to_string(count), std::to_string(value.size()));
    }

    void checkWhole(size_t number, Json& value) {
        const Rule& rule = set_->rules[number];
        makeWhole(value);
        const uint64_t given = value.is_number_unsigned() ? value.get<uint64_t>() : 0;
        expectType(value.is_number(), number, value);
        if (!value.is_number_unsigned() || given < rule.least || given > rule.most || given % rule.step != 0)
            fail("is out of range", expected(number), shown(value));
    }

    void checkIndex(size_t number, Json& value) {
        makeWhole(value);
        expectType(value.is_number(), number, value);
        if (!value.is_number_unsigned() || value.get<uint64_t>() >= counts_[number])
            fail("no such entry in /" + std::string(set_->rules[number].of), expected(number), shown(value));
    }

    void checkTyped(const Rule& rule, Json& value) const {
        const auto& type = value["type"].get_ref<const std::string&>();
        for (std::string_view words = rule.of; !words.empty();) {
            const std::string word(words.substr(0, words.find('|')));
            words.remove_prefix(std::min(word.size() + 1, words.size()));
            const auto member = value.find(word);
            if (word != type) value.erase(word);
            else if (member == value.end()) fail("is missing", "an object", {}, "/" + word);
            else if (!member->is_object()) fail("has the wrong type", "an object", shown(*member), "/" + word);
        }
    }

    Seen checkTexture(const Json& value) {
        if (!value.is_object()) return onOtherType(value, "an object");
        const auto index = value.find("index");
        if (index == value.end() || !(index->is_null() || isMinusOne(*index))) return Seen::Stays;
        return absent(*index, "/index");
    }

    void makeWhole(Json& value) {
        if (value.is_number_unsigned()) return;
        const std::optional<uint64_t> number = wholeNumber(value);
        if (!number) return;
        value = *number;
        hasRewritten_ = true;
    }

    std::string expected(size_t number) const {
        const Rule& rule = set_->rules[number];
        switch (rule.kind) {
            case Kind::Object:
            case Kind::Texture:
            case Kind::Typed: return "an object";
            case Kind::Array: return "an array";
            case Kind::Text: return "a string";
            case Kind::Number: return "a number";
            case Kind::Numbers: return std::to_string(rule.most) + " numbers";
            case Kind::Code:
            case Kind::Word: return listed(rule.of);
            case Kind::Index: return expectedIndex(counts_[number], std::string(rule.of));
            case Kind::Whole: break;
        }
        const std::string what = rule.step > 1 ? "a multiple of " + std::to_string(rule.step) : "a whole number";
        if (rule.most < kMostInt)
            return what + " from " + std::to_string(rule.least) + " to " + std::to_string(rule.most);
        return what + ", at least " + std::to_string(rule.least);
    }

    [[noreturn]] void fail(const std::string& what, const std::string& expected, const std::string& found,
                           const std::string& inside = {}) const {
        throwBadInput({.what = what, .where = where_ + ": " + path() + inside, .expected = expected, .found = found});
    }

    Json& tree_;
    const std::string& where_;
    const RuleSet* set_ = nullptr;
    std::vector<size_t> counts_;  ///< Index: of the section's entries, by rule
    bool hasRewritten_ = false;
    size_t absent_ = 0;  ///< members that are read as absent
    std::string firstAbsent_;
};

}  // namespace

bool checkStructure(Json& tree, FileWarnings& warnings) {
    Checker checker(tree, warnings.file());
    checker.check(assetSet());
    checker.checkVersion();
    checker.check(formSet());
    checker.check(ruleSet());
    checker.warnOfAbsent(warnings);
    return checker.hasChanged();
}

std::string expectedIndex(size_t count, const std::string& collection) {
    return count == 0 ? "none, since there are no " + collection : "0 to " + std::to_string(count - 1);
}

}  // namespace lumi::gltf

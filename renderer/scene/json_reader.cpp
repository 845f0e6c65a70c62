#include "scene/json_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace lumi {
namespace {

/// Longer lists are shortened: nobody reads a hundred names in an error.
constexpr size_t kMaxListed = 24;

const ParameterInfo* findInfo(const std::vector<ParameterInfo>& declared, const std::string& id) {
    for (const ParameterInfo& info : declared)
        if (info.id == id) return &info;
    return nullptr;
}

std::string rangeText(double min, double max) {
    if (std::isinf(max)) return std::isinf(min) ? "a number" : fmt::format("at least {:g}", min);
    return fmt::format("{:g} to {:g}", min, max);
}

/// The JSON value as the type that `info` declares; refuses other types.
ParameterValue parameterValue(const ParameterInfo& info, const JsonTree& tree, const JsonValue& value) {
    switch (info.type) {
        case ParameterType::Number:
            if (!value.isNumber()) refuseValue(tree, value, info.id, "a number");
            readNumber(tree, value, info.id, info.min, info.max);
            return static_cast<float>(value.number);
        case ParameterType::Integer:
            if (!value.isNumber() || value.number != std::floor(value.number))
                refuseValue(tree, value, info.id, "a whole number");
            readNumber(tree, value, info.id, info.min, info.max);
            return static_cast<int>(value.number);
        case ParameterType::Toggle:
            if (value.type != JsonValue::Type::Boolean) refuseValue(tree, value, info.id, "true or false");
            return value.boolean;
        case ParameterType::Colour:
            if (value.isNumber()) return Vec3(static_cast<float>(readNumber(tree, value, info.id, info.min, info.max)));
            return readVector(tree, value, info.id);
        case ParameterType::Vector: return readVector(tree, value, info.id);
        case ParameterType::Choice:
            if (!value.isString() ||
                std::find(info.options.begin(), info.options.end(), value.text) == info.options.end())
                refuseValue(tree, value, info.id, quotedList(info.options));
            return value.text;
        case ParameterType::Text: return readText(tree, value, info.id);
    }
    return value.text;
}

}  // namespace

std::string quotedList(const std::vector<std::string>& names) {
    std::string list;
    for (size_t i = 0; i < std::min(names.size(), kMaxListed); ++i) {
        if (i > 0) list += i + 1 == names.size() ? " or " : ", ";
        list += '"' + names[i] + '"';
    }
    return names.size() > kMaxListed ? list + ", ..." : list;
}

void refuseValue(const JsonTree& tree, const JsonValue& value, const std::string& name, const std::string& expected) {
    throwBadInput({fmt::format("\"{}\" is {}", name, value.shown()), tree.where(value.at), expected, ""});
}

void refuseName(const JsonTree& tree, const TextPosition& at, const std::string& kind, const std::string& name,
                const std::vector<std::string>& candidates) {
    const std::string near = nearestName(name, candidates);
    std::string expected = "one of " + quotedList(candidates);
    if (candidates.empty()) expected = "none, for none is defined";
    else if (!near.empty() || candidates.size() == 1) expected = '"' + (near.empty() ? candidates[0] : near) + '"';
    throwBadInput({fmt::format("unknown {} \"{}\"", kind, name), tree.where(at), expected, ""});
}

std::string readText(const JsonTree& tree, const JsonValue& value, const std::string& name) {
    if (!value.isString()) refuseValue(tree, value, name, "text in quotes");
    if (value.text.find('\0') != std::string::npos)
        throwBadInput({fmt::format("\"{}\" holds a NUL character", name), tree.where(value.at), "", ""});
    return value.text;
}

double readNumber(const JsonTree& tree, const JsonValue& value, const std::string& name, double min, double max) {
    if (!value.isNumber()) refuseValue(tree, value, name, "a number");
    // Limits may be floats: 0.1f is a little above 0.1. Values are kept as floats, so they must fit one.
    if (value.number < min - 1e-6 * std::abs(min) || value.number > max + 1e-6 * std::abs(max))
        refuseValue(tree, value, name, rangeText(min, max));
    if (std::abs(value.number) > 3.4e38) refuseValue(tree, value, name, "at most 3.4e38");
    return value.number;
}

Vec3 readVector(const JsonTree& tree, const JsonValue& value, const std::string& name) {
    if (!value.isArray() || value.items.size() != 3) refuseValue(tree, value, name, "three numbers");
    Vec3 v(0);
    for (int c = 0; c < 3; ++c) {
        const JsonValue& item = value.items[static_cast<size_t>(c)];
        if (!item.isNumber()) refuseValue(tree, item, fmt::format("{}[{}]", name, c), "a number");
        v[c] = static_cast<float>(readNumber(tree, item, fmt::format("{}[{}]", name, c), -1e9, 1e9));
    }
    return v;
}

void setParameterFromJson(const Describe& describe, const ParameterInfo& info, const JsonTree& tree,
                          const JsonValue& value) {
    const ParameterValue parsed = parameterValue(info, tree, value);
    const std::string where = tree.where(value.at);
    try {
        setParameter(describe, info.id, parsed, where);
    } catch (const Error& error) {
        // In a file a value out of range is bad input, and reads as it is written there.
        throwBadInput({fmt::format("\"{}\" is {}", info.id, value.isArray() ? formatParameter(parsed) : value.shown()),
                       where, error.text().expected, ""});
    }
}

ObjectReader::ObjectReader(const JsonTree& tree, const JsonValue& value, std::string name)
    : tree_(tree), value_(value), name_(std::move(name)) {
    if (!value.isObject()) refuseValue(tree, value, name_, "an object");
}

void ObjectReader::fail(const TextPosition& at, const std::string& what, const std::string& expected,
                        const std::string& found) const {
    throwBadInput({what, tree_.where(at), expected, found});
}

const JsonValue* ObjectReader::find(const char* key) {
    known_.insert(key);
    for (const JsonMember& member : value_.members)
        if (member.key == key) {
            taken_.insert(key);
            return &member.value;
        }
    return nullptr;
}

const JsonValue& ObjectReader::need(const char* key) {
    const JsonValue* value = find(key);
    if (!value) {
        // A misspelt key is the likelier fault, and says more.
        for (const JsonMember& member : value_.members)
            if (!taken_.contains(member.key) && !nearestName(member.key, std::vector<std::string>{key}).empty())
                refuseName(tree_, member.at, "key", member.key, {key});
        fail(value_.at, fmt::format("\"{}\" has no \"{}\"", name_, key));
    }
    return *value;
}

std::optional<std::string> ObjectReader::text(const char* key) {
    const JsonValue* value = find(key);
    return value ? std::optional(readText(tree_, *value, key)) : std::nullopt;
}

std::optional<double> ObjectReader::number(const char* key, double min, double max) {
    const JsonValue* value = find(key);
    return value ? std::optional(readNumber(tree_, *value, key, min, max)) : std::nullopt;
}

std::optional<int> ObjectReader::integer(const char* key, int min, int max) {
    const JsonValue* value = find(key);
    if (!value) return std::nullopt;
    if (!value->isNumber() || value->number != std::floor(value->number))
        refuseValue(tree_, *value, key, "a whole number");
    return static_cast<int>(readNumber(tree_, *value, key, min, max));
}

std::optional<bool> ObjectReader::toggle(const char* key) {
    const JsonValue* value = find(key);
    if (!value) return std::nullopt;
    if (value->type != JsonValue::Type::Boolean) refuseValue(tree_, *value, key, "true or false");
    return value->boolean;
}

std::optional<Vec3> ObjectReader::vector(const char* key) {
    const JsonValue* value = find(key);
    return value ? std::optional(readVector(tree_, *value, key)) : std::nullopt;
}

std::optional<Vec2> ObjectReader::pair(const char* key, double min, double max) {
    const JsonValue* value = find(key);
    if (!value) return std::nullopt;
    if (!value->isArray() || value->items.size() != 2) refuseValue(tree_, *value, key, "two numbers");
    return Vec2(readNumber(tree_, value->items[0], fmt::format("{}[0]", key), min, max),
                readNumber(tree_, value->items[1], fmt::format("{}[1]", key), min, max));
}

void ObjectReader::setSize(const Describe& describe, const std::vector<ParameterInfo>& declared,
                           const JsonValue& size) {
    std::vector<const ParameterInfo*> sides;
    for (const char* id : {"width", "height", "depth"})
        if (const ParameterInfo* info = findInfo(declared, id)) sides.push_back(info);
    if (!size.isArray() || size.items.size() != sides.size())
        refuseValue(tree_, size, "size", sides.size() == 3 ? "three numbers" : "two numbers");
    for (size_t i = 0; i < sides.size(); ++i) setParameterFromJson(describe, *sides[i], tree_, size.items[i]);
}

void ObjectReader::parameters(const Describe& describe, const std::set<std::string>& only,
                              const std::set<std::string>& except) {
    const std::vector<ParameterInfo> declared = listParameters(describe);
    const auto belongs = [&](const std::string& id) {
        return (only.empty() || only.contains(id)) && !except.contains(id);
    };
    // Whole sizes first, so that a single side may refine them.
    const bool hasSize = findInfo(declared, "width") && findInfo(declared, "height") && !findInfo(declared, "size");
    if (hasSize && belongs("width") && belongs("height"))
        if (const JsonValue* size = find("size")) setSize(describe, declared, *size);
    for (const ParameterInfo& info : declared) {
        if (!belongs(info.id) || known_.contains(info.id)) continue;
        if (const JsonValue* value = find(info.id.c_str())) setParameterFromJson(describe, info, tree_, *value);
    }
}

void ObjectReader::finish() const {
    for (const JsonMember& member : value_.members)
        if (!taken_.contains(member.key))
            refuseName(tree_, member.at, "key", member.key, {known_.begin(), known_.end()});
}

}  // namespace lumi

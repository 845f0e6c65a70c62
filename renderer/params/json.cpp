#include "params/json.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lumi {
using nlohmann::json;

namespace {

/// The float as the double that people write: 0.1, not 0.10000000149011612. Reads back as the same float.
double written(float value) {
    if (!std::isfinite(value)) return value;
    const std::string text = fmt::format("{}", value);
    double shortest = value;
    std::from_chars(text.data(), text.data() + text.size(), shortest);
    return static_cast<float>(shortest) == value ? shortest : value;
}

}  // namespace

json toJson(const ParameterValue& value) {
    struct Writer {
        json operator()(bool v) const { return v; }
        json operator()(int v) const { return v; }
        json operator()(float v) const { return written(v); }
        json operator()(const Vec3& v) const { return json::array({written(v.x), written(v.y), written(v.z)}); }
        json operator()(const std::string& v) const { return v; }
    };
    return std::visit(Writer{}, value);
}

ParameterValue parameterFromJson(const ParameterInfo& info, const json& j, const std::string& where) {
    const auto refuse = [&](const char* expected) {
        throwUsage({fmt::format("\"{}\" has the wrong type", info.id), where, expected, j.dump()});
    };
    switch (info.type) {
        case ParameterType::Number:
            if (!j.is_number()) refuse("a number");
            return j.get<float>();
        case ParameterType::Integer:
            if (!j.is_number_integer() || (j.is_number_unsigned() && j.get<uint64_t>() > INT32_MAX) ||
                j.get<int64_t>() < INT32_MIN)
                refuse("a whole number of 32 bits");
            return j.get<int>();
        case ParameterType::Toggle:
            if (!j.is_boolean()) refuse("true or false");
            return j.get<bool>();
        case ParameterType::Colour:
        case ParameterType::Vector:
            if (!j.is_array() || j.size() != 3 || !j[0].is_number() || !j[1].is_number() || !j[2].is_number())
                refuse("three numbers");
            return Vec3(j[0].get<float>(), j[1].get<float>(), j[2].get<float>());
        case ParameterType::Choice:
        case ParameterType::Text:
            if (!j.is_string()) refuse("text");
            break;
    }
    return j.get<std::string>();
}

json toJson(const ParameterInfo& info) {
    static const char* types[] = {"number", "integer", "toggle", "choice", "colour", "vector", "text"};
    static const char* redos[] = {"display", "filter", "history", "samples", "build"};
    json j = {{"id", info.id},
              {"title", info.label},
              {"type", types[static_cast<int>(info.type)]},
              {"default", toJson(info.value)},
              {"help", info.help},
              {"redo", redos[static_cast<int>(info.redo)]}};
    if (!info.unit.empty()) j["unit"] = info.unit;
    if (info.type == ParameterType::Number || info.type == ParameterType::Integer) {
        j["min"] = info.min;
        j["max"] = info.max;
        j["scale"] = info.scale == Scale::Log ? "log" : "linear";
    }
    if (info.type == ParameterType::Choice) j["options"] = info.options;
    return j;
}

}  // namespace lumi

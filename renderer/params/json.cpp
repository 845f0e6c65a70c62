#include "params/json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"

namespace lumi {
using nlohmann::json;

json toJson(const ParameterValue& value) {
    struct Writer {
        json operator()(bool v) const { return v; }
        json operator()(int v) const { return v; }
        json operator()(float v) const { return v; }
        json operator()(const Vec3& v) const { return json::array({v.x, v.y, v.z}); }
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
            if (!j.is_number_integer()) refuse("a whole number");
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

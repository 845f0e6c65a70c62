#include "scene/gltf/json_walk.h"

namespace lumi::gltf {

using Json = nlohmann::json;

void JsonWalk::walk(Json& value, std::string_view pattern) {
    if (pattern.empty()) return onValue(value);
    const size_t slash = pattern.find('/');
    const std::string_view name = pattern.substr(0, slash);
    const std::string_view rest = slash == pattern.npos ? std::string_view() : pattern.substr(slash + 1);
    if (name == "[]") {
        if (!value.is_array()) return onOtherType(value, "an array");
        for (size_t i = 0; i < value.size(); ++i) into(value[i], {{}, i}, rest);
        return;
    }
    if (!value.is_object()) return onOtherType(value, "an object");
    if (name == "{}" || name.front() == '*') {
        const std::string_view ending = name == "{}" ? std::string_view() : name.substr(1);
        for (auto member = value.begin(); member != value.end(); ++member)
            if (member.key().ends_with(ending)) into(*member, {member.key()}, rest);
    } else if (const auto member = value.find(name); member != value.end()) {
        into(*member, {name}, rest);
    } else if (rest.empty()) {
        steps_.push_back({name});
        onMissing();
        steps_.pop_back();
    }
}

void JsonWalk::into(Json& value, const Step& step, std::string_view pattern) {
    steps_.push_back(step);
    walk(value, pattern);
    steps_.pop_back();
}

std::string JsonWalk::path() const {
    std::string path = steps_.empty() ? "/" : "";
    for (const Step& step : steps_)
        path += "/" + (step.name.data() ? std::string(step.name.substr(0, 60)) : std::to_string(step.entry));
    return path;
}

std::string shown(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array";
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
}

}  // namespace lumi::gltf

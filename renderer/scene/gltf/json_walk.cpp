#include "scene/gltf/json_walk.h"

#include <algorithm>
#include <cmath>

namespace lumi::gltf {

using Json = nlohmann::json;

void JsonPatterns::add(std::string_view pattern, size_t number) {
    Place* place = &root_;
    while (!pattern.empty()) {
        const size_t slash = std::min(pattern.find('/'), pattern.size());
        const std::string_view name = pattern.substr(0, slash);
        pattern.remove_prefix(std::min(slash + 1, pattern.size()));
        auto found = std::find_if(place->inside.begin(), place->inside.end(),
                                  [&](const Place& inner) { return inner.name == name; });
        if (found == place->inside.end()) found = place->inside.insert(found, Place{std::string(name), kNone, {}});
        place = &*found;
    }
    place->number = number;
}

void JsonWalk::walk(Json& tree, const JsonPatterns& patterns) {
    steps_.clear();
    visit(tree, patterns.root());
}

JsonWalk::Seen JsonWalk::visit(Json& value, const JsonPatterns::Place& place) {
    if (place.number != JsonPatterns::kNone && onValue(place.number, value) == Seen::IsAbsent) return Seen::IsAbsent;
    if (place.inside.empty()) return Seen::Stays;
    if (place.inside.front().name == "[]") {
        if (!value.is_array()) return onOtherType(value, "an array");
        for (size_t i = 0; i < value.size(); ++i) into(value[i], {{}, i}, place.inside.front());
        return Seen::Stays;
    }
    if (!value.is_object()) return onOtherType(value, "an object");
    visitMembers(value, place);
    return Seen::Stays;
}

void JsonWalk::visitMembers(Json& object, const JsonPatterns::Place& place) {
    for (const JsonPatterns::Place& inner : place.inside) {
        if (inner.name == "{}") {
            for (auto member = object.begin(); member != object.end();)
                if (into(*member, {member.key()}, inner) == Seen::IsAbsent) member = object.erase(member);
                else ++member;
        } else if (const auto member = object.find(inner.name); member != object.end()) {
            if (into(*member, {inner.name}, inner) == Seen::IsAbsent) object.erase(member);
        } else if (inner.number != JsonPatterns::kNone) {
            steps_.push_back({inner.name});
            onMissing(inner.number);
            steps_.pop_back();
        }
    }
}

JsonWalk::Seen JsonWalk::into(Json& value, const Step& step, const JsonPatterns::Place& place) {
    steps_.push_back(step);
    const Seen seen = visit(value, place);
    steps_.pop_back();
    return seen;
}

std::string JsonWalk::path() const {
    std::string path = steps_.empty() ? "/" : "";
    for (const Step& step : steps_)
        path += "/" + (step.name.data() ? std::string(step.name.substr(0, 60)) : std::to_string(step.entry));
    return path;
}

std::string_view JsonWalk::name(size_t above) const {
    return above < steps_.size() ? steps_[steps_.size() - 1 - above].name : std::string_view();
}

std::string shown(const Json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array";
    const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
}

std::optional<uint64_t> wholeNumber(const Json& value) {
    if (value.is_number_unsigned()) return value.get<uint64_t>();
    if (!value.is_number()) return std::nullopt;
    const double number = value.get<double>();
    if (!(number >= 0 && number <= 9007199254740992.0) || number != std::floor(number)) return std::nullopt;
    return static_cast<uint64_t>(number);
}

}  // namespace lumi::gltf

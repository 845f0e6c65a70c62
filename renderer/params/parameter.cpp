#include "params/parameter.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace lumi {
namespace {

/// Turns each declaration into a ParameterInfo and hands it, with a setter, to a function.
class InfoVisitor : public ParameterVisitor {
public:
    using Setter = std::function<void(const ParameterValue&)>;
    using Receiver = std::function<void(ParameterInfo&&, const Setter&)>;
    explicit InfoVisitor(Receiver receiver) : receiver_(std::move(receiver)) {}

    void number(const char* id, float& value, const NumberSpec& spec) override {
        report(id, ParameterType::Number, spec, value, [&](const ParameterValue& v) {
            value = std::holds_alternative<int>(v) ? static_cast<float>(std::get<int>(v)) : std::get<float>(v);
        });
    }
    void integer(const char* id, int& value, const NumberSpec& spec) override {
        report(id, ParameterType::Integer, spec, value, [&](const ParameterValue& v) { value = std::get<int>(v); });
    }
    void toggle(const char* id, bool& value, const SwitchSpec& spec) override {
        ParameterInfo info = basic(id, ParameterType::Toggle, spec.label, spec.help, spec.redo);
        info.value = value;
        receiver_(std::move(info), [&](const ParameterValue& v) { value = std::get<bool>(v); });
    }
    void choiceIndex(const char* id, int& value, const ChoiceSpec& spec) override {
        ParameterInfo info = basic(id, ParameterType::Choice, spec.label, spec.help, spec.redo);
        info.options.assign(spec.options.begin(), spec.options.end());
        info.value = info.options.at(static_cast<size_t>(value));
        const std::vector<std::string> options = info.options;
        receiver_(std::move(info), [&](const ParameterValue& v) {
            for (size_t i = 0; i < options.size(); ++i)
                if (options[i] == std::get<std::string>(v)) value = static_cast<int>(i);
        });
    }
    void colour(const char* id, Vec3& value, const ColourSpec& spec) override {
        ParameterInfo info = basic(id, ParameterType::Colour, spec.label, spec.help, spec.redo);
        info.max = spec.max;
        info.value = value;
        receiver_(std::move(info), [&](const ParameterValue& v) { value = std::get<Vec3>(v); });
    }
    void vector(const char* id, Vec3& value, const VectorSpec& spec) override {
        ParameterInfo info = basic(id, ParameterType::Vector, spec.label, spec.help, spec.redo);
        info.unit = spec.unit;
        info.min = -1e6, info.max = 1e6;
        info.value = value;
        receiver_(std::move(info), [&](const ParameterValue& v) { value = std::get<Vec3>(v); });
    }
    void text(const char* id, std::string& value, const TextSpec& spec) override {
        ParameterInfo info = basic(id, ParameterType::Text, spec.label, spec.help, spec.redo);
        info.value = value;
        receiver_(std::move(info), [&](const ParameterValue& v) { value = std::get<std::string>(v); });
    }

private:
    ParameterInfo basic(const char* id, ParameterType type, const char* label, const char* help, Redo redo) const {
        ParameterInfo info;
        info.id = id;
        info.type = type;
        info.label = label;
        info.help = help;
        info.redo = redo;
        info.active = active();
        return info;
    }
    template <class T>
    void report(const char* id, ParameterType type, const NumberSpec& spec, T value, const Setter& setter) {
        ParameterInfo info = basic(id, type, spec.label, spec.help, spec.redo);
        info.min = spec.min, info.max = spec.max, info.scale = spec.scale, info.unit = spec.unit;
        info.value = value;
        receiver_(std::move(info), setter);
    }
    Receiver receiver_;
};

std::string rangeText(const ParameterInfo& info) { return fmt::format("{:g} to {:g}", info.min, info.max); }

bool inRange(double x, const ParameterInfo& info) {
    // Floats are declared with double limits: 0.1 as float is a little above 0.1.
    return x >= info.min - 1e-6 * std::abs(info.min) && x <= info.max + 1e-6 * std::abs(info.max);
}

std::string joined(const std::vector<std::string>& names) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// Throws unless `value` fits the declaration.
void check(const ParameterInfo& info, const ParameterValue& value, const std::string& where) {
    const auto refuse = [&](const std::string& what, const std::string& expected) {
        throwUsage({fmt::format("\"{}\" {}", info.id, what), where, expected, formatParameter(value)});
    };
    switch (info.type) {
        case ParameterType::Number:
        case ParameterType::Integer: {
            double x = 0;
            if (const int* i = std::get_if<int>(&value)) x = *i;
            else if (const float* f = std::get_if<float>(&value); f && info.type == ParameterType::Number) x = *f;
            else refuse("has the wrong type", info.type == ParameterType::Integer ? "a whole number" : "a number");
            if (!inRange(x, info)) refuse("is out of range", rangeText(info));
            break;
        }
        case ParameterType::Toggle:
            if (!std::holds_alternative<bool>(value)) refuse("has the wrong type", "true or false");
            break;
        case ParameterType::Choice: {
            const std::string* name = std::get_if<std::string>(&value);
            bool known = false;
            for (const std::string& option : info.options) known = known || (name && *name == option);
            if (!known) refuse("is not one of its choices", joined(info.options));
            break;
        }
        case ParameterType::Colour:
        case ParameterType::Vector: {
            const Vec3* v = std::get_if<Vec3>(&value);
            if (!v) refuse("has the wrong type", "three numbers");
            for (int c = 0; c < 3; ++c)
                if (!inRange((*v)[c], info)) refuse("is out of range", rangeText(info) + " for each of three");
            break;
        }
        case ParameterType::Text:
            if (!std::holds_alternative<std::string>(value)) refuse("has the wrong type", "text");
            break;
    }
}

[[noreturn]] void throwUnknown(const Describe& describe, std::string_view id, const std::string& where) {
    std::vector<std::string> ids;
    for (const ParameterInfo& info : listParameters(describe)) ids.push_back(info.id);
    const std::string near = nearestName(std::string(id), ids);
    throwUsage({fmt::format("unknown parameter \"{}\"", id), where,
                near.empty() ? "one of " + joined(ids) : '"' + near + '"', ""});
}

float parseFloat(const std::string& text, const ParameterInfo& info, const std::string& where) {
    float value = 0;
    const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
    const auto [end, code] = std::from_chars(begin, text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throwUsage({fmt::format("\"{}\" is not a number", info.id), where, "a number", '"' + text + '"'});
    return value;
}

}  // namespace

std::vector<ParameterInfo> listParameters(const Describe& describe) {
    std::vector<ParameterInfo> list;
    InfoVisitor visitor([&](ParameterInfo&& info, const InfoVisitor::Setter&) { list.push_back(std::move(info)); });
    describe(visitor);
    return list;
}

ParameterValue getParameter(const Describe& describe, std::string_view id) {
    for (ParameterInfo& info : listParameters(describe))
        if (info.id == id) return std::move(info.value);
    throwUnknown(describe, id, "");
}

Redo setParameter(const Describe& describe, std::string_view id, const ParameterValue& value,
                  const std::string& where) {
    bool found = false;
    Redo redo = Redo::Display;
    InfoVisitor visitor([&](ParameterInfo&& info, const InfoVisitor::Setter& setter) {
        if (found || info.id != id) return;
        check(info, value, where);
        setter(value);
        redo = info.redo;
        found = true;
    });
    describe(visitor);
    if (!found) throwUnknown(describe, id, where);
    return redo;
}

std::string formatParameter(const ParameterValue& value) {
    struct Formatter {
        std::string operator()(bool v) const { return v ? "true" : "false"; }
        std::string operator()(int v) const { return fmt::format("{}", v); }
        std::string operator()(float v) const { return fmt::format("{}", v); }
        std::string operator()(const Vec3& v) const { return fmt::format("{},{},{}", v.x, v.y, v.z); }
        std::string operator()(const std::string& v) const { return v; }
    };
    return std::visit(Formatter{}, value);
}

ParameterValue parseParameter(const ParameterInfo& info, const std::string& text, const std::string& where) {
    switch (info.type) {
        case ParameterType::Number: return parseFloat(text, info, where);
        case ParameterType::Integer: {
            // Exactly if it is written as a whole number; "1e3" by way of a float.
            int exact = 0;
            const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-');
            const auto [end, code] = std::from_chars(begin, text.data() + text.size(), exact);
            if (code == std::errc() && end == text.data() + text.size()) return exact;
            const float value = parseFloat(text, info, where);
            if (value != std::floor(value) || std::abs(value) > 2e9f)
                throwUsage({fmt::format("\"{}\" has the wrong type", info.id), where, "a whole number", text});
            return static_cast<int>(value);
        }
        case ParameterType::Toggle:
            if (text == "true" || text == "on" || text == "1") return true;
            if (text == "false" || text == "off" || text == "0") return false;
            throwUsage({fmt::format("\"{}\" has the wrong type", info.id), where, "true or false", '"' + text + '"'});
        case ParameterType::Colour:
        case ParameterType::Vector: {
            Vec3 v(0);
            size_t begin = 0;
            int count = 0;
            for (; count < 3 && begin <= text.size(); ++count) {
                const size_t comma = std::min(text.find(',', begin), text.size());
                v[count] = parseFloat(text.substr(begin, comma - begin), info, where);
                begin = comma + 1;
            }
            if (count == 1) return Vec3(v.x);
            if (count != 3 || begin <= text.size())
                throwUsage({fmt::format("\"{}\" has the wrong type", info.id), where, "three numbers", text});
            return v;
        }
        case ParameterType::Choice:
        case ParameterType::Text: break;
    }
    return text;
}

}  // namespace lumi

#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// What a change of a parameter invalidates. Each includes what stands before it in this list.
enum class Redo {
    Display,  ///< only how the finished image is shown
    Filter,   ///< run() again on the same signals and the same history
    History,  ///< the module's history no longer fits
    Samples,  ///< new signals are traced
    Build     ///< the scene is posed or built again
};

enum class Scale { Linear, Log };  ///< of a slider; a logarithmic one may begin at 0, for an "off" or "none"

/// How a parameter presents itself, written once where it is declared. Text follows the paper: name its equation.
struct NumberSpec {
    const char* label;        ///< "Colour alpha"
    double min = 0, max = 1;  ///< closed range; values outside are refused, not clamped
    Scale scale = Scale::Linear;
    const char* unit = "";  ///< "m", "deg", "px", "EV"; empty for pure numbers
    const char* help;       ///< one sentence
    Redo redo = Redo::Filter;
};
struct SwitchSpec {
    const char* label;
    const char* help;
    Redo redo = Redo::Filter;
};
struct ChoiceSpec {
    const char* label;
    std::vector<const char*> options;  ///< kebab-case names, in the order of the enum's values
    const char* help;
    Redo redo = Redo::Filter;
};
struct ColourSpec {
    const char* label;
    double max = 1;  ///< of each channel; min is 0
    const char* help;
    Redo redo = Redo::Samples;
};
struct VectorSpec {
    const char* label;
    const char* unit = "m";
    const char* help;
    Redo redo = Redo::Samples;
};
struct TextSpec {
    const char* label;
    const char* help;
    Redo redo = Redo::Build;
};

/// Receives each tunable of an object, once. An object declares its parameters in one function,
///     void describe(ParameterVisitor& v) { v.number("alpha", alpha, {.label = "Alpha", ..., .help = "... (eq. 1)"}); }
/// and panels, JSON, the command line, help texts and tests follow from that.
class ParameterVisitor {
public:
    virtual ~ParameterVisitor() = default;
    virtual void number(const char* id, float& value, const NumberSpec&) = 0;
    virtual void integer(const char* id, int& value, const NumberSpec&) = 0;
    virtual void toggle(const char* id, bool& value, const SwitchSpec&) = 0;
    virtual void choiceIndex(const char* id, int& value, const ChoiceSpec&) = 0;
    virtual void colour(const char* id, Vec3& value, const ColourSpec&) = 0;
    virtual void vector(const char* id, Vec3& value, const VectorSpec&) = 0;
    virtual void text(const char* id, std::string& value, const TextSpec&) = 0;

    template <class Enum>
    void choice(const char* id, Enum& value, const ChoiceSpec& spec) {
        int index = static_cast<int>(value);
        choiceIndex(id, index, spec);
        value = static_cast<Enum>(index);
    }

    /// Parameters declared inside `body` matter only while `condition` holds: panels hide them, tests meet it first.
    /// `body` is run in any case, so that values are kept, saved and set whatever the order.
    void when(bool condition, const std::function<void()>& body) {
        conditions_.push_back(condition && (conditions_.empty() || conditions_.back()));
        body();
        conditions_.pop_back();
    }
    bool active() const { return conditions_.empty() || conditions_.back(); }

private:
    std::vector<bool> conditions_;
};

/// A value as it stands in JSON, on the command line and in undo lists. Choices are their option's name (string).
using ParameterValue = std::variant<bool, int, float, Vec3, std::string>;

enum class ParameterType { Number, Integer, Toggle, Choice, Colour, Vector, Text };

/// One parameter of a described object, by value: for tables, help, JSON and tests.
struct ParameterInfo {
    std::string id;
    ParameterType type = ParameterType::Number;
    std::string label, unit, help;
    double min = 0, max = 0;
    Scale scale = Scale::Linear;
    Redo redo = Redo::Filter;
    std::vector<std::string> options;
    bool active = true;    ///< its `when` holds at present
    ParameterValue value;  ///< at present
};

using Describe = std::function<void(ParameterVisitor&)>;

/// Everything an object declares, with present values, in order of declaration.
std::vector<ParameterInfo> listParameters(const Describe& describe);

/// The present value of `id`. Throws Error(Usage) naming the nearest id.
ParameterValue getParameter(const Describe& describe, std::string_view id);

/// Sets `id` and returns what that invalidates. Throws Error(Usage) for an unknown id, a wrong type or a value out of
/// range; `where` heads the message ("--set", "atrium.json:12:9"). An int is accepted where a number is declared.
Redo setParameter(const Describe& describe, std::string_view id, const ParameterValue& value,
                  const std::string& where = "");

/// Text forms, as on the command line: `0.2`, `true`, `on`, `off`, `per-pixel`, `1,0.5,0` (colours and vectors; one
/// number stands for all three). parseParameter reads with the type that `id` has.
std::string formatParameter(const ParameterValue& value);
ParameterValue parseParameter(const ParameterInfo& info, const std::string& text, const std::string& where = "");

}  // namespace lumi

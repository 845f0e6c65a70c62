#pragma once
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "params/parameter.h"
#include "scene/json_tree.h"

namespace lumi {

/// Reads one JSON object by key. A key that nobody asked for is an error when the reading is finished, and names the
/// nearest key that somebody did ask for. All errors are Error(BadInput) headed by file:line:column.
class ObjectReader {
public:
    /// `name` stands for the object in messages: "instances", "lamp". Throws unless `value` is an object.
    ObjectReader(const JsonTree& tree, const JsonValue& value, std::string name);

    const std::string& name() const { return name_; }
    const JsonTree& tree() const { return tree_; }
    const JsonValue& value() const { return value_; }

    /// The member's value, or null; the key counts as known from here on.
    const JsonValue* find(const char* key);
    /// As find(), but throws if the key is missing.
    const JsonValue& need(const char* key);

    /// Typed look-ups: empty when the key is absent.
    std::optional<std::string> text(const char* key);
    std::optional<double> number(const char* key, double min, double max);
    std::optional<int> integer(const char* key, int min, int max);
    std::optional<bool> toggle(const char* key);
    std::optional<Vec3> vector(const char* key);
    std::optional<Vec2> pair(const char* key, double min, double max);

    /// Sets every member that `describe` declares and nobody asked for yet. Colours also take one number, and
    /// "size": [w, h] or [w, h, d] stands for the declared width, height and depth. `only`, if not empty, limits this
    /// to the ids it names; `except` leaves ids out.
    void parameters(const Describe& describe, const std::set<std::string>& only = {},
                    const std::set<std::string>& except = {});

    /// Throws if a member was never asked for.
    void finish() const;

    [[noreturn]] void fail(const TextPosition& at, const std::string& what, const std::string& expected = {},
                           const std::string& found = {}) const;

private:
    void setSize(const Describe& describe, const std::vector<ParameterInfo>& declared, const JsonValue& size);

    const JsonTree& tree_;
    const JsonValue& value_;
    std::string name_;
    std::set<std::string> known_;  ///< keys that may stand here
    std::set<std::string> taken_;  ///< keys that were read
};

/// The conversions behind the look-ups above, for values that stand in arrays. `name` heads the message.
std::string readText(const JsonTree&, const JsonValue&, const std::string& name);
double readNumber(const JsonTree&, const JsonValue&, const std::string& name, double min, double max);
Vec3 readVector(const JsonTree&, const JsonValue&, const std::string& name);

/// `"name" is <shown>; expected <expected>` at the value's place.
[[noreturn]] void refuseValue(const JsonTree&, const JsonValue&, const std::string& name, const std::string& expected);

/// Sets one declared parameter from JSON; messages as above.
void setParameterFromJson(const Describe& describe, const ParameterInfo& info, const JsonTree&, const JsonValue&);

/// `"a", "b" or "c"`.
std::string quotedList(const std::vector<std::string>& names);

/// Throws `unknown <kind> "<name>"; expected "<nearest>"` (or the list, or "none is defined").
[[noreturn]] void refuseName(const JsonTree&, const TextPosition&, const std::string& kind, const std::string& name,
                             const std::vector<std::string>& candidates);

}  // namespace lumi

#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// Patterns of places in a tree of JSON, each with a number: "nodes/[]/mesh", where "[]" is each entry of an array and
/// "{}" each member of an object. They are held as a tree of their own, so that one walk serves all of them.
class JsonPatterns {
public:
    static constexpr size_t kNone = static_cast<size_t>(-1);
    struct Place {
        std::string name;
        size_t number = kNone;  ///< of the pattern that ends here
        std::vector<Place> inside;
    };

    void add(std::string_view pattern, size_t number);
    const Place& root() const { return root_; }

private:
    Place root_;
};

/// Goes to all that stands at patterns in a tree of JSON, in time proportional to what there is: to a value before what
/// is inside, else in the order of the patterns. What a handler calls absent is erased from its object.
class JsonWalk {
public:
    virtual ~JsonWalk() = default;

protected:
    enum class Seen { Stays, IsAbsent };

    void walk(nlohmann::json& tree, const JsonPatterns& patterns);
    /// Where the walk is: "/nodes/3/mesh".
    std::string path() const;
    /// The name of the member that the walk is at, or of the object `above` it; empty for an array's entry.
    std::string_view name(size_t above = 0) const;

    virtual Seen onValue(size_t number, nlohmann::json& value) = 0;
    /// An object has no member of the pattern's last name.
    virtual void onMissing(size_t) {}
    /// What patterns go through is not `expected`: "an array", "an object".
    virtual Seen onOtherType(const nlohmann::json& value, const char* expected) = 0;

private:
    /// A member's name, or an array's entry.
    struct Step {
        std::string_view name;
        size_t entry = 0;
    };
    Seen visit(nlohmann::json& value, const JsonPatterns::Place& place);
    void visitMembers(nlohmann::json& object, const JsonPatterns::Place& place);
    Seen into(nlohmann::json& value, const Step& step, const JsonPatterns::Place& place);

    std::vector<Step> steps_;
};

/// A value in a message: the beginning of a long one, the type of what has parts.
std::string shown(const nlohmann::json& value);

/// A number from 0 without a fraction, however it is written: 4, 4.0, -0. Beyond 2^53, those with a point have none.
std::optional<uint64_t> wholeNumber(const nlohmann::json& value);

}  // namespace lumi::gltf

#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace lumi::gltf {

/// Goes to all that stands at a pattern in a tree of JSON, in time proportional to what there is. In a pattern,
/// "nodes/[]/mesh", "[]" is each entry of an array, "{}" each member of an object, "*Name" each member whose name ends
/// so.
class JsonWalk {
public:
    virtual ~JsonWalk() = default;

protected:
    void walk(nlohmann::json& tree, std::string_view pattern);
    /// Where the walk is: "/nodes/3/mesh".
    std::string path() const;

    virtual void onValue(nlohmann::json& value) = 0;
    /// An object has no member of the pattern's last name.
    virtual void onMissing() {}
    /// What the pattern goes through is not `expected`: "an array", "an object".
    virtual void onOtherType(const nlohmann::json& value, const char* expected) = 0;

private:
    /// A member's name, or an array's entry.
    struct Step {
        std::string_view name;
        size_t entry = 0;
    };
    void into(nlohmann::json& value, const Step& step, std::string_view pattern);

    std::vector<Step> steps_;
};

/// A value in a message: the beginning of a long one, the type of what has parts.
std::string shown(const nlohmann::json& value);

}  // namespace lumi::gltf

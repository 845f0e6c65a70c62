#pragma once
#include <optional>
#include <string>
#include <vector>

#include "math/vector.h"

namespace lumi {

/// Where the items of one frame are, by the name a script clicks them with ("Exposure", "buffer:albedo").
class UiMap {
public:
    struct Item {
        std::string name;
        Vec2 lower{0}, upper{0};  ///< framebuffer pixels, the visible part
        Vec2 centre() const { return 0.5f * (lower + upper); }
    };

    void setEnabled(bool on) { enabled_ = on; }
    bool enabled() const { return enabled_; }
    void clear() { items_.clear(); }
    void add(std::string name, Vec2 lower, Vec2 upper) { items_.push_back({std::move(name), lower, upper}); }
    const std::vector<Item>& items() const { return items_; }
    /// The last item of that name, since what is drawn last is on top.
    std::optional<Item> find(const std::string& name) const;
    /// `{"items": [{"name", "x", "y", "width", "height"}]}`.
    std::string json() const;

private:
    bool enabled_ = false;
    std::vector<Item> items_;
};

}  // namespace lumi

#include "ui/ui_map.h"
#include "params/json_text.h"

#include <nlohmann/json.hpp>

namespace lumi {

std::optional<UiMap::Item> UiMap::find(const std::string& name) const {
    for (auto item = items_.rbegin(); item != items_.rend(); ++item)
        if (item->name == name) return *item;
    return std::nullopt;
}

std::string UiMap::json() const {
    nlohmann::json list = nlohmann::json::array();
    for (const Item& item : items_)
        list.push_back({{"name", item.name},
                        {"x", item.lower.x},
                        {"y", item.lower.y},
                        {"width", item.upper.x - item.lower.x},
                        {"height", item.upper.y - item.lower.y}});
    return jsonText(nlohmann::json{{"items", list}}, 1);
}

}  // namespace lumi

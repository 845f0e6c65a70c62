#include "ui/context.h"

namespace lumi {

void markRect(const std::string& name, ImVec2 lower, ImVec2 upper) {
    UiMap& map = ui().map;
    if (!map.enabled()) return;
    const ImRect clip = ImGui::GetCurrentWindow()->ClipRect;
    const ImVec2 low = ImMax(lower, clip.Min), high = ImMin(upper, clip.Max);
    if (low.x < high.x && low.y < high.y) map.add(name, {low.x, low.y}, {high.x, high.y});
}

void markItem(const std::string& name) {
    if (ui().map.enabled()) markRect(name, ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
}

}  // namespace lumi

#include <fmt/format.h>

#include "ui/parameter_widgets.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr const char* kPopup = "buffers";

void drawRow(AppState& state, int pane, const BufferEntry& entry, size_t index, bool& chosen) {
    const bool now = state.buffer(pane) == entry.name;
    ImGui::PushID(entry.name.c_str());
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::Selectable("##row", now, 0, ImVec2(width, px(24)))) {
        state.setOnce(state.viewId(pane, "buffer"), entry.name);
        chosen = true;
    }
    markItem("buffer:" + entry.name);
    if (ImGui::IsItemHovered()) tooltip(entry.name, entry.help + (entry.unit.empty() ? "" : "\nUnit: " + entry.unit));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = std::floor(corner.y + 0.5f * (px(24) - ImGui::GetFontSize()));
    list.AddText(ImVec2(corner.x + px(10), y), now ? palette::kAccent : palette::kText, entry.name.c_str());
    const WithFont small(ui().fonts.small);
    const std::string right = entry.channels + (index < 9 ? fmt::format("    {}", index + 1) : "     ");
    list.AddText(ImVec2(corner.x + width - ImGui::CalcTextSize(right.c_str()).x - px(8), y + px(1)), palette::kFaint,
                 right.c_str());
    ImGui::PopID();
}

}  // namespace

void openBufferPicker(int pane) {
    ImGui::OpenPopup(kPopup);
    ImGui::GetStateStorage()->SetBool(ImGui::GetID("fresh"), true);
}

void drawBufferPicker(AppState& state, int pane) {
    const ImGuiID freshId = ImGui::GetID("fresh");
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    ImGui::SetNextWindowSize(ImVec2(px(320), px(440)));
    if (!ImGui::BeginPopup(kPopup)) return;
    static std::string search;  // of the one picker that can be open
    if (storage.GetBool(freshId)) {
        search.clear();
        ImGui::SetKeyboardFocusHere();
        storage.SetBool(freshId, false);
    }
    searchField("buffer-search", search, "Search buffers");
    const bool enter = ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(static_cast<int>(Key::Enter), false);
    ImGui::BeginChild("list", ImVec2(0, 0));
    const std::vector<BufferEntry>& entries = state.buffers(pane);
    std::string group;
    bool chosen = false, first = true;
    for (size_t i = 0; i < entries.size(); ++i) {
        const BufferEntry& entry = entries[i];
        if (!search.empty() && !matches(search, entry.name) && !matches(search, entry.group)) continue;
        if (entry.group != group) {
            group = entry.group;
            ImGui::Dummy(ImVec2(0, px(2)));
            smallText(group, palette::kFaint);
        }
        if (enter && first) {
            state.setOnce(state.viewId(pane, "buffer"), entry.name);
            chosen = true;
        }
        first = false;
        drawRow(state, pane, entry, i, chosen);
    }
    if (first) dimText("No buffer of that name.");
    ImGui::EndChild();
    if (chosen) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

}  // namespace lumi

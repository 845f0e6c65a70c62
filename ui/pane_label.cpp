#include <fmt/format.h>

#include <algorithm>

#include "reconstruct/catalog.h"
#include "ui/parameter_widgets.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kHeight = 28;

/// A part of the label that opens something: text and a chevron.
bool chip(const std::string& name, const std::string& text, bool strong) {
    const WithFont font(strong ? ui().fonts.strong : ui().fonts.body);
    const ImVec2 size(ImGui::CalcTextSize(text.c_str()).x + px(34), px(kHeight));
    const bool clicked = ImGui::InvisibleButton(name.c_str(), size);
    markItem(name);
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered()) list.AddRectFilled(box.Min, box.Max, IM_COL32(255, 255, 255, 26), px(5));
    list.AddText(ImVec2(box.Min.x + px(10), std::floor(box.GetCenter().y - 0.5f * ImGui::GetFontSize())),
                 palette::kText, text.c_str());
    drawIcon(list, Icon::Chevron, ImVec2(box.Max.x - px(14), box.GetCenter().y), px(10), palette::kDim);
    return clicked;
}

/// What stands behind the chips: the session's own words, less the module's name, which is in a chip already.
std::string details(const PaneSnapshot& shown) {
    std::string text = shown.label;
    if (text.compare(0, shown.module.size(), shown.module) == 0) text.erase(0, shown.module.size());
    while (!text.empty() && (text.front() == ',' || text.front() == ' ')) text.erase(0, 1);
    const std::string buffer = shown.buffer + ", ";
    if (text.compare(0, buffer.size(), buffer) == 0) text.erase(0, buffer.size());
    return text;
}

void drawModulePopup(AppState& state, int pane) {
    if (!ImGui::BeginPopup("modules")) return;
    smallText("Module");
    const std::string now = state.module(pane);
    float width = px(230);
    for (const ModuleEntry& entry : moduleCatalog()) width = std::max(width, ImGui::CalcTextSize(entry.title).x);
    for (const ModuleEntry& entry : moduleCatalog()) {
        if (ImGui::Selectable(fmt::format("{}##{}", entry.title, entry.id).c_str(), now == entry.id, 0,
                              ImVec2(width, 0)))
            state.setOnce(state.viewId(pane, "module"), std::string(entry.id));
        markItem(std::string("module:") + entry.id);
        if (ImGui::IsItemHovered())
            tooltip(entry.id, entry.paper && *entry.paper ? std::string("Paper: ") + entry.paper : "");
    }
    ImGui::EndPopup();
}

}  // namespace

void drawPaneLabel(AppState& state, int pane, const ImRect& rect, bool alignRight) {
    const PaneSnapshot* shown = state.pane(pane);
    if (!state.document.present() || (state.uiHidden && state.paneCount() == 1)) return;
    const std::string module = state.module(pane), buffer = state.buffer(pane);
    std::string words = shown ? details(*shown) : std::string();
    if (shown && shown->info.nonFinite > 0) words += fmt::format(" · {} pixels not finite", shown->info.nonFinite);
    if (shown && shown->droppedPixels > 0)
        words += fmt::format(" · {} pixels dropped, not finite", shown->droppedPixels);

    if (state.showsReference()) words = "reference, " + state.metrics.reference().name;
    else if (state.shownMap(pane)) words = "error: " + state.errorMap;

    float fixed = px(34) * 2 + px(30);
    {
        const WithFont strong(ui().fonts.strong);
        fixed += ImGui::CalcTextSize(module.c_str()).x;
    }
    fixed += ImGui::CalcTextSize(buffer.c_str()).x;
    const bool lettered = state.paneCount() > 1;
    if (lettered) fixed += px(28);
    {
        const WithFont small(ui().fonts.small);
        const float share = state.layout() == Layout::Wipe ? 0.5f : 1.0f;  // the two labels lie in one rectangle
        const float room = rect.GetWidth() * share - fixed - px(24);
        words = room < px(40) ? std::string() : elided(words, room);
        fixed += ImGui::CalcTextSize(words.c_str()).x;
    }
    const ImVec2 corner(alignRight ? rect.Max.x - fixed - px(12) : rect.Min.x + px(12), rect.Min.y + px(12));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(fixed, px(kHeight)), palette::kOverlay, px(6));
    const bool active = lettered && pane == state.activePane;
    if (active)
        list.AddRect(corner, corner + ImVec2(fixed, px(kHeight)), withAlpha(palette::kAccent, 0.8f), px(6), 0, px(1));

    ImGui::PushID(pane);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    ImGui::SetCursorScreenPos(corner);
    if (lettered) {
        if (ImGui::InvisibleButton("letter", ImVec2(px(28), px(kHeight)))) state.activePane = pane;
        markItem(fmt::format("pane:{}", pane));
        const WithFont strong(ui().fonts.strong);
        list.AddText(corner + ImVec2(px(11), px(6)), active ? palette::kAccent : palette::kDim, pane == 0 ? "A" : "B");
        ImGui::SameLine();
    }
    const auto openAt = [&](const char* popup) {
        state.activePane = pane;
        ImGui::OpenPopup(popup);
    };
    if (chip(fmt::format("chip:{}:module", pane), module, true)) openAt("modules");
    ImGui::SameLine();
    if (chip(fmt::format("chip:{}:buffer", pane), buffer, false)) openBufferPicker(pane);
    if (state.bufferPickerWanted && state.activePane == pane) openBufferPicker(pane);
    if (state.modulePickerWanted && state.activePane == pane) ImGui::OpenPopup("modules");
    {
        const WithFont small(ui().fonts.small);
        const ImVec2 at(corner.x + fixed - ImGui::CalcTextSize(words.c_str()).x - px(14),
                        std::floor(corner.y + 0.5f * (px(kHeight) - ImGui::GetFontSize())));
        list.AddText(at, palette::kDim, words.c_str());
    }
    ImGui::PopStyleVar();
    ImGui::SetNextWindowPos(corner + ImVec2(0, px(kHeight + 4)));
    drawModulePopup(state, pane);
    ImGui::SetNextWindowPos(corner + ImVec2(0, px(kHeight + 4)));
    drawBufferPicker(state, pane);
    ImGui::PopID();
    if (pane + 1 == state.paneCount()) state.bufferPickerWanted = state.modulePickerWanted = false;
}

}  // namespace lumi

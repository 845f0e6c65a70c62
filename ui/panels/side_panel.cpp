#include <algorithm>
#include <iterator>

#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr const char* kTabs[] = {"View", "Render", "Scene", "Measure", "Profile"};

void drawTabs(AppState& state, const ImRect& area) {
    const float height = px(40);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float x = area.Min.x + px(8);
    const WithFont font(ui().fonts.strong);
    float texts = 0;
    for (const char* tab : kTabs) texts += ImGui::CalcTextSize(tab).x;
    const float pad = std::clamp((area.GetWidth() - px(16) - texts) / (2 * std::size(kTabs)), px(3), px(10));
    for (int i = 0; i < static_cast<int>(std::size(kTabs)); ++i) {
        const float width = ImGui::CalcTextSize(kTabs[i]).x + 2 * pad;
        ImGui::SetCursorScreenPos(ImVec2(x, area.Min.y));
        if (ImGui::InvisibleButton(kTabs[i], ImVec2(width, height))) state.tab = static_cast<PanelTab>(i);
        markItem(std::string("tab:") + kTabs[i]);
        const bool on = static_cast<int>(state.tab) == i;
        const ImU32 colour = on                       ? palette::kText
                             : ImGui::IsItemHovered() ? IM_COL32(190, 193, 200, 255)
                                                      : palette::kFaint;
        list.AddText(ImVec2(x + pad, std::floor(area.Min.y + 0.5f * (height - ImGui::GetFontSize()))), colour,
                     kTabs[i]);
        if (on)
            list.AddRectFilled(ImVec2(x + pad, area.Min.y + height - px(3)),
                               ImVec2(x + width - pad, area.Min.y + height - px(1)), palette::kAccent, px(1));
        x += width;
    }
    list.AddLine(ImVec2(area.Min.x, area.Min.y + height - 0.5f), ImVec2(area.Max.x, area.Min.y + height - 0.5f),
                 palette::kBorder);
    ImGui::SetCursorScreenPos(ImVec2(area.Min.x, area.Min.y + height));
}

}  // namespace

void drawSidePanel(AppState& state, const ImRect& area) {
    beginFixed("side", area, palette::kPanel, ImVec2(0, 0));
    ImGui::GetWindowDrawList()->AddLine(ImVec2(area.Min.x + 0.5f, area.Min.y), ImVec2(area.Min.x + 0.5f, area.Max.y),
                                        palette::kBorder);
    drawTabs(state, area);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(16), px(8)));
    ImGui::BeginChild(kTabs[static_cast<int>(state.tab)], ImVec2(0, 0), false, ImGuiWindowFlags_AlwaysUseWindowPadding);
    ImGui::PopStyleVar();
    if (!state.document.present()) dimText("No scene is open.");
    else switch (state.tab) {
            case PanelTab::View: drawViewPanel(state); break;
            case PanelTab::Render: drawRenderPanel(state); break;
            case PanelTab::Scene: drawScenePanel(state); break;
            case PanelTab::Measure: drawMeasurePanel(state); break;
            case PanelTab::Profile: drawProfilePanel(state); break;
        }
    ImGui::Dummy(ImVec2(0, px(12)));
    ImGui::EndChild();
    endFixed();
}

}  // namespace lumi

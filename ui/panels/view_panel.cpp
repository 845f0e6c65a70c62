#include <fmt/format.h>

#include "ui/commands.h"
#include "ui/inspector.h"
#include "ui/panels/panels.h"
#include "ui/parameter_widgets.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

/// Which pane the settings below belong to.
void drawPaneChoice(AppState& state) {
    if (state.paneCount() < 2) return;
    const std::string a = fmt::format("A   {}", state.buffer(0)), b = fmt::format("B   {}", state.buffer(1));
    const int clicked = segments("pane-choice", {a.c_str(), b.c_str()}, state.activePane);
    if (clicked >= 0) state.activePane = clicked;
    ImGui::Dummy(ImVec2(0, px(2)));
}

/// Looks like a choice and opens the picker of the pane's label.
bool pickerRow(const char* name, const char* label, const std::string& value) {
    const float available = ImGui::GetContentRegionAvail().x, labelWidth = std::floor(kLabelShare * available);
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size(available - labelWidth - px(24), ImGui::GetFrameHeight());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float textY = std::floor(0.5f * (size.y - ImGui::GetFontSize()));
    list.AddText(corner + ImVec2(0, textY), palette::kDim, label);
    ImGui::SetCursorScreenPos(corner + ImVec2(labelWidth, 0));
    const bool clicked = ImGui::InvisibleButton(name, size);
    markItem(name);
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    list.AddRectFilled(box.Min, box.Max, ImGui::IsItemHovered() ? palette::kHovered : palette::kRaised, px(4));
    list.AddText(box.Min + ImVec2(px(8), textY), palette::kText, elided(value, size.x - px(32)).c_str());
    drawIcon(list, Icon::Chevron, ImVec2(box.Max.x - px(13), box.GetCenter().y), px(9), palette::kDim);
    ImGui::SetCursorScreenPos(corner + ImVec2(0, size.y + ImGui::GetStyle().ItemSpacing.y));
    return clicked;
}

void drawZoom(AppState& state) {
    const float zoom = state.view.zoom();
    smallText(zoom >= 1 ? fmt::format("Zoom {:.4g} : 1", zoom) : fmt::format("Zoom 1 : {:.3g}", 1 / zoom));
    ImGui::SameLine(ImGui::GetContentRegionMax().x - px(76));
    if (iconButton("fit", Icon::Fit, tipFor("Fit the picture", UiCommand::Fit), state.view.fits(), 24))
        runCommand(state, UiCommand::Fit);
    ImGui::SameLine(0, px(4));
    if (iconButton("loupe", Icon::Loupe, tipFor("Loupe under the pointer", UiCommand::Loupe), state.loupe, 24))
        runCommand(state, UiCommand::Loupe);
}

}  // namespace

void drawViewPanel(AppState& state) {
    drawPaneChoice(state);
    if (pickerRow("pick-module", "Method", state.module(state.activePane))) state.modulePickerWanted = true;
    if (pickerRow("pick-buffer", "Buffer", state.buffer(state.activePane))) state.bufferPickerWanted = true;
    if (section("Display")) {
        const std::string prefix = state.viewId(state.activePane, "");
        parameterRows(state, prefix, "", {prefix + "module", prefix + "buffer"});
        drawZoom(state);
    }
    if (section("Pixel")) drawInspector(state);
}

}  // namespace lumi

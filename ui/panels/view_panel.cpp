#include <fmt/format.h>

#include <algorithm>
#include <set>

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

/// The channels by the buffer's own letters; nothing to choose where there is one.
void drawChannel(AppState& state) {
    const std::string id = state.viewId(state.activePane, "channel");
    const ParameterInfo* declared = state.document.find(id);
    std::string channels;
    for (const BufferEntry& buffer : state.buffers(state.activePane))
        if (buffer.name == state.buffer(state.activePane)) channels = buffer.channels;
    if (!declared || channels.size() < 2) return;
    ParameterInfo info = *declared;
    const auto& all = declared->options;
    const auto chosen = std::find(all.begin(), all.end(), std::get<std::string>(declared->value)) - all.begin();
    info.options = {"All"};
    for (const char letter : channels.substr(0, all.size() - 1)) info.options.emplace_back(1, letter);
    const size_t present = std::min(static_cast<size_t>(chosen), info.options.size() - 1);
    info.value = info.options[present];
    const ParameterEdit edit = parameterRow(info, state.document.changed(id));
    if (edit.reset) state.reset({id});
    if (!edit.value) return;
    const auto wanted = std::find(info.options.begin(), info.options.end(), std::get<std::string>(*edit.value));
    state.setOnce(id, all[static_cast<size_t>(wanted - info.options.begin())]);
}

/// What the settings say about the present picture: a tone-mapped one has no range, a mapped one no exposure.
std::set<std::string> withoutEffect(const AppState& state, const std::string& prefix) {
    std::set<std::string> hidden{prefix + "module", prefix + "buffer", prefix + "channel"};
    const PaneSnapshot* shown = state.pane(state.activePane);
    if (!shown || shown->buffer != state.buffer(state.activePane)) return hidden;
    const bool tone = shown->info.toneMapped;
    for (const char* name : {"exposure", "tone-curve"})
        if (!tone) hidden.insert(prefix + name);
    for (const char* name : {"auto-range", "low", "high"})
        if (tone) hidden.insert(prefix + name);
    return hidden;
}

}  // namespace

void drawViewPanel(AppState& state) {
    drawPaneChoice(state);
    if (pickerRow("pick-module", "Method", state.module(state.activePane))) state.modulePickerWanted = true;
    if (pickerRow("pick-buffer", "Buffer", state.buffer(state.activePane))) state.bufferPickerWanted = true;
    if (section("Display")) {
        const std::string prefix = state.viewId(state.activePane, "");
        parameterRows(state, prefix, "", withoutEffect(state, prefix));
        drawChannel(state);
        drawZoom(state);
    }
    if (section("Pixel")) drawInspector(state);
}

}  // namespace lumi

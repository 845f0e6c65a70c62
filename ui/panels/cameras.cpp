#include <fmt/format.h>

#include "ui/commands.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

void drawSceneCameras(AppState& state) {
    const ParameterInfo* select = state.document.find("camera.select");
    if (!select) return;
    const std::string now = formatParameter(select->value);
    for (const std::string& name : select->options) {
        ImGui::PushID(name.c_str());
        if (ImGui::Selectable("##camera", now == name, 0, ImVec2(0, px(24)))) state.setOnce("camera.select", name);
        markItem("camera:" + name);
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        ImDrawList& list = *ImGui::GetWindowDrawList();
        const float middle = 0.5f * (low.y + high.y);
        drawIcon(list, Icon::Camera, ImVec2(low.x + px(14), middle), px(13),
                 now == name ? palette::kAccent : palette::kDim);
        list.AddText(ImVec2(low.x + px(30), std::floor(middle - 0.5f * ImGui::GetFontSize())), palette::kText,
                     name.c_str());
        ImGui::PopID();
    }
}

void drawBookmarks(AppState& state) {
    smallText("Bookmarks: Ctrl + digit stores, Alt + digit recalls");
    const float each = std::floor((ImGui::GetContentRegionAvail().x - 8 * px(4)) / 9);
    for (int i = 0; i < 9; ++i) {
        if (i > 0) ImGui::SameLine(0, px(4));
        const bool stored = state.bookmarks()[static_cast<size_t>(i)].has_value();
        ImGui::PushID(i);
        if (ImGui::InvisibleButton("bookmark", ImVec2(each, px(26))))
            runCommand(state, stored ? UiCommand::RecallBookmark : UiCommand::StoreBookmark, i);
        markItem(fmt::format("bookmark:{}", i + 1));
        const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
        ImDrawList& list = *ImGui::GetWindowDrawList();
        list.AddRectFilled(box.Min, box.Max,
                           stored                   ? palette::kAccentDeep
                           : ImGui::IsItemHovered() ? palette::kHovered
                                                    : palette::kRaised,
                           px(4));
        const std::string text = fmt::format("{}", i + 1);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        list.AddText(
            ImVec2(std::floor(box.GetCenter().x - 0.5f * size.x), std::floor(box.GetCenter().y - 0.5f * size.y)),
            stored ? palette::kOnAccent : palette::kDim, text.c_str());
        if (ImGui::IsItemHovered()) tooltip(stored ? "Go to this bookmark" : "Store the camera here");
        ImGui::PopID();
    }
}

}  // namespace

void drawCameras(AppState& state) {
    drawSceneCameras(state);
    ImGui::Dummy(ImVec2(0, px(2)));
    drawBookmarks(state);
    ImGui::Dummy(ImVec2(0, px(2)));
    const Icon copy = Icon::Camera;
    if (textButton("copy-camera", "Copy as command line", &copy)) runCommand(state, UiCommand::CopyCamera);
    if (ImGui::IsItemHovered()) tooltip(tipFor("Copies --set camera.eye=… to the clipboard", UiCommand::CopyCamera));
}

}  // namespace lumi

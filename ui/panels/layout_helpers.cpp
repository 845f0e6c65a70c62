#include <filesystem>

#include "ui/panels/panels.h"
#include "ui/theme.h"

namespace lumi {

void beginFixed(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags extra) {
    ImGui::SetNextWindowPos(area.Min);
    ImGui::SetNextWindowSize(area.GetSize());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colour);
    ImGui::Begin(name, nullptr, kFixedWindow | extra);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

void endFixed() {
    ImGui::End();
}

std::string sceneName(const AppState& state) {
    const Scene* scene = state.document.scene();
    if (!scene) return "Open a scene";
    if (!scene->title.empty()) return scene->title;
    const std::string stem = std::filesystem::path(scene->path).stem().string();
    return stem.empty() ? "Untitled scene" : stem;
}

}  // namespace lumi

#include <filesystem>

#include "ui/panels/panels.h"
#include "ui/theme.h"

namespace lumi {

static void beginArea(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos(area.Min);
    ImGui::SetNextWindowSize(area.GetSize());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, colour);
    ImGui::Begin(name, nullptr, flags);
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

void beginFixed(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags extra) {
    beginArea(name, area, colour, padding, kFixedWindow | extra);
}

void beginDrawer(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags extra) {
    ImGui::SetNextWindowFocus();
    beginArea(name, area, colour, padding, (kFixedWindow & ~ImGuiWindowFlags_NoBringToFrontOnFocus) | extra);
}

void beginCard(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding) {
    beginArea(name, area, colour, padding, kFixedWindow & ~ImGuiWindowFlags_NoBringToFrontOnFocus);
}

void endFixed() { ImGui::End(); }

std::string sceneName(const AppState& state) {
    const Scene* scene = state.document.scene();
    if (!scene) return "Open a scene";
    if (!scene->title.empty()) return scene->title;
    const std::string stem = std::filesystem::path(scene->path).stem().string();
    return stem.empty() ? "Untitled scene" : stem;
}

}  // namespace lumi

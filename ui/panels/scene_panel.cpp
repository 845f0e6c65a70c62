#include <fmt/format.h>

#include "base/memory.h"
#include "ui/panels/panels.h"
#include "ui/parameter_widgets.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

void drawCounts(const Scene& scene) {
    const WithFont small(ui().fonts.small);
    const auto row = [](const char* what, const std::string& value) {
        dimText(what);
        ImGui::SameLine(px(110));
        ImGui::TextUnformatted(value.c_str());
    };
    row("Triangles", fmt::format("{}", scene.triangleCount()));
    row("Instances", fmt::format("{}", scene.instances.size()));
    row("Materials", fmt::format("{}", scene.materials.size()));
    row("Lights", fmt::format("{}", scene.lights.size()));
    row("Memory", formatBytes(scene.byteCount()));
    if (scene.duration() > 0) row("Duration", fmt::format("{:.2f} s", scene.duration()));
    dimText("File");
    ImGui::SameLine(px(110));
    ImGui::TextUnformatted(elided(scene.path, ImGui::GetContentRegionAvail().x).c_str());
    if (ImGui::IsItemHovered()) tooltip(scene.path);
}

/// Parameters of "<kind>.<name>.<parameter>": one folding row a name.
void drawNamed(AppState& state, const char* title, const std::string& kind) {
    const std::vector<std::string>& labels = state.document.names(kind);
    if (labels.empty() || !section(title, false)) return;
    for (const std::string& label : labels) {
        const std::string name = kind + "." + label;
        ImGui::SetNextItemOpen(false, ImGuiCond_Once);
        if (ImGui::TreeNodeEx((label + "##" + name).c_str(),
                              ImGuiTreeNodeFlags_SpanAvailWidth | ImGuiTreeNodeFlags_FramePadding)) {
            markItem(name);
            parameterRows(state, name + ".");
            ImGui::TreePop();
        } else {
            markItem(name);
        }
    }
}

}  // namespace

void drawScenePanel(AppState& state) {
    const Scene* scene = state.document.scene();
    if (section("Cameras")) drawCameras(state);
    if (section("Camera settings", false)) parameterRows(state, "camera.");
    if (state.document.hasGroup("environment.") && section("Environment", false)) parameterRows(state, "environment.");
    drawNamed(state, "Lights", "light");
    drawNamed(state, "Materials", "material");
    if (state.document.hasGroup("scene.") && section("Scene, variant, animation", false))
        parameterRows(state, "scene.");
    if (scene && section("About this scene")) drawCounts(*scene);
}

}  // namespace lumi


#include <algorithm>

#include "base/error.h"
#include "scene/load.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr double kQuickLoadSeconds = 0.4;  ///< a load is told of once it takes longer

/// Built-in scenes do not change while the program runs.
const std::vector<SceneEntry>& builtIn() {
    static const std::vector<SceneEntry> entries = listScenes();
    return entries;
}

/// `there`: it can be opened.
bool sceneRow(const std::string& id, const std::string& title, const std::string& detail, bool there = true) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = px(46);
    ImGui::PushID(id.c_str());
    const bool clicked = ImGui::InvisibleButton("row", ImVec2(width, height));
    markItem("scene:" + id);
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        list.AddRectFilled(corner, corner + ImVec2(width, height), IM_COL32(255, 255, 255, 16), px(5));
    drawIcon(list, Icon::Layers, corner + ImVec2(px(24), 0.5f * height), px(18),
             ImGui::IsItemHovered() ? palette::kAccent : palette::kDim);
    list.AddText(corner + ImVec2(px(48), px(6)), there ? palette::kText : palette::kDim,
                 elided(title, width - px(60)).c_str());
    const WithFont small(ui().fonts.small);
    list.AddText(corner + ImVec2(px(48), px(25)), palette::kDim, elided(detail, width - px(60)).c_str());
    ImGui::SetCursorScreenPos(corner + ImVec2(0, height + px(2)));
    return clicked;
}

/// A path, or the name of a built-in scene.
bool openTyped(AppState& state, const std::string& text) {
    try {
        state.open(findScene(text));
        return true;
    } catch (const Error& error) {
        state.log.error(error.what());
        return false;
    }
}

/// Everything that can be opened; returns true when something was.
bool drawScenes(AppState& state) {
    static std::string path;  // of the one browser that can be open
    bool opened = false;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - px(92));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(10), px(6)));
    const bool entered = ImGui::InputTextWithHint("##path", "Path of a .json, .gltf, .glb, .obj, .hdr or .exr file",
                                                  &path, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::PopStyleVar();
    markItem("scene-path");
    ImGui::SameLine(0, px(8));
    if ((textButton("open-path", "Open", nullptr, true, px(84)) || entered) && !path.empty()) {
        opened = openTyped(state, path);
    }
    ImGui::Dummy(ImVec2(0, px(6)));
    ImGui::BeginChild("scenes");
    smallText("Built in", palette::kFaint);
    for (const SceneEntry& entry : builtIn()) {
        const bool there = entry.missing.empty();
        if (sceneRow(entry.name, entry.title, entry.name + (there ? "" : ": its files are not in $LUMISCOPE_ASSETS"),
                     there)) {
            state.open(entry.path);  // what is missing is the error that loading it shows
            opened = true;
        }
    }
    if (!state.recentScenes.empty()) {
        ImGui::Dummy(ImVec2(0, px(4)));
        smallText("Recent", palette::kFaint);
        const std::vector<std::filesystem::path> recent = state.recentScenes;  // opening one reorders the list
        for (const auto& file : recent)
            if (sceneRow("recent:" + file.string(), file.stem().string(), file.string())) {
                state.open(file);
                opened = true;
            }
    }
    ImGui::EndChild();
    return opened;
}

void drawLoading(AppState& state, const LoadStatus& status, const ImRect& area) {
    const float width = std::min(px(380), area.GetWidth() - px(60));
    ImGui::SetCursorScreenPos(ImVec2(area.GetCenter().x - 0.5f * width, area.GetCenter().y - px(40)));
    ImGui::BeginGroup();
    const std::string name = std::filesystem::path(status.path).filename().string();
    heading(elided("Opening " + name, width));
    progressBar(status.fraction > 0 ? status.fraction : -1, width, px(6));
    smallText(elided(status.step, width));
    if (textButton("cancel-loading", "Cancel")) state.session.cancelLoading();
    ImGui::EndGroup();
}

/// Over the scene before, which stays while the next one loads.
void drawLoadingCard(AppState& state, const LoadStatus& status, const ImRect& area) {
    const ImVec2 size(std::min(px(420), area.GetWidth() - px(24)), px(116));
    const ImVec2 corner(std::floor(area.GetCenter().x - 0.5f * size.x), area.Min.y + px(56));
    beginCard("loading-card", ImRect(corner, corner + size), IM_COL32(28, 29, 33, 250), ImVec2(px(20), px(12)));
    drawLoading(state, status, ImRect(corner, corner + size));
    endFixed();
}

}  // namespace

void drawSceneBrowser(AppState& state, const ImRect& area) {
    if (!state.browserOpen) return;
    ImGui::SetNextWindowFocus();
    const ImVec2 size(std::min(px(520), area.GetWidth() - px(24)), std::min(px(500), area.GetHeight() - px(16)));
    const ImVec2 corner(area.Min.x + px(12), area.Min.y + px(8));
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(28, 29, 33, 252));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(16), px(14)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::Begin("scene-browser", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    const bool outside = ImGui::IsMouseClicked(ImGuiMouseButton_Left) &&
                         !ImGui::IsMouseHoveringRect(corner, corner + size, false) &&
                         ImGui::GetIO().MousePos.y > area.Min.y;
    heading("Open a scene");
    ImGui::SameLine(ImGui::GetWindowWidth() - px(42));
    if (iconButton("close-browser", Icon::Close, "Close", false, 24)) state.browserOpen = false;
    if (drawScenes(state) || outside) state.browserOpen = false;
    ImGui::End();
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor();
}

void drawEmptyPicture(AppState& state, const ImRect& area) {
    const LoadStatus status = state.session.loadStatus();
    static double restedAt = 0;  // of one window, like ImGui's own state
    if (!status.loading) restedAt = ImGui::GetTime();
    if (state.snapshot && !status.loading) return;
    if (state.snapshot) {
        if (ImGui::GetTime() - restedAt > kQuickLoadSeconds) drawLoadingCard(state, status, area);
        return;
    }
    beginFixed("empty", area, palette::kBackground, ImVec2(0, 0), ImGuiWindowFlags_NoBackground);
    if (status.loading || state.document.present()) {
        drawLoading(
            state,
            status.loading ? status : LoadStatus{true, 0, "Tracing the first frame", state.document.scene()->path},
            area);
        endFixed();
        return;
    }
    const float width = std::min(px(520), area.GetWidth() - px(48)),
                height = std::min(px(560), area.GetHeight() - px(32));
    const ImVec2 corner(std::floor(area.GetCenter().x - 0.5f * width), std::floor(area.GetCenter().y - 0.5f * height));
    drawMark(*ImGui::GetWindowDrawList(), corner + ImVec2(px(22), px(24)), px(40));
    ImGui::SetCursorScreenPos(corner + ImVec2(px(56), px(2)));
    ImGui::BeginGroup();
    {
        const WithFont title(ui().fonts.title);
        ImGui::TextUnformatted("Lumiscope");
    }
    dimText("Drop a scene here, or choose one.");
    ImGui::EndGroup();
    ImGui::SetCursorScreenPos(corner + ImVec2(0, px(72)));
    ImGui::BeginChild("welcome", ImVec2(width, height - px(72)));
    drawScenes(state);
    ImGui::EndChild();
    endFixed();
}

}  // namespace lumi

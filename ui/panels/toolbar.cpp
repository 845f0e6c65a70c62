#include <fmt/format.h>

#include "ui/commands.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

void centreNext(const ImRect& area, float height) {
    ImGui::SetCursorPosY(std::floor(0.5f * (area.GetHeight() - height)));
}

void drawSceneButton(AppState& state, const ImRect& area, float width) {
    const std::string name = elided(sceneName(state), width - px(40));
    const ImVec2 size(ImGui::CalcTextSize(name.c_str()).x + px(40), px(30));
    centreNext(area, size.y);
    const bool clicked = ImGui::InvisibleButton("scene", size);
    markItem("scene");
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered() || state.browserOpen) list.AddRectFilled(box.Min, box.Max, palette::kRaised, px(5));
    list.AddText(ImVec2(box.Min.x + px(10), std::floor(box.GetCenter().y - 0.5f * ImGui::GetFontSize())),
                 palette::kText, name.c_str());
    drawIcon(list, Icon::Chevron, ImVec2(box.Max.x - px(15), box.GetCenter().y), px(10), palette::kDim);
    if (ImGui::IsItemHovered()) tooltip(tipFor("Open a scene", UiCommand::OpenScene));
    if (clicked) runCommand(state, UiCommand::OpenScene);
}

/// `narrow`: there is room for what is pressed most.
void drawTransport(AppState& state, const ImRect& area, bool narrow) {
    const auto button = [&](const char* name, Icon icon, const char* what, UiCommand command, bool on = false) {
        ImGui::SameLine(0, px(1));
        centreNext(area, px(28));
        if (iconButton(name, icon, tipFor(what, command), on)) runCommand(state, command);
    };
    if (!narrow) button("restart", Icon::Restart, "Restart at frame 0", UiCommand::Restart);
    if (!narrow) button("step-back", Icon::StepBack, "One frame back", UiCommand::StepBack);
    const bool playing = state.timePlays();
    button("play", playing ? Icon::Pause : Icon::Play, playing ? "Pause time" : "Play time", UiCommand::PlayTime,
           playing);
    button("step", Icon::Step, "One frame forward; time goes on in it if it was played", UiCommand::Step);
    if (state.snapshot && !narrow) {
        ImGui::SameLine(0, px(8));
        const WithFont mono(ui().fonts.mono);
        centreNext(area, ImGui::GetFontSize());
        dimText(fmt::format("{:.2f} s", state.snapshot->time));
        if (ImGui::IsItemHovered()) tooltip(fmt::format("Frame {}", state.snapshot->frame));
    }
}

/// Samples so far, and the way to the target.
void drawProgress(AppState& state, const ImRect& area) {
    if (const std::optional<float> replayed = state.session.steppingBack()) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const WithFont small(ui().fonts.small);
        const char* text = "drawing again";
        ImGui::GetWindowDrawList()->AddText(
            ImVec2(corner.x + px(132) - ImGui::CalcTextSize(text).x, area.Min.y + px(9)), palette::kDim, text);
        ImGui::SetCursorScreenPos(ImVec2(corner.x, area.Min.y + px(28)));
        return progressBar(*replayed, px(132), px(4));
    }
    if (!state.snapshot || state.snapshot->accumulatedSamples == 0) return;
    const uint64_t samples = state.snapshot->accumulatedSamples, target = state.snapshot->targetSamples;
    const std::string text = target ? fmt::format("{} / {} spp", samples, target) : fmt::format("{} spp", samples);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = px(132);
    const WithFont small(ui().fonts.small);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float textWidth = ImGui::CalcTextSize(text.c_str()).x;
    list.AddText(ImVec2(corner.x + width - textWidth, area.Min.y + px(target ? 9 : 15)), palette::kDim, text.c_str());
    markRect("progress", ImVec2(corner.x, area.Min.y), ImVec2(corner.x + width, area.Max.y));
    if (target == 0) return;
    const float fraction = static_cast<float>(samples) / static_cast<float>(target);
    ImGui::SetCursorScreenPos(ImVec2(corner.x, area.Min.y + px(28)));
    progressBar(fraction, width, px(4), fraction >= 1 ? palette::kGood : palette::kAccent);
}

}  // namespace

void drawToolbar(AppState& state, const ImRect& area) {
    beginFixed("toolbar", area, palette::kBar, ImVec2(px(12), 0));
    const bool wide = area.GetWidth() >= px(900), medium = area.GetWidth() >= px(700),
               narrow = area.GetWidth() < px(600);
    drawMark(*ImGui::GetWindowDrawList(), ImVec2(area.Min.x + px(25), area.GetCenter().y), px(24));
    ImGui::SetCursorPosX(px(46));
    if (wide) {
        const WithFont strong(ui().fonts.strong);
        centreNext(area, ImGui::GetFontSize());
        ImGui::TextUnformatted("Lumiscope");
        ImGui::SameLine(0, px(14));
    }
    drawSceneButton(state, area, wide ? px(240) : narrow ? px(100) : px(130));
    if (state.document.present()) {
        ImGui::SameLine(0, px(12));
        ImGui::Dummy(ImVec2(0, 0));
        drawTransport(state, area, narrow);
    }
    const float right = area.GetWidth() - px(12), icons = px(30);
    float x = right - 3 * icons - px(114);
    if (state.document.present() && medium) {
        ImGui::SameLine();
        ImGui::SetCursorPosX(x - px(150));
        drawProgress(state, area);
    }
    if (state.document.present()) {
        ImGui::SetCursorScreenPos(ImVec2(area.Min.x + x, area.Min.y + 0.5f * (area.GetHeight() - px(28))));
        const int clicked = iconSegments("layout", {Icon::Single, Icon::SideBySide, Icon::Wipe},
                                         {"One view", "Side by side", "Wipe"}, static_cast<int>(state.layout()));
        if (clicked >= 0) state.setLayout(static_cast<Layout>(clicked));
    }
    x = right - 3 * icons;
    const auto button = [&](const char* name, Icon icon, const char* what, UiCommand command, bool on) {
        ImGui::SetCursorScreenPos(ImVec2(area.Min.x + x, area.Min.y + 0.5f * (area.GetHeight() - px(28))));
        if (iconButton(name, icon, tipFor(what, command), on)) runCommand(state, command);
        x += icons;
    };
    const bool rendering = state.session.rendering();
    button("pause-rendering", rendering ? Icon::Pause : Icon::Play, rendering ? "Pause rendering" : "Resume rendering",
           UiCommand::PauseRendering, !rendering);
    button("screenshot", Icon::Camera, "Save the view as PNG", UiCommand::SavePicture, false);
    button("help", Icon::Help, "Keys and mouse", UiCommand::Help, state.helpOpen);
    ImGui::GetWindowDrawList()->AddLine(ImVec2(area.Min.x, area.Max.y - 0.5f), ImVec2(area.Max.x, area.Max.y - 0.5f),
                                        palette::kBorder);
    endFixed();
}

}  // namespace lumi

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/commands.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

struct StatusLight {
    ImU32 colour;
    std::string text;
};

/// Colour and words of the light, for the state of the check.
StatusLight lightOf(const AppState& state) {
    const auto check = state.session.signalCheck();
    if (state.session.checkingSignals()) {
        const float pulse = 0.65f + 0.35f * std::sin(6.0f * static_cast<float>(ImGui::GetTime()));
        return {withAlpha(palette::kWarning, pulse), "checking signals"};
    }
    if (!check) return {palette::kFaint, "signals not checked"};
    if (!check->failure.empty()) return {palette::kError, "signals could not be checked"};
    const int broken = check->brokenRules();
    if (broken == 0) return {palette::kGood, "signals good"};
    return {palette::kError, fmt::format("signals: {} rule{} broken", broken, broken == 1 ? "" : "s")};
}

void drawFinding(const ContractFinding& finding) {
    const bool none = finding.holds() && finding.checked == 0;
    const ImU32 colour = !finding.holds() ? palette::kError : none ? palette::kFaint : palette::kGood;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddCircleFilled(at + ImVec2(px(10), 0.5f * ImGui::GetTextLineHeight()), px(3.5f),
                                                colour);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + px(24));
    ImGui::PushTextWrapPos(0);
    if (finding.holds()) {
        ImGui::TextUnformatted(finding.rule.c_str());
        ImGui::SameLine(0, px(10));
        smallText(none ? "nothing to check" : fmt::format("{} checked", finding.checked), palette::kFaint);
    } else {
        ImGui::TextUnformatted(finding.text().c_str());
    }
    ImGui::PopTextWrapPos();
}

/// The rules of one traced frame, broken ones first.
void drawFrameCheck(const FrameCheck& frame) {
    smallText(frame.what, palette::kDim);
    std::vector<const ContractFinding*> findings;
    for (const ContractFinding& finding : frame.findings) findings.push_back(&finding);
    std::stable_partition(findings.begin(), findings.end(), [](const ContractFinding* f) { return !f->holds(); });
    for (const ContractFinding* finding : findings) drawFinding(*finding);
    ImGui::Dummy(ImVec2(0, px(6)));
}

}  // namespace

float drawSignalsLight(AppState& state, const ImRect& area) {
    if (!state.document.present()) return area.Max.x;
    const StatusLight light = lightOf(state);
    const float width = ImGui::CalcTextSize(light.text.c_str()).x + px(28);
    if (area.GetWidth() < width + px(120)) return area.Max.x;
    const ImVec2 corner(area.Max.x - width, area.Min.y);
    ImGui::SetCursorScreenPos(corner);
    if (ImGui::InvisibleButton("signals", ImVec2(width, area.GetHeight()))) runCommand(state, UiCommand::ToggleSignals);
    markItem("signals");
    const bool hovered = ImGui::IsItemHovered();
    if (hovered)
        tooltip(
            "What every filter assumes of its input",
            "Unit normals, albedo in range, terms that add up, motion that leads to the previous pixel, finite values.",
            shortcutText(UiCommand::ToggleSignals));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(ImVec2(corner.x + px(10), area.GetCenter().y), px(4), light.colour);
    list.AddText(ImVec2(corner.x + px(20), std::floor(area.GetCenter().y - 0.5f * ImGui::GetFontSize())),
                 hovered || state.signalsOpen ? palette::kText : palette::kDim, light.text.c_str());
    return corner.x;
}

void drawSignals(AppState& state, const ImRect& area) {
    if (!state.signalsOpen || !state.document.present()) return;
    const float height = std::min(px(330), 0.6f * area.GetHeight());
    const ImRect box(ImVec2(area.Min.x, area.Max.y - height), area.Max);
    beginDrawer("signals-drawer", box, IM_COL32(22, 23, 26, 250), ImVec2(px(14), px(10)));
    markRect("signals-drawer", box.Min, box.Max);
    heading("Signals");
    ImGui::SameLine(0, px(12));
    smallText(lightOf(state).text);
    ImGui::SameLine(ImGui::GetWindowWidth() - px(42));
    if (iconButton("close-signals", Icon::Close, "Close", false, 22)) state.signalsOpen = false;
    if (textButton("check-signals", state.session.signalCheck() ? "Check again" : "Check now"))
        runCommand(state, UiCommand::CheckSignals);
    ImGui::SameLine(0, px(18));
    bool always = state.checkScenes;
    if (toggleSwitch("check-scenes", always)) state.checkScenes = always;
    markItem("check-scenes");
    ImGui::SameLine(0, px(8));
    dimText("each scene when it opens");
    ImGui::Dummy(ImVec2(0, px(2)));
    ImGui::BeginChild("rules");
    const auto check = state.session.signalCheck();
    if (!check) dimText("Two small frames of the scene are traced, and every rule that filters rely on is verified.");
    else if (!check->failure.empty()) dimText(check->failure);
    else
        for (const FrameCheck& frame : check->frames) drawFrameCheck(frame);
    ImGui::EndChild();
    endFixed();
}

}  // namespace lumi

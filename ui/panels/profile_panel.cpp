#include <fmt/format.h>

#include <algorithm>

#include "base/memory.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

void row(const char* what, const std::string& value, ImU32 colour = palette::kText) {
    dimText(what);
    const WithFont mono(ui().fonts.mono);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x - px(6));
    ImGui::TextColored(toVec4(colour), "%s", value.c_str());
}

void drawStages(const Snapshot& snapshot) {
    double longest = 1e-6;
    for (const auto& [stage, ms] : snapshot.stagesMs) longest = std::max(longest, ms);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const auto& [stage, ms] : snapshot.stagesMs) {
        const ImVec2 corner = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x, height = px(22);
        const float filled = width * static_cast<float>(ms / longest);
        list.AddRectFilled(corner, corner + ImVec2(std::max(filled, px(2)), height - px(3)),
                           withAlpha(palette::kAccentDeep, 0.55f), px(3));
        const float y = std::floor(corner.y + 0.5f * (height - px(3) - ImGui::GetFontSize()));
        list.AddText(ImVec2(corner.x + px(7), y), palette::kText, stage.c_str());
        const WithFont mono(ui().fonts.mono);
        const std::string text = fmt::format("{:.2f} ms", ms);
        list.AddText(ImVec2(corner.x + width - ImGui::CalcTextSize(text.c_str()).x - px(6), y + px(1)), palette::kText,
                     text.c_str());
        ImGui::Dummy(ImVec2(width, height));
    }
    row("Frame", fmt::format("{:.1f} ms", snapshot.frameMs));
}

/// The UI thread's frames against their budget of 8 ms.
void drawUiHistory(const UiTiming& timing) {
    constexpr float kBudgetMs = 8;
    const std::vector<float> history = timing.history();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x, height = px(54);
    ImGui::Dummy(ImVec2(width, height));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(width, height), IM_COL32(18, 19, 21, 255), px(4));
    const float top = 1.25f * kBudgetMs, budgetY = corner.y + height * (1 - kBudgetMs / top);
    list.AddLine(ImVec2(corner.x, budgetY), ImVec2(corner.x + width, budgetY), withAlpha(palette::kWarning, 0.5f));
    if (history.size() < 2) return;
    for (size_t i = 0; i < history.size(); ++i)
        list.PathLineTo(ImVec2(corner.x + width * static_cast<float>(i) / static_cast<float>(history.size() - 1),
                               corner.y + height * (1 - std::min(history[i], top) / top)));
    list.PathStroke(palette::kAccent, 0, px(1.2f));
}

std::string snapshotRate(const AppState& state) {
    const double rate = state.snapshot->framesPerSecond;
    if (!state.session.rendering()) return "paused";
    return rate > 0 ? fmt::format("{:.3g} / s", rate) : "-";
}

}  // namespace

void drawProfilePanel(AppState& state) {
    if (state.snapshot && section("Stages of the last frame")) drawStages(*state.snapshot);
    if (state.snapshot && section("Frames and rays")) {
        row("Frames", snapshotRate(state));
        row("Speed", fmt::format("{:.2f} Mray/s", state.snapshot->raysPerSecond * 1e-6));
        row("Number", fmt::format("{}", state.snapshot->frame));
        row("Samples", fmt::format("{} spp", state.snapshot->accumulatedSamples));
        row("Size", fmt::format("{} x {}", state.snapshot->traced.width, state.snapshot->traced.height));
    }
    if (section("Memory")) {
        row("Resident", formatBytes(residentBytes()));
        row("Peak", formatBytes(peakResidentBytes()));
        row("Limit", formatBytes(memoryLimit()));
    }
    if (section("Window")) {
        drawUiHistory(state.timing);
        row("UI thread, median", fmt::format("{:.2f} ms", state.timing.median()));
        row("UI thread, p99", fmt::format("{:.2f} ms", state.timing.p99()),
            state.timing.p99() < 8 ? palette::kGood : palette::kWarning);
        row("Redrawn", fmt::format("{:.0f} / s", static_cast<double>(ImGui::GetIO().Framerate)));
        ImGui::PushTextWrapPos(0);
        smallText("CPU time of the UI thread a frame, outside OpenGL; the line is the budget of 8 ms.",
                  palette::kFaint);
        ImGui::PopTextWrapPos();
    }
}

}  // namespace lumi

#include <fmt/format.h>

#include "ui/commands.h"
#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

Icon iconOf(Severity severity) {
    return severity == Severity::Error ? Icon::Error : severity == Severity::Warning ? Icon::Warning : Icon::Info;
}
ImU32 colourOf(Severity severity) {
    return severity == Severity::Error     ? palette::kError
           : severity == Severity::Warning ? palette::kWarning
                                           : palette::kDim;
}

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// What a frame took.
std::string duration(double ms) {
    return ms < 1000 ? fmt::format("{:.1f} ms a frame", ms) : fmt::format("{:.2f} s a frame", ms * 1e-3);
}

/// Facts about the picture, right-aligned; as many as fit.
std::string facts(const AppState& state) {
    if (!state.snapshot) return {};
    const Snapshot& s = *state.snapshot;
    const std::string size = fmt::format("{} x {}    {:.0f}%", s.extent.width, s.extent.height,
                                         static_cast<double>(100 * state.view.zoom()));
    const std::string cost = fmt::format("{}    {:.1f} Mray/s", duration(s.frameMs), s.raysPerSecond * 1e-6);
    if (s.preview) return fmt::format("{}    preview {} x {}    {}", size, s.traced.width, s.traced.height, cost);
    if (!state.session.rendering()) return size + "    paused    " + cost;
    if (s.targetSamples && s.accumulatedSamples >= s.targetSamples && !state.session.playing())
        return size + "    done    " + cost;
    const std::string rate = s.framesPerSecond > 0 ? fmt::format("    {:.3g} frames/s", s.framesPerSecond) : "";
    return size + rate + "    " + cost;
}

void drawStatusRow(AppState& state, const ImRect& area) {
    const WithFont small(ui().fonts.small);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float y = std::floor(area.GetCenter().y - 0.5f * ImGui::GetFontSize());
    const std::string right = facts(state);
    const float rightWidth = ImGui::CalcTextSize(right.c_str()).x;
    const bool roomForBoth = area.GetWidth() > rightWidth + px(340);
    float end = area.Max.x - px(14);
    if (roomForBoth) {
        end -= rightWidth;
        list.AddText(ImVec2(end, y), palette::kDim, right.c_str());
        end -= px(22);
    }
    end = drawSignalsLight(state, ImRect(area.Min, ImVec2(end, area.Max.y))) - px(10);

    const float width = std::max(end - area.Min.x, px(40));
    ImGui::SetCursorScreenPos(area.Min);
    if (ImGui::InvisibleButton("messages", ImVec2(width, area.GetHeight())))
        runCommand(state, UiCommand::ToggleMessages);
    markItem("messages");
    const bool hovered = ImGui::IsItemHovered();
    const std::vector<Message> messages = state.log.messages();
    if (messages.empty()) {
        list.AddText(ImVec2(area.Min.x + px(14), y), palette::kFaint, "F1 shows all keys");
        return;
    }
    const Message& last = messages.back();
    drawIcon(list, iconOf(last.severity), ImVec2(area.Min.x + px(20), area.GetCenter().y), px(13),
             colourOf(last.severity));
    const std::string text = elided(firstLine(last.text), width - px(60));
    list.AddText(ImVec2(area.Min.x + px(34), y), hovered ? palette::kText : palette::kDim, text.c_str());
    if (hovered)
        tooltip(state.messagesOpen ? "Hide messages" : "Show all messages", "",
                shortcutText(UiCommand::ToggleMessages));
}

}  // namespace

void drawStatusBar(AppState& state, const ImRect& area) {
    beginFixed("status", area, palette::kBar, ImVec2(0, 0));
    ImGui::GetWindowDrawList()->AddLine(ImVec2(area.Min.x, area.Min.y + 0.5f), ImVec2(area.Max.x, area.Min.y + 0.5f),
                                        palette::kBorder);
    drawStatusRow(state, area);
    endFixed();
}

void drawMessages(AppState& state, const ImRect& area) {
    if (!state.messagesOpen) return;
    const float height = std::min(px(210), 0.5f * area.GetHeight());
    const ImRect box(ImVec2(area.Min.x, area.Max.y - height), area.Max);
    beginDrawer("message-drawer", box, IM_COL32(22, 23, 26, 250), ImVec2(px(14), px(10)));
    heading("Messages");
    ImGui::SameLine(ImGui::GetWindowWidth() - px(112));
    if (ImGui::SmallButton("Clear")) state.log.clear();
    markItem("clear-messages");
    ImGui::SameLine(ImGui::GetWindowWidth() - px(42));
    if (iconButton("close-messages", Icon::Close, "Close", false, 22)) state.messagesOpen = false;
    ImGui::BeginChild("rows");
    for (const Message& message : state.log.messages()) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        drawIcon(*ImGui::GetWindowDrawList(), iconOf(message.severity),
                 at + ImVec2(px(8), 0.5f * ImGui::GetTextLineHeight()), px(13), colourOf(message.severity));
        ImGui::SetCursorPosX(px(26));
        ImGui::PushTextWrapPos(0);
        ImGui::TextUnformatted(message.text.c_str());
        ImGui::PopTextWrapPos();
        if (message.repeats > 1) smallText(fmt::format("      {} times", message.repeats), palette::kFaint);
    }
    if (state.log.messages().empty()) dimText("Nothing to report.");
    ImGui::EndChild();
    endFixed();
}

void drawToast(AppState& state, const ImRect& area) {
    constexpr double kSeconds = 7;
    static uint64_t seen = 0;  // of one window, like ImGui's own state
    static double since = -100;
    static Message raised;  ///< the one that is told; later news do not take its place
    const std::vector<Message> messages = state.log.messages();
    if (!messages.empty() && messages.back().serial > seen) {
        for (const Message& message : messages)
            if (message.serial > seen && message.severity != Severity::Info) since = ImGui::GetTime(), raised = message;
        seen = messages.back().serial;
    }
    const double age = ImGui::GetTime() - since;
    if (age > kSeconds || messages.empty() || state.messagesOpen) return;
    const Message& last = raised;
    const auto alpha = static_cast<float>(std::clamp((kSeconds - age) * 2, 0.0, 1.0));
    const float width = std::min(px(560), area.GetWidth() - px(40));
    const ImVec2 textSize = ImGui::CalcTextSize(last.text.c_str(), nullptr, false, width - px(60));
    const ImVec2 size(std::min(width, textSize.x + px(60)), textSize.y + px(22));
    const ImVec2 corner(std::floor(area.GetCenter().x - 0.5f * size.x), std::floor(area.Max.y - size.y - px(20)));
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRectFilled(corner, corner + size, withAlpha(IM_COL32(28, 29, 33, 250), alpha), px(6));
    list.AddRect(corner, corner + size, withAlpha(colourOf(last.severity), 0.6f * alpha), px(6));
    drawIcon(list, iconOf(last.severity), corner + ImVec2(px(22), 0.5f * size.y), px(16),
             withAlpha(colourOf(last.severity), alpha));
    list.AddText(nullptr, 0, corner + ImVec2(px(42), px(11)), withAlpha(palette::kText, alpha), last.text.c_str(),
                 nullptr, width - px(60));
    // It lies above all windows, so none of them clips it.
    if (UiMap& map = ui().map; map.enabled())
        map.add("toast:" + last.text, {corner.x, corner.y}, {corner.x + size.x, corner.y + size.y});
}

}  // namespace lumi

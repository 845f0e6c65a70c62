#include <algorithm>

#include "ui/panels/panels.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kRow = 24.5f;

/// A key as a key cap, right edge at `right`.
void keyCap(ImVec2 rightMiddle, const std::string& text) {
    const WithFont small(ui().fonts.small);
    const float width = ImGui::CalcTextSize(text.c_str()).x + px(12);
    const ImVec2 corner(rightMiddle.x - width, rightMiddle.y - px(10));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(width, px(20)), IM_COL32(52, 55, 61, 255), px(4));
    list.AddText(ImVec2(corner.x + px(6), std::floor(rightMiddle.y - 0.5f * ImGui::GetFontSize())), palette::kText,
                 text.c_str());
}

void row(float width, const std::string& keys, const char* text) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float middle = corner.y + 0.5f * px(kRow);
    const float keyRight = corner.x + px(132);
    keyCap(ImVec2(keyRight, middle), keys);
    ImGui::GetWindowDrawList()->AddText(ImVec2(keyRight + px(12), std::floor(middle - 0.5f * ImGui::GetFontSize())),
                                        palette::kText, text);
    ImGui::Dummy(ImVec2(width, px(kRow) - ImGui::GetStyle().ItemSpacing.y));
}

std::string chordText(const Shortcut& shortcut) {
    std::string text = formatChord(shortcut.chord);
    if (shortcut.keys > 1) text += " … 9";
    return text;
}

/// The keys that are held, from row `first` on, in one line: "W A S D", "Fly forward, left, back, right". Returns the
/// last of them.
size_t heldRow(size_t first, float width) {
    const std::span<const Shortcut> table = shortcuts();
    std::string keys, text = "Fly ";
    size_t i = first;
    for (; i < table.size() && table[i].held; ++i) {
        keys += (i > first ? " " : "") + chordText(table[i]);
        text += (i > first ? ", " : "") + std::string(table[i].text);
    }
    row(width, keys, text.c_str());
    return i - 1;
}

void drawGroup(const char* group, float width) {
    heading(group);
    const std::span<const Shortcut> table = shortcuts();
    for (size_t i = 0; i < table.size(); ++i) {
        if (std::string(table[i].group) != group) continue;
        if (table[i].held) {
            i = heldRow(i, width);
            continue;
        }
        std::string keys = chordText(table[i]);
        if (i + 1 < table.size() && table[i + 1].command == table[i].command) {
            ++i;
            keys += table[i].chord == KeyChord{Key::Slash, false, true} ? "  ?" : "  " + chordText(table[i]);
        }
        row(width, keys, table[i].text);
    }
    ImGui::Dummy(ImVec2(0, px(8)));
}

}  // namespace

void drawHelp(AppState& state, const ImRect& area) {
    if (!state.helpOpen) return;
    beginDrawer("help-shade", area, IM_COL32(8, 9, 10, 150), ImVec2(0, 0), ImGuiWindowFlags_NoInputs);
    endFixed();
    ImGui::SetNextWindowFocus();
    const bool twoColumns = area.GetWidth() >= px(860);
    const ImVec2 size(std::min(px(twoColumns ? 900 : 460), area.GetWidth() - px(24)),
                      std::min(px(730), area.GetHeight() - px(24)));
    const ImVec2 corner(std::floor(area.GetCenter().x - 0.5f * size.x), std::floor(area.GetCenter().y - 0.5f * size.y));
    ImGui::SetNextWindowPos(corner);
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, IM_COL32(26, 27, 31, 250));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(24), px(18)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::Begin("help-overlay", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings);
    markRect("help-overlay", corner, corner + size);
    {
        const WithFont title(ui().fonts.title);
        ImGui::TextUnformatted("Keys and mouse");
    }
    ImGui::SameLine(ImGui::GetWindowWidth() - px(50));
    if (iconButton("close-help", Icon::Close, "Close", false, 26)) state.helpOpen = false;
    ImGui::Dummy(ImVec2(0, px(4)));
    const float column = (ImGui::GetContentRegionAvail().x - px(16)) / (twoColumns ? 2 : 1);
    if (twoColumns) ImGui::BeginTable("columns", 2, ImGuiTableFlags_SizingStretchSame);
    if (twoColumns) ImGui::TableNextColumn();
    drawGroup("Picture", column);
    drawGroup("Time and rendering", column);
    drawGroup("Files", column);
    if (twoColumns) ImGui::TableNextColumn();
    heading("Mouse");
    for (const Gesture& gesture : gestures()) row(column, gesture.how, gesture.text);
    ImGui::Dummy(ImVec2(0, px(8)));
    drawGroup("Camera", column);
    drawGroup("Window", column);
    if (twoColumns) ImGui::EndTable();
    ImGui::End();
    ImGui::PopStyleVar(2);
    ImGui::PopStyleColor();
}

}  // namespace lumi

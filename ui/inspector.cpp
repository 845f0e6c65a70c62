#include "ui/inspector.h"

#include <fmt/format.h>

#include <cmath>

#include "ui/widgets.h"

namespace lumi {

namespace {

std::string number(float value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "+inf" : "-inf";
    const float size = std::abs(value);
    return size != 0 && (size < 1e-3f || size >= 1e5f) ? fmt::format("{:.2e}", value) : fmt::format("{:.4f}", value);
}

ImU32 channelColour(char channel) {
    switch (channel) {
        case 'R': return IM_COL32(255, 138, 138, 255);
        case 'G': return IM_COL32(128, 218, 150, 255);
        case 'B': return IM_COL32(128, 178, 255, 255);
        default: return palette::kText;
    }
}

/// Values in columns as wide as the widest number; ids one after the other. They wrap where the panel ends.
void drawValues(const PixelValue& row) {
    const WithFont mono(ui().fonts.mono);
    const float cell = ImGui::CalcTextSize("-0.00e+00").x + px(4), line = ImGui::GetTextLineHeight();
    const float width = ImGui::GetContentRegionAvail().x;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool colour = row.channels.compare(0, 3, "RGB") == 0;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImVec2 at(0, 0);
    const size_t count = row.isId ? row.ids.size() : row.values.size();
    for (size_t i = 0; i < count; ++i) {
        const std::string text = row.isId ? fmt::format("{}", row.ids[i]) : number(row.values[i]);
        const float needed = row.isId ? ImGui::CalcTextSize(text.c_str()).x + px(8) : cell;
        if (at.x > 0 && at.x + needed > width + px(4)) at = ImVec2(0, at.y + line);
        const bool bad = !row.isId && !std::isfinite(row.values[i]) && row.channels != "Z";
        const ImU32 tint = bad ? palette::kError : colour && i < 3 ? channelColour(row.channels[i]) : palette::kText;
        list.AddText(corner + at, tint, text.c_str());
        at.x += needed;
    }
    ImGui::Dummy(ImVec2(width, at.y + line));
}

void dimOrAccent(const std::string& text, bool accent) {
    ImGui::TextColored(toVec4(accent ? palette::kAccent : palette::kDim), "%s", text.c_str());
}

void drawRow(const PixelValue& row, bool shown) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    {
        const WithFont small(ui().fonts.small);
        dimOrAccent(shortened(row.buffer, ImGui::GetContentRegionAvail().x), shown);
    }
    if (ImGui::IsItemHovered()) tooltip(row.buffer);
    ImGui::TableNextColumn();
    drawValues(row);
}

/// One stage of a lineage: rows [begin, end), those that count.
void drawStage(const Lineage& lineage, size_t begin, size_t end) {
    if (!section(lineage.rows[begin].stage.c_str(), false)) return;
    const WithFont mono(ui().fonts.mono);
    for (size_t i = begin; i < end; ++i) {
        const Lineage::Row& row = lineage.rows[i];
        const std::string text = fmt::format("({:4}, {:4}) {:6.2f}%", row.at.x, row.at.y, 100 * row.weight);
        ImGui::TextColored(toVec4(row.weight > 0 ? palette::kText : palette::kDim), "%s", text.c_str());
        if (ImGui::IsItemHovered()) tooltip(row.verdict);
        ImGui::SameLine(0, px(8));
        smallText(shortened(row.verdict, ImGui::GetContentRegionAvail().x));
    }
}

/// What made the pixel, stage by stage.
void drawLineage(const Lineage& lineage) {
    for (size_t begin = 0; begin < lineage.rows.size();) {
        size_t end = begin;
        while (end < lineage.rows.size() && lineage.rows[end].stage == lineage.rows[begin].stage) ++end;
        drawStage(lineage, begin, end);
        begin = end;
    }
}

}  // namespace

void drawInspector(AppState& state) {
    const std::optional<Pixel> pixel = state.pinned ? state.pinned : state.hovered;
    if (!pixel || !state.snapshot) {
        dimText("Point at the picture; a click pins a pixel.");
        return;
    }
    {
        const WithFont mono(ui().fonts.mono);
        ImGui::Text("(%d, %d)", pixel->x, pixel->y);
    }
    ImGui::SameLine(0, px(10));
    smallText(state.pinned ? "pinned; click it again to release" : "under the pointer",
              state.pinned ? palette::kAccent : palette::kDim);
    const auto lineage = state.snapshot->lineages.find(state.module(state.activePane));
    if (state.pinned && lineage != state.snapshot->lineages.end() && lineage->second.pixel == *pixel)
        drawLineage(lineage->second);
    if (!ImGui::BeginTable("pixel", 2, ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("buffer", ImGuiTableColumnFlags_WidthFixed, px(104));
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch);
    const std::string shown = state.buffer(state.activePane);
    for (const PixelValue& row : state.session.inspect(*state.snapshot, *pixel)) drawRow(row, row.buffer == shown);
    ImGui::EndTable();
}

}  // namespace lumi

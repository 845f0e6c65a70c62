#include "ui/widgets.h"

#include <algorithm>
#include <vector>

namespace lumi {

namespace {

ImU32 buttonFill(bool hovered, bool held, bool on) {
    if (held) return palette::kActive;
    if (hovered) return palette::kHovered;
    return on ? palette::kRaised : IM_COL32(0, 0, 0, 0);
}

void drawTextCentred(ImDrawList& list, const ImRect& box, const char* text, ImU32 colour) {
    const ImVec2 size = ImGui::CalcTextSize(text);
    const ImVec2 at(std::floor(box.GetCenter().x - 0.5f * size.x), std::floor(box.GetCenter().y - 0.5f * size.y));
    list.AddText(at, colour, text);
}

}  // namespace

bool iconButton(const char* name, Icon icon, const std::string& tip, bool on, float design) {
    const ImVec2 size(px(design), px(design));
    const bool clicked = ImGui::InvisibleButton(name, size);
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    markItem(name);
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(box.Min, box.Max, buttonFill(hovered, ImGui::IsItemActive(), on), px(5));
    const float alpha = ImGui::GetStyle().Alpha;
    const ImU32 colour = on ? palette::kAccent : hovered ? palette::kText : IM_COL32(190, 193, 200, 255);
    drawIcon(list, icon, box.GetCenter(), px(design * 0.5f), withAlpha(colour, alpha));
    if (hovered) tooltip(tip);
    return clicked;
}

bool textButton(const char* name, const std::string& text, const Icon* icon, bool primary, float width) {
    const float height = px(30), iconSpace = icon ? px(24) : 0;
    const float natural = ImGui::CalcTextSize(text.c_str()).x + px(24) + iconSpace;
    const ImVec2 size(width > 0 ? width : natural, height);
    const bool clicked = ImGui::InvisibleButton(name, size);
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    markItem(name);
    const bool hovered = ImGui::IsItemHovered(), held = ImGui::IsItemActive();
    ImU32 fill = held ? palette::kActive : hovered ? palette::kHovered : palette::kRaised;
    if (primary)
        fill = held ? palette::kAccentDeep : hovered ? IM_COL32(56, 122, 202, 255) : IM_COL32(44, 108, 184, 255);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float alpha = ImGui::GetStyle().Alpha;
    list.AddRectFilled(box.Min, box.Max, withAlpha(fill, alpha), px(5));
    if (icon)
        drawIcon(list, *icon, ImVec2(box.Min.x + px(19), box.GetCenter().y), px(14), withAlpha(palette::kText, alpha));
    drawTextCentred(list, ImRect(ImVec2(box.Min.x + iconSpace, box.Min.y), box.Max), text.c_str(),
                    withAlpha(primary ? palette::kOnAccent : palette::kText, alpha));
    return clicked;
}

int segments(const char* name, std::initializer_list<const char*> texts, int chosen, float width) {
    const float total = width > 0 ? width : ImGui::GetContentRegionAvail().x;
    const float each = std::floor(total / static_cast<float>(texts.size())), height = px(26);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(each * static_cast<float>(texts.size()), height), palette::kRaised,
                       px(5));
    ImGui::PushID(name);
    int clicked = -1, index = 0;
    for (const char* text : texts) {
        ImGui::SetCursorScreenPos(corner + ImVec2(each * static_cast<float>(index), 0));
        if (ImGui::InvisibleButton(text, ImVec2(each, height))) clicked = index;
        markItem(std::string(name) + ":" + text);
        const ImRect box(ImGui::GetItemRectMin() + ImVec2(px(2), px(2)),
                         ImGui::GetItemRectMax() - ImVec2(px(2), px(2)));
        if (index == chosen) list.AddRectFilled(box.Min, box.Max, palette::kAccentDeep, px(4));
        else if (ImGui::IsItemHovered()) list.AddRectFilled(box.Min, box.Max, palette::kHovered, px(4));
        drawTextCentred(list, box, text, index == chosen ? palette::kOnAccent : palette::kDim);
        ++index;
    }
    ImGui::PopID();
    return clicked;
}

int iconSegments(const char* name, std::initializer_list<Icon> icons, std::initializer_list<const char*> tips,
                 int chosen) {
    const ImVec2 each(px(34), px(28)), corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, corner + ImVec2(each.x * static_cast<float>(icons.size()), each.y), palette::kRaised,
                       px(5));
    ImGui::PushID(name);
    int clicked = -1;
    for (size_t i = 0; i < icons.size(); ++i) {
        const int index = static_cast<int>(i);
        ImGui::SetCursorScreenPos(corner + ImVec2(each.x * static_cast<float>(i), 0));
        if (ImGui::InvisibleButton(tips.begin()[i], each)) clicked = index;
        markItem(std::string(name) + ":" + tips.begin()[i]);
        const ImRect box(ImGui::GetItemRectMin() + ImVec2(px(2), px(2)),
                         ImGui::GetItemRectMax() - ImVec2(px(2), px(2)));
        const bool hovered = ImGui::IsItemHovered();
        if (index == chosen) list.AddRectFilled(box.Min, box.Max, palette::kAccentDeep, px(4));
        else if (hovered) list.AddRectFilled(box.Min, box.Max, palette::kHovered, px(4));
        drawIcon(list, icons.begin()[i], box.GetCenter(), px(15), index == chosen ? palette::kOnAccent : palette::kDim);
        if (hovered) tooltip(tips.begin()[i], "", shortcutText(UiCommand::CycleLayout));
    }
    ImGui::PopID();
    return clicked;
}

bool toggleSwitch(const char* name, bool& value) {
    const ImVec2 size(px(34), px(18));
    const float offset = std::floor(0.5f * (ImGui::GetFrameHeight() - size.y));
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + offset);
    const bool clicked = ImGui::InvisibleButton(name, size);
    if (clicked) value = !value;
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float radius = 0.5f * size.y;
    const ImU32 track = value ? palette::kAccentDeep : ImGui::IsItemHovered() ? palette::kActive : palette::kHovered;
    list.AddRectFilled(box.Min, box.Max, track, radius);
    const float x = value ? box.Max.x - radius : box.Min.x + radius;
    list.AddCircleFilled(ImVec2(x, box.GetCenter().y), radius - px(3), value ? palette::kOnAccent : palette::kDim);
    return clicked;
}

void progressBar(float fraction, float width, float height, ImU32 colour) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::Dummy(ImVec2(width, height));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float rounding = 0.5f * height;
    list.AddRectFilled(corner, corner + ImVec2(width, height), palette::kHovered, rounding);
    float from = 0, to = std::clamp(fraction, 0.0f, 1.0f) * width;
    if (fraction < 0) {
        const float phase = 0.5f + 0.5f * std::sin(static_cast<float>(ImGui::GetTime()) * 2.5f);
        from = phase * 0.7f * width;
        to = from + 0.3f * width;
    }
    if (to - from >= 1) list.AddRectFilled(corner + ImVec2(from, 0), corner + ImVec2(to, height), colour, rounding);
}

void dimText(const std::string& text) { ImGui::TextColored(toVec4(palette::kDim), "%s", text.c_str()); }

void smallText(const std::string& text, ImU32 colour) {
    const WithFont font(ui().fonts.small);
    ImGui::TextColored(toVec4(colour), "%s", text.c_str());
}

void heading(const std::string& text) {
    const WithFont font(ui().fonts.strong);
    ImGui::TextUnformatted(text.c_str());
}

bool section(const char* title, bool openAtFirst) {
    ImGui::Dummy(ImVec2(0, px(2)));
    ImGui::SetNextItemOpen(openAtFirst, ImGuiCond_Once);
    const ImGuiID id = ImGui::GetID(title);
    const bool wasOpen = ImGui::GetStateStorage()->GetBool(id, openAtFirst);
    const ImVec2 size(ImGui::GetContentRegionAvail().x, px(26));
    const bool clicked = ImGui::InvisibleButton(title, size);
    markItem(std::string("section:") + title);
    const bool open = clicked ? !wasOpen : wasOpen;
    ImGui::GetStateStorage()->SetBool(id, open);
    const ImRect box(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 colour = ImGui::IsItemHovered() ? palette::kText : palette::kDim;
    const ImVec2 c(box.Min.x + px(5), box.GetCenter().y);
    if (open)
        list.AddTriangleFilled(c + ImVec2(-px(4), -px(2)), c + ImVec2(px(4), -px(2)), c + ImVec2(0, px(3)), colour);
    else list.AddTriangleFilled(c + ImVec2(-px(2), -px(4)), c + ImVec2(px(3), 0), c + ImVec2(-px(2), px(4)), colour);
    const WithFont font(ui().fonts.strong);
    list.AddText(ImVec2(box.Min.x + px(16), std::floor(c.y - 0.5f * ImGui::GetFontSize())), palette::kText, title);
    return open;
}

/// Below the item, or above it at the window's lower edge, so that it covers none of the item's neighbours.
static void placeTooltip() {
    const ImRect item(ImGui::GetItemRectMin(), ImGui::GetItemRectMax());
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const bool wide = item.GetWidth() > px(160), above = item.Max.y > window.y - px(90);
    const float x = wide ? ImGui::GetIO().MousePos.x : item.GetCenter().x;
    const float across = x > window.x - px(360) ? 1.0f : 0.0f;
    const float edge = wide ? x : across > 0 ? item.Max.x : item.Min.x;
    ImGui::SetNextWindowPos(ImVec2(edge, above ? item.Min.y - px(6) : item.Max.y + px(6)), ImGuiCond_Always,
                            ImVec2(across, above ? 1.0f : 0.0f));
}

void tooltip(const std::string& title, const std::string& text, const std::string& chord) {
    if (title.empty() && text.empty()) return;
    if (ImGui::GetCurrentContext()->HoveredIdTimer < 0.35f) return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(10), px(8)));
    placeTooltip();
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(px(340));
    ImGui::TextUnformatted(title.c_str());
    if (!chord.empty()) {
        ImGui::SameLine(0, px(14));
        ImGui::TextColored(toVec4(palette::kFaint), "%s", chord.c_str());
    }
    if (!text.empty()) smallText(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

std::string tipFor(const char* what, UiCommand command) { return std::string(what) + "   " + shortcutText(command); }

bool searchField(const char* name, std::string& text, const char* hint, float width) {
    ImGui::SetNextItemWidth(width);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(28), px(5)));
    const bool changed = ImGui::InputTextWithHint((std::string("##") + name).c_str(), hint, &text);
    ImGui::PopStyleVar();
    markItem(name);
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    drawIcon(*ImGui::GetWindowDrawList(), Icon::Search, ImVec2(low.x + px(15), 0.5f * (low.y + high.y)), px(13),
             palette::kDim);
    return changed;
}

namespace {

/// The first place from `at` on that is not inside a UTF-8 sequence.
size_t characterBoundary(const std::string& text, size_t at) {
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80) ++at;
    return at;
}

/// The text itself if it fits, else shorter(n) for the most bytes n that fit.
template <class Shorter>
std::string longestThatFits(const std::string& text, float width, Shorter&& shorter) {
    const auto fits = [&](const std::string& s) { return ImGui::CalcTextSize(s.c_str()).x <= width; };
    if (fits(text)) return text;
    size_t kept = 0, tooMuch = text.size();
    while (tooMuch - kept > 1) {
        const size_t middle = kept + (tooMuch - kept) / 2;
        (fits(shorter(middle)) ? kept : tooMuch) = middle;
    }
    return kept > 0 ? shorter(kept) : "…";
}

}  // namespace

std::string shortened(const std::string& text, float width) {
    return longestThatFits(text, width,
                           [&](size_t kept) { return text.substr(0, characterBoundary(text, kept)) + "…"; });
}

std::string elided(const std::string& text, float width) {
    return longestThatFits(text, width, [&](size_t kept) {
        const size_t head = characterBoundary(text, kept / 2),
                     tail = characterBoundary(text, text.size() - (kept - kept / 2));
        return text.substr(0, head) + "…" + text.substr(tail);
    });
}

}  // namespace lumi

#include "ui/parameter_widgets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr double kWidestSlider = 1e5;  ///< wider linear ranges are dragged, not slid
/// Below it a logarithmic slider that begins at 0 shows 0: what ImGui takes from the decimals of its format.
constexpr double kLeastOfLog = 1e-4;
constexpr const char* kLogFormat = "%.4g";

std::string rangeText(const ParameterInfo& info) {
    if (info.type != ParameterType::Number && info.type != ParameterType::Integer) return {};
    return fmt::format("{:.6g} to {:.6g}{}{}", info.min, info.max, info.unit.empty() ? "" : " ", info.unit);
}

/// Fixed decimals for ranges of everyday size, unless they would tell another number than `value`.
std::string numberFormat(const ParameterInfo& info, double value) {
    const double span = info.max - info.min, half = span <= 2 ? 0.5e-3 : 0.5e-2;
    std::string format = info.scale == Scale::Log || span > 50 ? kLogFormat : span <= 2 ? "%.3f" : "%.2f";
    if (value != 0 && std::abs(value) < 100 * half) format = kLogFormat;
    if (!info.unit.empty()) format += " " + info.unit;
    return format;
}

/// Where a value lies on a slider, in [0,1].
double positionOf(const ParameterInfo& info, double value) {
    if (info.scale == Scale::Linear) return (value - info.min) / (info.max - info.min);
    const double least = std::max(info.min, kLeastOfLog);
    return std::log(std::max(value, least) / least) / std::log(info.max / least);
}

/// The filled part of a slider, under ImGui's own, whose frame and grab are made invisible.
void drawFill(const ParameterInfo& info, double value, float width) {
    const double t = positionOf(info, value);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const bool hovered = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(corner, corner + ImVec2(width, height));
    list.AddRectFilled(corner, corner + ImVec2(width, height), hovered ? palette::kHovered : palette::kRaised, px(4));
    // A range with both signs is filled from zero, so that "unchanged" looks empty.
    const double zero =
        info.scale == Scale::Linear && info.min < 0 && info.max > 0 ? -info.min / (info.max - info.min) : 0;
    const auto from = static_cast<float>(std::min(zero, t)) * width,
               to = static_cast<float>(std::clamp(std::max(zero, t), 0.0, 1.0)) * width;
    if (to - from < 1) return;
    list.PushClipRect(corner + ImVec2(from, 0), corner + ImVec2(to, height), true);
    list.AddRectFilled(corner, corner + ImVec2(width, height), withAlpha(palette::kAccentDeep, hovered ? 0.95f : 0.75f),
                       px(4));
    list.PopClipRect();
}

bool numberWidget(const ParameterInfo& info, float& value, float width) {
    const auto low = static_cast<float>(info.min), high = static_cast<float>(info.max);
    const std::string format = numberFormat(info, static_cast<double>(value));
    ImGui::SetNextItemWidth(width);
    if (info.scale == Scale::Linear && info.max - info.min > kWidestSlider) {
        const float speed = std::max(std::abs(value) * 0.01f, 0.001f);
        return ImGui::DragFloat("##value", &value, speed, low, high, format.c_str(),
                                ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat);
    }
    drawFill(info, static_cast<double>(value), width);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, 0);
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, 0);
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, 0);
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, 0);
    const ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat |
                                   (info.scale == Scale::Log ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = ImGui::SliderFloat("##value", &value, low, high, format.c_str(), flags);
    ImGui::PopStyleColor(5);
    return changed;
}

bool integerWidget(const ParameterInfo& info, int& value, float width) {
    const int low = static_cast<int>(info.min), high = static_cast<int>(info.max);
    const std::string format = info.unit.empty() ? "%d" : "%d " + info.unit;
    ImGui::SetNextItemWidth(width);
    const bool wide = info.max - info.min > 4096;
    if (wide)
        return ImGui::DragInt("##value", &value, std::max(1.0f, 0.01f * static_cast<float>(std::abs(value))), low, high,
                              format.c_str(), ImGuiSliderFlags_AlwaysClamp);
    drawFill(info, value, width);
    ImGui::PushStyleColor(ImGuiCol_FrameBg, 0);
    ImGui::PushStyleColor(ImGuiCol_FrameBgHovered, 0);
    ImGui::PushStyleColor(ImGuiCol_FrameBgActive, 0);
    ImGui::PushStyleColor(ImGuiCol_SliderGrab, 0);
    ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, 0);
    const ImGuiSliderFlags flags =
        ImGuiSliderFlags_AlwaysClamp | (info.scale == Scale::Log ? ImGuiSliderFlags_Logarithmic : 0);
    const bool changed = ImGui::SliderInt("##value", &value, low, high, format.c_str(), flags);
    ImGui::PopStyleColor(5);
    return changed;
}

std::optional<std::string> choiceWidget(const ParameterInfo& info, const std::string& value, float width) {
    std::optional<std::string> chosen;
    ImGui::SetNextItemWidth(width);
    const bool open =
        ImGui::BeginCombo("##value", value.c_str(), ImGuiComboFlags_HeightLarge | ImGuiComboFlags_NoArrowButton);
    if (!open) {
        const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
        drawIcon(*ImGui::GetWindowDrawList(), Icon::Chevron, ImVec2(high.x - px(13), 0.5f * (low.y + high.y)), px(9),
                 palette::kDim);
        return chosen;
    }
    for (const std::string& option : info.options) {
        if (ImGui::Selectable(option.c_str(), option == value)) chosen = option;
        markItem(info.id + ":" + option);
        if (option == value) ImGui::SetItemDefaultFocus();
    }
    ImGui::EndCombo();
    return chosen;
}

/// As many of the value's digits as fit into `width`, at least two.
std::string fittingFormat(float value, float width) {
    for (int digits = 6; digits > 2; --digits) {
        const std::string text = fmt::format("{:.{}g}", value, digits);
        if (ImGui::CalcTextSize(text.c_str()).x <= width) return fmt::format("%.{}g", digits);
    }
    return "%.2g";
}

/// Three numbers that are dragged, each with as many digits as its field holds; the pointer over one shows them all.
bool tripleWidget(const ParameterInfo& info, Vec3& value, float width, float low, float high) {
    const float gap = px(4), field = std::floor((width - 2 * gap) / 3);
    const float speed = std::max(glm::length(value) * 0.005f, 0.002f);
    bool changed = false;
    ImGui::BeginGroup();
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine(0, gap);
        ImGui::PushID(i);
        ImGui::SetNextItemWidth(field);
        const std::string format = fittingFormat(value[i], field - px(6));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(3), ImGui::GetStyle().FramePadding.y));
        changed |= ImGui::DragFloat("##value", &value[i], speed, low, high, format.c_str(),
                                    ImGuiSliderFlags_NoRoundToFormat | (low < high ? ImGuiSliderFlags_AlwaysClamp : 0));
        ImGui::PopStyleVar();
        if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
            tooltip(info.label, fmt::format("{:.9g}, {:.9g}, {:.9g}", value.x, value.y, value.z));
        ImGui::PopID();
    }
    ImGui::EndGroup();
    return changed;
}

/// Numbers, and a swatch that opens a picker.
bool colourWidget(const ParameterInfo& info, Vec3& value, float width) {
    const float swatch = ImGui::GetFrameHeight(), gap = px(4);
    ImGuiColorEditFlags flags =
        ImGuiColorEditFlags_Float | ImGuiColorEditFlags_PickerHueWheel | ImGuiColorEditFlags_NoInputs;
    if (info.max > 1) flags |= ImGuiColorEditFlags_HDR;
    ImGui::BeginGroup();
    bool changed = tripleWidget(info, value, width - swatch - gap, 0, static_cast<float>(info.max));
    ImGui::SameLine(0, gap);
    changed |= ImGui::ColorEdit3("##picker", &value.x, flags);
    ImGui::EndGroup();
    value = glm::clamp(value, Vec3(0), Vec3(static_cast<float>(info.max)));
    return changed;
}

bool vectorWidget(const ParameterInfo& info, Vec3& value, float width) {
    return tripleWidget(info, value, width, 0, 0);
}

void valueWidget(const ParameterInfo& info, float width, ParameterEdit& edit) {
    ParameterValue value = info.value;
    bool changed = false;
    switch (info.type) {
        case ParameterType::Number: changed = numberWidget(info, std::get<float>(value), width); break;
        case ParameterType::Integer: changed = integerWidget(info, std::get<int>(value), width); break;
        case ParameterType::Toggle: changed = toggleSwitch("##value", std::get<bool>(value)); break;
        case ParameterType::Colour: changed = colourWidget(info, std::get<Vec3>(value), width); break;
        case ParameterType::Vector: changed = vectorWidget(info, std::get<Vec3>(value), width); break;
        case ParameterType::Choice:
            if (const auto chosen = choiceWidget(info, std::get<std::string>(value), width)) {
                value = *chosen;
                changed = edit.finished = true;
            }
            break;
        case ParameterType::Text:
            ImGui::SetNextItemWidth(width);
            changed = ImGui::InputText("##value", &std::get<std::string>(value), ImGuiInputTextFlags_EnterReturnsTrue);
            break;
    }
    if (changed) edit.value = value;
    if (info.type == ParameterType::Toggle) edit.finished = changed;
    if (ImGui::IsItemDeactivated()) edit.finished = true;
}

}  // namespace

ParameterEdit parameterRow(const ParameterInfo& info, bool changed) {
    ParameterEdit edit;
    ImGui::PushID(info.id.c_str());
    const float available = ImGui::GetContentRegionAvail().x, resetSpace = px(24);
    const float labelWidth = std::floor(kLabelShare * available), widgetWidth = available - labelWidth - resetSpace;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = ImGui::GetFrameHeight();
    ImGui::InvisibleButton("label", ImVec2(labelWidth - px(6), height));
    const bool labelHovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (changed) list.AddCircleFilled(corner + ImVec2(-px(7), 0.5f * height), px(2.5f), palette::kAccent);
    const std::string label = shortened(info.label, labelWidth - px(8));
    list.AddText(corner + ImVec2(0, std::floor(0.5f * (height - ImGui::GetFontSize()))),
                 changed || labelHovered ? palette::kText : palette::kDim, label.c_str());
    if (labelHovered) {
        const std::string range = rangeText(info);
        tooltip(info.label, info.help + (range.empty() ? "" : "\n" + range) + "\n" + info.id);
    }
    ImGui::SameLine();
    ImGui::SetCursorScreenPos(corner + ImVec2(labelWidth, 0));
    const ImVec2 widgetCorner = ImGui::GetCursorScreenPos();
    valueWidget(info, widgetWidth, edit);
    markRect(info.id, widgetCorner,
             widgetCorner + ImVec2(info.type == ParameterType::Toggle ? px(34) : widgetWidth, height));
    if (changed) {
        ImGui::SameLine();
        ImGui::SetCursorScreenPos(corner + ImVec2(available - px(20), 0.5f * (height - px(20))));
        edit.reset = iconButton(("reset:" + info.id).c_str(), Icon::Reset, "Reset", false, 20);
    }
    ImGui::SetCursorScreenPos(corner + ImVec2(0, height + ImGui::GetStyle().ItemSpacing.y));
    ImGui::PopID();
    return edit;
}

int parameterRows(AppState& state, const std::string& prefix, const std::string& search,
                  const std::set<std::string>& without) {
    int count = 0;
    for (const ParameterInfo* found : state.document.group(prefix)) {
        const ParameterInfo info = *found;  // the mirror may be refreshed while an edit is applied
        if (!info.active || without.count(info.id) ||
            (!search.empty() && !matches(search, info.label) && !matches(search, info.id)))
            continue;
        ++count;
        const ParameterEdit edit = parameterRow(info, state.document.changed(info.id));
        if (edit.value) state.set(info.id, *edit.value);
        if (edit.reset) state.reset({info.id});
        if (edit.finished) state.session.endEdit();
    }
    return count;
}

bool matches(const std::string& search, const std::string& text) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), search.begin(), search.end(), same) != text.end();
}

}  // namespace lumi

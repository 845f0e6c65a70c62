#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/viewport.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kSpacing = 18;     ///< design pixels between arrows
constexpr float kLeastLength = 3;  ///< of an arrow that is drawn

void drawArrow(ImDrawList& list, const ImVec2& from, const ImVec2& along) {
    const float length = std::hypot(along.x, along.y);
    const ImVec2 unit = along / length, side(-unit.y, unit.x), tip = from + along;
    const float head = std::min(px(5), 0.6f * length);
    const auto stroke = [&](ImU32 colour, float width) {
        list.AddLine(from, tip, colour, width);
        list.AddLine(tip, tip - unit * head + side * (0.5f * head), colour, width);
        list.AddLine(tip, tip - unit * head - side * (0.5f * head), colour, width);
    };
    stroke(IM_COL32(0, 0, 0, 170), px(3));
    stroke(IM_COL32(255, 255, 255, 230), px(1.2f));
}

/// The wheel's hues, and what its rim and the arrows stand for; `magnified` 0: there are none, and the rim's unit is
/// the buffer's.
void drawWheelLegend(const DisplayInfo& info, float magnified, const ImRect& visible) {
    const WithFont font(ui().fonts.small);
    const std::string first = fmt::format("rim {:.3g}{}", info.high, magnified > 0 ? " px" : "");
    const std::string second = magnified == 0   ? ""
                               : magnified == 1 ? "arrows to where it was"
                                                : fmt::format("arrows to where it was, x{:g}", magnified);
    const float radius = px(15),
                width = 2 * radius + px(10) +
                        std::max(ImGui::CalcTextSize(first.c_str()).x, ImGui::CalcTextSize(second.c_str()).x);
    if (visible.GetWidth() < width + px(60)) return;
    const ImVec2 corner(visible.Max.x - width - px(22), visible.Max.y - px(52));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner - ImVec2(px(10), px(8)), corner + ImVec2(width + px(10), 2 * radius + px(8)),
                       palette::kOverlay, px(5));
    const ImVec2 centre = corner + ImVec2(radius, radius);
    constexpr int kSectors = 36;
    for (int i = 0; i < kSectors; ++i) {
        const auto at = [&](float part) {
            const float angle = part * 2 * kPi / kSectors;
            return centre + ImVec2(std::cos(angle), std::sin(angle)) * radius;
        };
        const float middle = static_cast<float>(i) + 0.5f;
        const Vec3 c = colourMapValue("wheel", middle / kSectors);
        const ImU32 colour = ImGui::ColorConvertFloat4ToU32(ImVec4(c.x, c.y, c.z, 1));
        list.AddTriangleFilled(centre, at(middle - 0.55f), at(middle + 0.55f), colour);
    }
    const float left = corner.x + 2 * radius + px(10);
    list.AddText(ImVec2(left, corner.y), palette::kText, first.c_str());
    list.AddText(ImVec2(left, corner.y + px(16)), palette::kDim, second.c_str());
}

}  // namespace

void drawMotionArrows(AppState& state, int pane, const ImRect& rect, const ImRect& visible) {
    const PaneSnapshot* shown = state.pane(pane);
    const Image* image = state.bufferImage(pane);
    if (!shown || !isWheel(shown->info.colourMap) || !image || image->channels() < 2 || !(shown->info.high > 0)) return;
    if (shown->info.colourMap == "wheel") {
        drawWheelLegend(shown->info, 0, visible);
        return;
    }
    const float zoom = state.view.zoom(), spacing = px(kSpacing);
    // The rim's motion is as long as arrows are apart: magnified or shrunk by a power of two, so that it can be read
    // off.
    const float magnified = std::exp2(std::floor(std::log2(spacing / (shown->info.high * zoom))));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(visible.Min, visible.Max, true);
    const Vec2 low = state.view.pictureFromPane({visible.Min.x - rect.Min.x, visible.Min.y - rect.Min.y});
    const Vec2 high = state.view.pictureFromPane({visible.Max.x - rect.Min.x, visible.Max.y - rect.Min.y});
    const int step = std::max(1, static_cast<int>(std::lround(spacing / zoom)));
    const auto firstAt = [&](float from) { return std::max(0, static_cast<int>(from) / step * step) + step / 2; };
    for (int y = firstAt(low.y); y < std::min(image->height(), static_cast<int>(high.y) + 1); y += step)
        for (int x = firstAt(low.x); x < std::min(image->width(), static_cast<int>(high.x) + 1); x += step) {
            const ImVec2 along = ImVec2(image->at(0, x, y), image->at(1, x, y)) * (zoom * magnified);
            const float length = std::hypot(along.x, along.y);
            // What was off the image by far, and what is no number, has no arrow.
            if (!(length >= px(kLeastLength) && length < 20 * spacing)) continue;
            const Vec2 at = state.view.paneFromPicture({static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f});
            drawArrow(list, rect.Min + ImVec2(at.x, at.y), along);
        }
    list.PopClipRect();
    drawWheelLegend(shown->info, magnified, visible);
}

}  // namespace lumi

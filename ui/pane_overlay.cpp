#include <fmt/format.h>

#include <cmath>

#include "ui/viewport.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kValuesFromZoom = 44;  ///< design pixels a texel from which on values are written into it

std::string shortNumber(float value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    const float size = std::abs(value);
    if (size != 0 && (size < 1e-3f || size >= 1e4f)) return fmt::format("{:.1e}", value);
    return fmt::format("{:.3f}", value).substr(0, value < 0 ? 6 : 5);
}

ImU32 readableOn(const Image8& pixels, Pixel at) {
    const uint8_t* rgba = &pixels.rgba[4 * (static_cast<size_t>(at.y) * static_cast<size_t>(pixels.extent.width) +
                                            static_cast<size_t>(at.x))];
    const int brightness = (2126 * rgba[0] + 7152 * rgba[1] + 722 * rgba[2]) / 10000;
    return brightness > 118 ? IM_COL32(0, 0, 0, 230) : IM_COL32(255, 255, 255, 230);
}

/// Values of every visible pixel, one line a channel.
void drawPixelValues(AppState& state, int pane, const ImRect& rect, const ImRect& visible) {
    const float zoom = state.view.zoom();
    const PaneSnapshot* shown = state.pane(pane);
    const Image* image = state.bufferImage(pane);
    if (zoom < px(kValuesFromZoom) || !image || !shown || !shown->pixels || image->extent() != shown->pixels->extent)
        return;
    const Vec2 low = state.view.pictureFromPane({visible.Min.x - rect.Min.x, visible.Min.y - rect.Min.y});
    const Vec2 high = state.view.pictureFromPane({visible.Max.x - rect.Min.x, visible.Max.y - rect.Min.y});
    const int x0 = std::max(0, static_cast<int>(std::floor(low.x))),
              y0 = std::max(0, static_cast<int>(std::floor(low.y)));
    const int x1 = std::min(image->width() - 1, static_cast<int>(std::floor(high.x)));
    const int y1 = std::min(image->height() - 1, static_cast<int>(std::floor(high.y)));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImFont* font = ui().fonts.mono;
    const int lines = std::min(image->channels(), 4);
    const float size = std::clamp(zoom / (lines + 1.2f), px(8), px(13));
    list.PushClipRect(visible.Min, visible.Max, true);
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const Vec2 corner = state.view.paneFromPicture({x, y});
            const ImU32 colour = readableOn(*shown->pixels, {x, y});
            const float top = rect.Min.y + corner.y + 0.5f * (zoom - size * static_cast<float>(lines));
            for (int c = 0; c < lines; ++c) {
                const std::string text = shortNumber(image->at(c, x, y));
                const float width = font->CalcTextSizeA(size, 1e9f, 0, text.c_str()).x;
                const ImVec2 at(std::floor(rect.Min.x + corner.x + 0.5f * (zoom - width)),
                                std::floor(top + size * static_cast<float>(c)));
                list.AddText(font, size, at, colour, text.c_str());
            }
        }
    list.PopClipRect();
}

void drawPixelFrame(const AppState& state, Pixel pixel, const ImRect& rect, const ImRect& visible, ImU32 colour,
                    bool cross) {
    const Vec2 low = state.view.paneFromPicture({pixel.x, pixel.y});
    const Vec2 high = state.view.paneFromPicture({pixel.x + 1, pixel.y + 1});
    const ImVec2 a = rect.Min + ImVec2(low.x, low.y), b = rect.Min + ImVec2(high.x, high.y);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(visible.Min, visible.Max, true);
    if (state.view.zoom() >= 4) {
        list.AddRect(a - ImVec2(1, 1), b + ImVec2(1, 1), IM_COL32(0, 0, 0, 160), 0, 0, 1);
        list.AddRect(a, b, colour, 0, 0, px(1.5f));
    }
    if (cross) {
        const ImVec2 c = (a + b) * 0.5f;
        const float inner = std::max(px(5), 0.5f * (b.x - a.x) + px(2)), outer = inner + px(7);
        for (const ImVec2 d : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
            list.AddLine(c + d * inner, c + d * outer, IM_COL32(0, 0, 0, 160), px(3));
            list.AddLine(c + d * inner, c + d * outer, colour, px(1.5f));
        }
    }
    list.PopClipRect();
}

/// The colour map with its ends, at the bottom right of what is visible of the pane.
void drawColourBar(const DisplayInfo& info, const ImRect& visible) {
    if (!info.falseColour || info.colourMap == "ids" || isWheel(info.colourMap)) return;
    const float width = std::min(px(190), visible.GetWidth() - px(40)), height = px(8);
    if (width < px(80)) return;
    const ImVec2 corner(visible.Max.x - width - px(22), visible.Max.y - px(46));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner - ImVec2(px(10), px(8)), corner + ImVec2(width + px(10), px(32)), palette::kOverlay,
                       px(5));
    constexpr int kSteps = 48;
    const auto colour = [&](int i) {
        const Vec3 c = colourMapValue(info.colourMap, static_cast<float>(i) / kSteps);
        return ImGui::ColorConvertFloat4ToU32(ImVec4(c.x, c.y, c.z, 1));
    };
    for (int i = 0; i < kSteps; ++i) {
        const float x0 = corner.x + width * static_cast<float>(i) / kSteps,
                    x1 = corner.x + width * static_cast<float>(i + 1) / kSteps;
        list.AddRectFilledMultiColor(ImVec2(x0, corner.y), ImVec2(x1, corner.y + height), colour(i), colour(i + 1),
                                     colour(i + 1), colour(i));
    }
    const WithFont font(ui().fonts.small);
    const std::string low = fmt::format("{:.4g}", info.low), high = fmt::format("{:.4g}", info.high);
    const float y = corner.y + height + px(4);
    list.AddText(ImVec2(corner.x, y), palette::kText, low.c_str());
    list.AddText(ImVec2(corner.x + width - ImGui::CalcTextSize(high.c_str()).x, y), palette::kText, high.c_str());
    const float nameWidth = ImGui::CalcTextSize(info.colourMap.c_str()).x;
    list.AddText(ImVec2(corner.x + 0.5f * (width - nameWidth), y), palette::kDim, info.colourMap.c_str());
}

}  // namespace

void drawPaneOverlay(AppState& state, int pane, const ImRect& rect, const ImRect& visible) {
    if (visible.GetWidth() < 1) return;
    const auto map = state.shownMap(pane);
    const bool reference = state.showsReference();
    if (!map && !reference) {
        drawMotionArrows(state, pane, rect, visible);
        if (!drawSubpixelGrid(state, pane, rect, visible)) drawPixelValues(state, pane, rect, visible);
    }
    if (state.hovered && state.view.zoom() >= px(6))
        drawPixelFrame(state, *state.hovered, rect, visible, IM_COL32(255, 255, 255, 150), false);
    if (state.pinned) drawPixelFrame(state, *state.pinned, rect, visible, palette::kAccent, true);
    const PaneSnapshot* shown = state.pane(pane);
    if (map) drawColourBar(map->mapInfo, visible);
    else if (shown && !reference) drawColourBar(shown->info, visible);
}

}  // namespace lumi

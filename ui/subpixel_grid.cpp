#include <cmath>

#include "ui/viewport.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kFromZoom = 12;  ///< design pixels a pixel from which on its sub-pixels are drawn
constexpr int kSide = 4, kOccupancy = 3, kOcclusion = 4;  ///< sub-pixels along a side; channels of the buffer

}  // namespace

bool drawSubpixelGrid(AppState& state, int pane, const ImRect& rect, const ImRect& visible) {
    const PaneSnapshot* shown = state.pane(pane);
    const Image* image = state.bufferImage(pane);
    const float zoom = state.view.zoom();
    if (!shown || shown->buffer != "bitmasks" || !image || image->channels() <= kOcclusion || zoom < px(kFromZoom))
        return false;
    const Vec2 low = state.view.pictureFromPane({visible.Min.x - rect.Min.x, visible.Min.y - rect.Min.y});
    const Vec2 high = state.view.pictureFromPane({visible.Max.x - rect.Min.x, visible.Max.y - rect.Min.y});
    const int left = std::max(0, static_cast<int>(std::floor(low.x))),
              top = std::max(0, static_cast<int>(std::floor(low.y)));
    const int right = std::min(image->width() - 1, static_cast<int>(std::floor(high.x)));
    const int bottom = std::min(image->height() - 1, static_cast<int>(std::floor(high.y)));
    constexpr ImU32 kPaper = IM_COL32(244, 244, 240, 255), kLine = IM_COL32(208, 208, 202, 255),
                    kEdge = IM_COL32(120, 120, 116, 255);
    constexpr ImU32 kVisible = IM_COL32(32, 92, 224, 255), kOccluded = IM_COL32(222, 48, 40, 255);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(visible.Min, visible.Max, true);
    const float cell = zoom / kSide;
    for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x) {
            const Vec2 place = state.view.paneFromPicture({x, y});
            const ImVec2 corner = rect.Min + ImVec2(place.x, place.y), end = corner + ImVec2(zoom, zoom);
            list.AddRectFilled(corner, end, kPaper);
            for (int line = 1; line < kSide && zoom >= px(2 * kFromZoom); ++line) {
                const float at = cell * static_cast<float>(line);
                list.AddLine(corner + ImVec2(at, 0), ImVec2(corner.x + at, end.y), kLine);
                list.AddLine(corner + ImVec2(0, at), ImVec2(end.x, corner.y + at), kLine);
            }
            const auto occupied = static_cast<unsigned>(image->at(kOccupancy, x, y)),
                       hidden = static_cast<unsigned>(image->at(kOcclusion, x, y));
            for (int sub = 0; sub < kSide * kSide; ++sub) {
                if (!(occupied >> sub & 1u)) continue;
                const ImVec2 centre =
                    corner +
                    ImVec2(static_cast<float>(sub % kSide) + 0.5f, static_cast<float>(sub / kSide) + 0.5f) * cell;
                list.AddCircleFilled(centre, 0.36f * cell, hidden >> sub & 1u ? kOccluded : kVisible);
            }
            list.AddRect(corner, end, kEdge);
        }
    list.PopClipRect();
    return true;
}

}  // namespace lumi

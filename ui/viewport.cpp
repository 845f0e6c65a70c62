#include "ui/viewport.h"

#include <cmath>

#include "ui/widgets.h"

namespace lumi {

namespace {

constexpr float kGridFromZoom = 12;  ///< design pixels a texel from which on the grid begins to show
constexpr float kLoupeZoom = 8;

float gridOpacity(float zoom) {
    const float design = zoom / ui().scale;
    return std::clamp((design - kGridFromZoom) / kGridFromZoom, 0.0f, 1.0f) * 0.22f;
}

PanePicture picture(const AppState& state, const ImRect& rect, int left, int right, float wipeX) {
    PanePicture pane;
    pane.corner = {rect.Min.x, rect.Min.y};
    pane.size = {rect.GetWidth(), rect.GetHeight()};
    pane.left = left;
    pane.right = right;
    pane.origin = state.view.origin();
    pane.zoom = state.view.zoom();
    pane.wipeX = wipeX;
    pane.grid = gridOpacity(pane.zoom);
    return pane;
}

/// The wipe's handle: drag moves it, double click centres it. True while it has the mouse.
bool wipeHandle(AppState& state, const ImRect& area) {
    const float x = std::floor(area.Min.x + state.wipe * area.GetWidth());
    ImGui::SetCursorScreenPos(ImVec2(x - px(7), area.Min.y));
    ImGui::InvisibleButton("wipe", ImVec2(px(14), area.GetHeight()));
    markItem("wipe");
    const bool held = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
    if (held || ImGui::IsItemDeactivated())  // the last move and the release may come in one frame
        state.wipe = std::clamp((ImGui::GetIO().MousePos.x - area.Min.x) / area.GetWidth(), 0.0f, 1.0f);
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) state.wipe = 0.5f;
    if (hovered || held) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);

    const float lineX = std::floor(area.Min.x + state.wipe * area.GetWidth()) + 0.5f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 colour = hovered || held ? palette::kAccent : IM_COL32(255, 255, 255, 210);
    list.AddLine(ImVec2(lineX, area.Min.y), ImVec2(lineX, area.Max.y), IM_COL32(0, 0, 0, 110), px(3));
    list.AddLine(ImVec2(lineX, area.Min.y), ImVec2(lineX, area.Max.y), colour, px(1.5f));
    const ImVec2 knob(lineX, area.GetCenter().y);
    list.AddCircleFilled(knob, px(11), palette::kOverlay);
    list.AddCircle(knob, px(11), colour, 0, px(1.5f));
    list.AddTriangleFilled(knob + ImVec2(-px(6.5f), 0), knob + ImVec2(-px(2.5f), -px(4)),
                           knob + ImVec2(-px(2.5f), px(4)), colour);
    list.AddTriangleFilled(knob + ImVec2(px(6.5f), 0), knob + ImVec2(px(2.5f), px(4)), knob + ImVec2(px(2.5f), -px(4)),
                           colour);
    return hovered || held;
}

/// A magnified square that follows the pointer, drawn by the painter like a pane of its own.
void addLoupe(const AppState& state, const ImRect& rect, int index, std::vector<PanePicture>& panes) {
    if (!state.loupe || !state.hovered) return;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const float size = px(190);
    ImVec2 corner = mouse + ImVec2(px(22), px(22));
    if (corner.x + size > rect.Max.x) corner.x = mouse.x - px(22) - size;
    if (corner.y + size > rect.Max.y) corner.y = mouse.y - px(22) - size;
    corner = ImVec2(std::floor(corner.x), std::floor(corner.y));
    PanePicture loupe;
    loupe.corner = {corner.x, corner.y};
    loupe.size = {std::floor(size), std::floor(size)};
    loupe.left = loupe.right = index;
    loupe.zoom = std::max(px(kLoupeZoom), 2 * state.view.zoom());
    const Vec2 at = state.view.pictureFromPane({mouse.x - rect.Min.x, mouse.y - rect.Min.y});
    loupe.origin = glm::round(0.5f * loupe.size - (glm::floor(at) + 0.5f) * loupe.zoom);
    loupe.grid = gridOpacity(loupe.zoom) * 0.6f;
    panes.push_back(loupe);
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    list.AddRect(corner - ImVec2(1, 1), corner + ImVec2(size + 1, size + 1), palette::kAccent, px(3), 0, px(1.5f));
    const ImVec2 centre = corner + ImVec2(0.5f * size, 0.5f * size);
    const float half = 0.5f * loupe.zoom;
    list.AddRect(centre - ImVec2(half, half), centre + ImVec2(half, half), IM_COL32(255, 255, 255, 180), 0, 0, px(1));
}

int paneUnderMouse(const AppState& state, const std::vector<ImRect>& rects) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    if (state.layout() == Layout::SideBySide) return mouse.x >= rects[1].Min.x ? 1 : 0;
    if (state.layout() == Layout::Wipe) return mouse.x >= rects[0].Min.x + state.wipe * rects[0].GetWidth() ? 1 : 0;
    return 0;
}

}  // namespace

std::vector<ImRect> paneRects(const AppState& state, const ImRect& area) {
    if (state.layout() == Layout::Single) return {area};
    if (state.layout() == Layout::Wipe) return {area, area};
    const float gap = px(2), width = std::floor(0.5f * (area.GetWidth() - gap));
    const ImRect left(area.Min, ImVec2(area.Min.x + width, area.Max.y));
    return {left, ImRect(ImVec2(left.Max.x + gap, area.Min.y), ImVec2(left.Max.x + gap + width, area.Max.y))};
}

std::vector<PanePicture> drawViewport(AppState& state, const ImRect& area) {
    ImGui::SetNextWindowPos(area.Min);
    ImGui::SetNextWindowSize(area.GetSize());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("viewport", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar(2);

    const std::vector<ImRect> rects = paneRects(state, area);
    const Extent2 extent = state.snapshot ? state.snapshot->extent : Extent2{16, 9};
    state.view.update({rects[0].GetWidth(), rects[0].GetHeight()}, extent);
    state.hoveredPaneSize = {rects[0].GetWidth(), rects[0].GetHeight()};

    ImGui::SetCursorScreenPos(area.Min);
    ImGui::SetItemAllowOverlap();
    ImGui::InvisibleButton(
        "picture", area.GetSize(),
        ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::SetItemAllowOverlap();
    markItem("picture");
    const int under = paneUnderMouse(state, rects);
    if (state.document.present()) handleViewportInput(state, rects[static_cast<size_t>(under)]);
    if (ImGui::IsItemClicked() && under < state.paneCount()) state.activePane = under;

    std::vector<PanePicture> pictures;
    if (!state.snapshot) {
        ImGui::End();
        return pictures;
    }
    const auto available = [&](int pane) { return state.pane(pane) ? pane : 0; };
    if (state.layout() == Layout::Wipe) {
        const float wipeX = std::floor(state.wipe * area.GetWidth());
        pictures.push_back(picture(state, area, 0, available(1), wipeX));
        const float x = area.Min.x + wipeX;
        drawPaneOverlay(state, 0, area, ImRect(area.Min, ImVec2(x, area.Max.y)));
        drawPaneOverlay(state, 1, area, ImRect(ImVec2(x, area.Min.y), area.Max));
        wipeHandle(state, area);
    } else {
        for (size_t i = 0; i < rects.size(); ++i) {
            const int index = static_cast<int>(i);
            pictures.push_back(picture(state, rects[i], available(index), available(index), 1e9f));
            drawPaneOverlay(state, index, rects[i], rects[i]);
        }
    }
    for (int pane = 0; pane < state.paneCount(); ++pane)
        drawPaneLabel(state, pane, rects[static_cast<size_t>(pane)], state.layout() == Layout::Wipe && pane == 1);
    addLoupe(state, rects[static_cast<size_t>(under)], available(under), pictures);
    ImGui::End();
    return pictures;
}

}  // namespace lumi

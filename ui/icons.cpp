#include "ui/icons.h"

#include <array>
#include <initializer_list>

#include "ui/theme.h"

namespace lumi {

namespace {

/// Draws in a box from -1 to 1.
class Pen {
public:
    Pen(ImDrawList& list, ImVec2 centre, float size, ImU32 colour)
        : list_(list), centre_(centre), half_(0.5f * size), colour_(colour), width_(ImMax(1.0f, size * 0.095f)) {}

    ImVec2 at(float x, float y) const { return centre_ + ImVec2(x, y) * half_; }
    void line(std::initializer_list<ImVec2> points, bool closed = false) const {
        for (const ImVec2& p : points) list_.PathLineTo(at(p.x, p.y));
        list_.PathStroke(colour_, closed ? ImDrawFlags_Closed : 0, width_);
    }
    void filled(std::initializer_list<ImVec2> points) const {
        for (const ImVec2& p : points) list_.PathLineTo(at(p.x, p.y));
        list_.PathFillConvex(colour_);
    }
    void box(float x0, float y0, float x1, float y1, float rounding = 0.2f) const {
        list_.AddRect(at(x0, y0), at(x1, y1), colour_, rounding * half_, 0, width_);
    }
    void bar(float x0, float y0, float x1, float y1) const {
        list_.AddRectFilled(at(x0, y0), at(x1, y1), colour_, 0.08f * half_);
    }
    void circle(float x, float y, float r) const { list_.AddCircle(at(x, y), r * half_, colour_, 0, width_); }
    void dot(float x, float y, float r) const { list_.AddCircleFilled(at(x, y), r * half_, colour_); }
    void arc(float r, float from, float to) const {
        list_.PathArcTo(centre_, r * half_, from, to);
        list_.PathStroke(colour_, 0, width_);
    }

private:
    ImDrawList& list_;
    ImVec2 centre_;
    float half_;
    ImU32 colour_;
    float width_;
};

void drawTransport(const Pen& pen, Icon icon) {
    switch (icon) {
        case Icon::Play: pen.filled({{-0.5f, -0.75f}, {0.75f, 0}, {-0.5f, 0.75f}}); break;
        case Icon::Pause:
            pen.bar(-0.6f, -0.7f, -0.15f, 0.7f);
            pen.bar(0.15f, -0.7f, 0.6f, 0.7f);
            break;
        case Icon::Step:
            pen.filled({{-0.7f, -0.65f}, {0.35f, 0}, {-0.7f, 0.65f}});
            pen.bar(0.45f, -0.65f, 0.7f, 0.65f);
            break;
        case Icon::StepBack:
            pen.filled({{0.7f, -0.65f}, {0.7f, 0.65f}, {-0.35f, 0}});
            pen.bar(-0.7f, -0.65f, -0.45f, 0.65f);
            break;
        case Icon::Restart:
        case Icon::Reset:
            pen.arc(0.66f, -1.1f, 3.9f);
            pen.filled({{0.05f, -1.0f}, {0.72f, -0.62f}, {0.02f, -0.22f}});
            break;
        case Icon::Undo:
            pen.line({{-0.75f, -0.15f}, {0.25f, -0.15f}, {0.62f, 0.02f}, {0.72f, 0.3f}, {0.6f, 0.6f}, {0.2f, 0.75f}});
            pen.line({{-0.35f, -0.6f}, {-0.8f, -0.15f}, {-0.35f, 0.3f}});
            break;
        case Icon::Redo:
            pen.line(
                {{0.75f, -0.15f}, {-0.25f, -0.15f}, {-0.62f, 0.02f}, {-0.72f, 0.3f}, {-0.6f, 0.6f}, {-0.2f, 0.75f}});
            pen.line({{0.35f, -0.6f}, {0.8f, -0.15f}, {0.35f, 0.3f}});
            break;
        default: break;
    }
}

void drawPane(const Pen& pen, Icon icon) {
    switch (icon) {
        case Icon::Single: pen.box(-0.85f, -0.65f, 0.85f, 0.65f); break;
        case Icon::SideBySide:
            pen.box(-0.9f, -0.65f, -0.1f, 0.65f);
            pen.box(0.1f, -0.65f, 0.9f, 0.65f);
            break;
        case Icon::Wipe:
            pen.box(-0.85f, -0.65f, 0.85f, 0.65f);
            pen.bar(-0.06f, -0.95f, 0.06f, 0.95f);
            pen.bar(-0.75f, -0.55f, 0, 0.55f);
            break;
        case Icon::Fit:
            pen.line({{-0.8f, -0.3f}, {-0.8f, -0.8f}, {-0.3f, -0.8f}});
            pen.line({{0.3f, -0.8f}, {0.8f, -0.8f}, {0.8f, -0.3f}});
            pen.line({{0.8f, 0.3f}, {0.8f, 0.8f}, {0.3f, 0.8f}});
            pen.line({{-0.3f, 0.8f}, {-0.8f, 0.8f}, {-0.8f, 0.3f}});
            break;
        case Icon::Layers:
            pen.line({{0, -0.8f}, {0.85f, -0.35f}, {0, 0.1f}, {-0.85f, -0.35f}}, true);
            pen.line({{-0.85f, 0.15f}, {0, 0.6f}, {0.85f, 0.15f}});
            break;
        case Icon::Search:
        case Icon::Loupe:
            pen.circle(-0.15f, -0.15f, 0.55f);
            pen.line({{0.27f, 0.27f}, {0.8f, 0.8f}});
            break;
        default: break;
    }
}

void drawSign(const Pen& pen, Icon icon) {
    switch (icon) {
        case Icon::Camera:
            pen.box(-0.9f, -0.45f, 0.9f, 0.7f);
            pen.circle(0, 0.12f, 0.33f);
            pen.line({{-0.35f, -0.45f}, {-0.2f, -0.75f}, {0.2f, -0.75f}, {0.35f, -0.45f}});
            break;
        case Icon::Folder:
            pen.line(
                {{-0.85f, 0.65f}, {-0.85f, -0.6f}, {-0.25f, -0.6f}, {-0.05f, -0.35f}, {0.85f, -0.35f}, {0.85f, 0.65f}},
                true);
            break;
        case Icon::Close:
            pen.line({{-0.6f, -0.6f}, {0.6f, 0.6f}});
            pen.line({{0.6f, -0.6f}, {-0.6f, 0.6f}});
            break;
        case Icon::Chevron: pen.line({{-0.5f, -0.25f}, {0, 0.25f}, {0.5f, -0.25f}}); break;
        case Icon::Warning:
            pen.line({{0, -0.8f}, {0.9f, 0.7f}, {-0.9f, 0.7f}}, true);
            pen.line({{0, -0.25f}, {0, 0.2f}});
            pen.dot(0, 0.45f, 0.08f);
            break;
        case Icon::Error:
            pen.circle(0, 0, 0.82f);
            pen.line({{-0.32f, -0.32f}, {0.32f, 0.32f}});
            pen.line({{0.32f, -0.32f}, {-0.32f, 0.32f}});
            break;
        case Icon::Info:
            pen.circle(0, 0, 0.82f);
            pen.line({{0, -0.05f}, {0, 0.45f}});
            pen.dot(0, -0.38f, 0.09f);
            break;
        case Icon::Help:
            pen.circle(0, 0, 0.85f);
            pen.line({{-0.27f, -0.22f},
                      {-0.15f, -0.42f},
                      {0.12f, -0.45f},
                      {0.28f, -0.25f},
                      {0.2f, -0.02f},
                      {0, 0.12f},
                      {0, 0.22f}});
            pen.dot(0, 0.46f, 0.09f);
            break;
        case Icon::Bookmark:
            pen.line({{-0.5f, -0.8f}, {0.5f, -0.8f}, {0.5f, 0.8f}, {0, 0.35f}, {-0.5f, 0.8f}}, true);
            break;
        case Icon::Eye:
            pen.line({{-0.9f, 0},
                      {-0.45f, -0.42f},
                      {0, -0.55f},
                      {0.45f, -0.42f},
                      {0.9f, 0},
                      {0.45f, 0.42f},
                      {0, 0.55f},
                      {-0.45f, 0.42f}},
                     true);
            pen.dot(0, 0, 0.24f);
            break;
        case Icon::Pin:
            pen.circle(0, -0.25f, 0.45f);
            pen.line({{0, 0.2f}, {0, 0.9f}});
            break;
        case Icon::Lens: pen.circle(0, 0, 0.8f); break;
        default: break;
    }
}

}  // namespace

void drawIcon(ImDrawList& list, Icon icon, ImVec2 centre, float size, ImU32 colour) {
    const Pen pen(list, centre, size, colour);
    drawTransport(pen, icon);
    drawPane(pen, icon);
    drawSign(pen, icon);
}

void drawMark(ImDrawList& list, ImVec2 centre, float size) {
    constexpr std::array kBeams{IM_COL32(255, 107, 107, 255), IM_COL32(255, 206, 92, 255), IM_COL32(102, 217, 155, 255),
                                IM_COL32(88, 166, 255, 255)};
    const float r = 0.5f * size;
    list.AddCircle(centre, 0.92f * r, palette::kText, 0, ImMax(1.0f, 0.13f * r));
    for (size_t i = 0; i < kBeams.size(); ++i) {
        const float angle = -0.55f + 0.367f * static_cast<float>(i);
        const ImVec2 end = centre + ImVec2(std::cos(angle), std::sin(angle)) * (0.78f * r);
        list.AddLine(centre - ImVec2(0.25f * r, 0), end, kBeams[i], ImMax(1.0f, 0.15f * r));
    }
    list.AddLine(centre - ImVec2(0.78f * r, 0), centre - ImVec2(0.2f * r, 0), palette::kText, ImMax(1.0f, 0.15f * r));
}

}  // namespace lumi

#pragma once
#include <vector>

#include "ui/app_state.h"
#include "ui/context.h"
#include "ui/image_painter.h"

namespace lumi {

/// The picture area: one or two panes, the camera and the zoom under the mouse. Returns what the painter puts under the
/// UI. `area` is in framebuffer pixels.
std::vector<PanePicture> drawViewport(AppState& state, const ImRect& area);

/// The rectangles of the panes in `area`: one, or two of equal size beside each other. With a wipe both are `area`.
std::vector<ImRect> paneRects(const AppState& state, const ImRect& area);

/// Flies, orbits and slides the camera, zooms and moves the picture, from the mouse over the viewport's item, which was
/// drawn last. `pane` is under the pointer.
void handleViewportInput(AppState& state, const ImRect& pane);

/// A grid of arrows over a buffer of motion (colour map `motion`), from pixels to where they were a frame earlier, and
/// the wheel.
void drawMotionArrows(AppState& state, int pane, const ImRect& rect, const ImRect& visible);
/// The 4x4 sub-pixels of every visible pixel of the buffer `bitmasks`, if it is zoomed in that far: blue samples are
/// visible, red ones occluded [DalCorso17, fig. 6]. Returns whether they were drawn.
bool drawSubpixelGrid(AppState& state, int pane, const ImRect& rect, const ImRect& visible);
/// What is written over the pane: chips, colour bar, arrows, pixel values, marks. `half` is the visible part under a
/// wipe.
void drawPaneOverlay(AppState& state, int pane, const ImRect& rect, const ImRect& visible);
/// Chips with module and buffer, and the words that say exactly what is shown.
void drawPaneLabel(AppState& state, int pane, const ImRect& rect, bool alignRight);
/// The popup of a pane that chooses its buffer by name; opened by openBufferPicker().
void openBufferPicker(int pane);
void drawBufferPicker(AppState& state, int pane);

}  // namespace lumi

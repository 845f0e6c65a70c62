#include <fmt/format.h>

#include "ui/commands.h"
#include "ui/inspector.h"
#include "ui/panels/panels.h"
#include "ui/parameter_widgets.h"
#include "ui/widgets.h"

namespace lumi {

namespace {

/// Which pane the settings below belong to.
void drawPaneChoice(AppState& state) {
    if (state.paneCount() < 2) return;
    const std::string a = fmt::format("A   {}", state.buffer(0)), b = fmt::format("B   {}", state.buffer(1));
    const int clicked = segments("pane-choice", {a.c_str(), b.c_str()}, state.activePane);
    if (clicked >= 0) state.activePane = clicked;
    ImGui::Dummy(ImVec2(0, px(2)));
}

void drawZoom(AppState& state) {
    const float zoom = state.view.zoom();
    smallText(zoom >= 1 ? fmt::format("Zoom {:.4g} : 1", zoom) : fmt::format("Zoom 1 : {:.3g}", 1 / zoom));
    ImGui::SameLine(ImGui::GetContentRegionAvail().x - px(58));
    if (iconButton("fit", Icon::Fit, tipFor("Fit the picture", Command::Fit), state.view.fits(), 24)) runCommand(state, Command::Fit);
    ImGui::SameLine(0, px(4));
    if (iconButton("loupe", Icon::Loupe, tipFor("Loupe under the pointer", Command::Loupe), state.loupe, 24)) runCommand(state, Command::Loupe);
}

}  // namespace

void drawViewPanel(AppState& state) {
    drawPaneChoice(state);
    if (section("Display")) {
        const std::string prefix = state.viewId(state.activePane, "");
        parameterRows(state, prefix, "", {prefix + "module", prefix + "buffer"});
        drawZoom(state);
    }
    if (section("Pixel")) drawInspector(state);
}

}  // namespace lumi

#pragma once
#include "ui/app_state.h"
#include "ui/context.h"

namespace lumi {

// Each draws one part of the window into `area` (framebuffer pixels), or over it.

void drawToolbar(AppState& state, const ImRect& area);
void drawStatusBar(AppState& state, const ImRect& area);
/// The right-hand panel: a row of tabs and the panel chosen.
void drawSidePanel(AppState& state, const ImRect& area);

void drawViewPanel(AppState& state);
void drawRenderPanel(AppState& state);
void drawScenePanel(AppState& state);
void drawProfilePanel(AppState& state);
/// The reference, metrics of each view against it, error maps.
void drawMeasurePanel(AppState& state);
/// Metrics that are computed with every frame, as the panel is set.
std::vector<std::string> wantedMetrics(const AppState& state);
/// Samples a pixel of the reference that the panel asks for.
uint64_t referenceSamples(const AppState& state);
/// Cameras of the scene and bookmarks; a part of the scene panel.
void drawCameras(AppState& state);

/// The drawer above the status bar, and the newest message over the picture for a few seconds.
void drawMessages(AppState& state, const ImRect& area);
void drawToast(AppState& state, const ImRect& area);

/// The light that tells whether the scene's signals keep their contract, right-aligned in `area`; returns its left
/// edge.
float drawSignalsLight(AppState& state, const ImRect& area);
/// The drawer with every rule of the contract.
void drawSignals(AppState& state, const ImRect& area);

void drawHelp(AppState& state, const ImRect& area);
void drawSceneBrowser(AppState& state, const ImRect& area);
/// What stands where the picture will be: the welcome page before a scene is open, progress while one loads.
void drawEmptyPicture(AppState& state, const ImRect& area);

/// Window flags of parts that stay where they are put.
constexpr ImGuiWindowFlags kFixedWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                          ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
/// Begins a window of exactly `area`, behind those that open over it.
void beginFixed(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags extra = 0);
/// The same in front of what is fixed: a drawer, whose buttons have the mouse.
void beginDrawer(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding, ImGuiWindowFlags extra = 0);
/// In front as well, but it leaves the keyboard where it is: for news.
void beginCard(const char* name, const ImRect& area, ImU32 colour, ImVec2 padding);
void endFixed();

/// "Sponza" for /a/b/Sponza.gltf, or the scene's own title.
std::string sceneName(const AppState& state);

}  // namespace lumi

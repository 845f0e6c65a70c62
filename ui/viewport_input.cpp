#include <cmath>

#include "ui/camera_control.h"
#include "ui/shortcuts.h"
#include "ui/viewport.h"

namespace lumi {

namespace {

constexpr float kRadiansPerPixel = 0.0045f;  ///< design pixels
constexpr float kClickRadius = 4;            ///< design pixels a click may move

bool held(UiCommand command) {
    for (const Shortcut& row : shortcuts())
        if (row.held && row.command == command && ImGui::IsKeyDown(static_cast<int>(row.chord.key))) return true;
    return false;
}

/// Metres a second at speed 1: a scene is crossed in about ten seconds.
float baseSpeed(const AppState& state) {
    const float radius = state.snapshot && state.snapshot->scene ? state.snapshot->scene->bounds.radius() : 1.0f;
    return 0.2f * (std::isfinite(radius) && radius > 0 ? radius : 1.0f);
}

/// Movement keys act while the right button is held, or alone while nothing else takes the keyboard.
bool fly(AppState& state, Camera& camera) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool looking = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Right);
    if (state.helpOpen || state.browserOpen || io.WantTextInput || (io.KeyCtrl && !looking) || io.KeyAlt) return false;
    const auto axis = [](UiCommand plus, UiCommand minus) {
        return (held(plus) ? 1.0f : 0.0f) - (held(minus) ? 1.0f : 0.0f);
    };
    const Vec3 direction(axis(UiCommand::MoveRight, UiCommand::MoveLeft), axis(UiCommand::MoveUp, UiCommand::MoveDown),
                         axis(UiCommand::MoveForward, UiCommand::MoveBack));
    if (direction == Vec3(0)) return false;
    const float modifier = io.KeyShift ? 10.0f : io.KeyCtrl ? 0.25f : 1.0f;
    const float dt = std::min(io.DeltaTime, 0.1f);
    camera = flyBy(camera, direction * (baseSpeed(state) * state.flySpeed * modifier * dt));
    return true;
}

bool drag(AppState& state, Camera& camera, const ImRect& pane) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!ImGui::IsItemActive() || (io.MouseDelta.x == 0 && io.MouseDelta.y == 0)) return false;
    const Vec2 delta(io.MouseDelta.x, io.MouseDelta.y);
    const Vec2 angle = delta * (kRadiansPerPixel / ui().scale);
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        camera = lookAround(camera, -angle.x, -angle.y);
        return true;
    }
    if (ImGui::IsMouseDown(ImGuiMouseButton_Middle)) {
        state.view.pan(delta);
        return false;
    }
    if (!ImGui::IsMouseDragging(ImGuiMouseButton_Left, px(kClickRadius))) return false;
    if (io.KeyShift) {
        const float height =
            state.snapshot ? static_cast<float>(state.snapshot->extent.height) * state.view.zoom() : pane.GetHeight();
        camera = slide(camera, delta, height);
        return true;
    }
    if (state.leftDragOrbits || io.KeyAlt) {
        camera = orbit(camera, -angle.x, -angle.y);
        return true;
    }
    state.view.pan(delta);
    return false;
}

void wheel(AppState& state, const ImRect& pane) {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.MouseWheel == 0 || !(ImGui::IsItemHovered() || ImGui::IsItemActive())) return;
    if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
        state.flySpeed = std::clamp(state.flySpeed * std::pow(1.25f, io.MouseWheel), 0.01f, 100.0f);
        return;
    }
    state.view.zoomAt({io.MousePos.x - pane.Min.x, io.MousePos.y - pane.Min.y}, std::pow(1.25f, io.MouseWheel));
}

std::optional<Pixel> pixelUnderMouse(const AppState& state, const ImRect& pane) {
    if (!state.snapshot) return std::nullopt;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const Vec2 at = glm::floor(state.view.pictureFromPane({mouse.x - pane.Min.x, mouse.y - pane.Min.y}));
    const Pixel pixel{static_cast<int>(at.x), static_cast<int>(at.y)};
    const Extent2 extent = state.snapshot->extent;
    if (pixel.x < 0 || pixel.y < 0 || pixel.x >= extent.width || pixel.y >= extent.height) return std::nullopt;
    return pixel;
}

}  // namespace

void handleViewportInput(AppState& state, const ImRect& pane) {
    const bool over = ImGui::IsItemHovered() || ImGui::IsItemActive();
    state.hovered = over ? pixelUnderMouse(state, pane) : std::nullopt;

    Camera camera = state.document.camera();
    const bool flown = fly(state, camera), dragged = drag(state, camera, pane);
    if (flown || dragged) state.setCamera(camera);
    if (state.flying && !flown) state.session.endEdit();
    state.flying = flown;
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemDeactivated()) state.session.endEdit();
    wheel(state, pane);

    const bool released = ImGui::IsItemDeactivated() && io.MouseReleased[ImGuiMouseButton_Left];
    if (released && state.hovered && io.MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] < sqr(px(kClickRadius))) {
        const bool same = state.pinned && *state.pinned == *state.hovered;
        state.pinned = same ? std::nullopt : state.hovered;
    }
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left) && state.hovered) {
        state.orbitTarget = state.session.surfaceAt(*state.hovered);  // the surface under the pointer
    }
}

}  // namespace lumi

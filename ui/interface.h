#pragma once
#include <memory>

#include "gl/functions.h"
#include "ui/app_state.h"
#include "ui/draw_renderer.h"
#include "ui/image_painter.h"
#include "ui/input.h"
#include "ui/ui_map.h"

struct ImGuiContext;

namespace lumi {

struct UiContext;

enum class PointerShape { Arrow, Hand, Text, ResizeHorizontal, ResizeVertical, Move };

/// The whole user interface, for a window and for a framebuffer without one alike: give it events, then build and draw
/// one frame after the other. One at a time; the OpenGL context stays current while it lives.
class Interface {
public:
    Interface(const GlFunctions& gl, Session& session, MessageLog& log);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    InputQueue& input() { return input_; }
    AppState& state() { return state_; }
    const AppState& state() const { return state_; }
    UiMap& uiMap();

    /// Design pixels to framebuffer pixels; rebuilds fonts when it changes.
    void setScale(float scale);

    /// Takes events and the session's latest snapshot, and builds the frame. No OpenGL call is made; its CPU time is
    /// what AppState::timing holds.
    void build(Extent2 target, float elapsedSeconds);
    /// Draws what was built into the framebuffer that is bound.
    void draw(Extent2 target);

    PointerShape pointer() const;

    /// Has anything happened since the last frame that could change the screen?
    bool wantsFrame() const;
    /// Is a key or button held, or something on the move, so that frames should follow each other smoothly?
    bool busy() const;

private:
    void dispatch(const FrameInput& input);
    void layOut(Extent2 target);

    const GlFunctions& gl_;
    AppState state_;
    InputQueue input_;
    ImGuiContext* imgui_;
    std::unique_ptr<UiContext> context_;
    DrawRenderer renderer_;
    ImagePainter painter_;
    std::vector<PanePicture> pictures_;
    int framesToSettle_ = 0;  ///< frames still wanted after the last event: hovers, popups, layout
    uint64_t messagesSeen_ = 0;
    uint64_t revisionSeen_ = 0;
    std::shared_ptr<const SignalCheck> checkSeen_;
    std::shared_ptr<const LiveMeasurement> measuredSeen_;
    uint64_t referenceSeen_ = 0;
};

}  // namespace lumi

#include "ui/interface.h"

#include <algorithm>

#include "ui/commands.h"
#include "ui/open_report.h"
#include "ui/panels/panels.h"
#include "ui/theme.h"
#include "ui/viewport.h"

namespace lumi {

namespace {

constexpr int kSettlingFrames = 3;

ImGuiContext* makeContext() {
    IMGUI_CHECKVERSION();
    ImGuiContext* context = ImGui::CreateContext();
    ImGui::SetCurrentContext(context);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset | ImGuiBackendFlags_HasMouseCursors;
    io.MouseDragThreshold = 4;
    io.ConfigWindowsMoveFromTitleBarOnly = true;
    mapImGuiKeys();
    return context;
}

}  // namespace

Interface::Interface(const GlFunctions& gl, Session& session, MessageLog& log)
    : gl_(gl),
      state_(session, log),
      imgui_(makeContext()),
      context_(std::make_unique<UiContext>()),
      renderer_(gl),
      painter_(gl) {
    ImGui::GetIO().UserData = context_.get();
    context_->scale = 0;
    setScale(1);
}

Interface::~Interface() { ImGui::DestroyContext(imgui_); }

UiMap& Interface::uiMap() { return context_->map; }

void Interface::setScale(float scale) {
    if (scale == context_->scale) return;
    context_->scale = scale;
    applyTheme(scale);
    if (!loadFonts(context_->fonts, scale))
        state_.log.info("The packages fonts-inter and fonts-jetbrains-mono are not installed; a plain font stands in.");
    renderer_.uploadFonts();
}

void Interface::dispatch(const FrameInput& input) {
    for (const auto& path : input.dropped) {
        if (const auto report = reportAt(path); !report.empty()) openInBrowser(report, state_.log);
        else state_.open(path);
    }
    for (const KeyChord& chord : input.pressed) {
        const auto command = commandFor(chord);
        if (!command) continue;
        const bool typing = ImGui::GetIO().WantTextInput;
        const bool always =
            command->command == UiCommand::Quit || command->command == UiCommand::Help || chord.key >= Key::F1;
        if (typing && !always) continue;
        const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
        if (command->command == UiCommand::Close && popup) ImGui::ClosePopupToLevel(0, true);
        else runCommand(state_, command->command, command->index);
    }
}

void Interface::layOut(Extent2 target) {
    const ImVec2 size(static_cast<float>(target.width), static_cast<float>(target.height));
    const float bar = state_.uiHidden ? 0 : px(46), status = state_.uiHidden ? 0 : px(26);
    const float panel = state_.uiHidden || state_.panelHidden || size.x < px(560)
                            ? 0
                            : std::floor(std::clamp(0.27f * size.x, px(270), px(348)));
    state_.session.setCheckingScenes(state_.checkScenes);
    const bool inspects = panel > 0 && state_.tab == PanelTab::View;
    state_.session.setInspecting(inspects);
    state_.session.setInspectedPixel(inspects ? state_.pinned : std::nullopt);
    const ImRect picture(ImVec2(0, bar), ImVec2(size.x - panel, size.y - status));
    pictures_ = drawViewport(state_, picture);
    drawEmptyPicture(state_, picture);
    if (!state_.uiHidden) {
        drawToolbar(state_, ImRect(ImVec2(0, 0), ImVec2(size.x, bar)));
        if (panel > 0) drawSidePanel(state_, ImRect(ImVec2(size.x - panel, bar), ImVec2(size.x, size.y - status)));
        drawStatusBar(state_, ImRect(ImVec2(0, size.y - status), size));
    }
    drawMessages(state_, picture);
    drawSignals(state_, picture);
    drawSceneBrowser(state_, ImRect(ImVec2(0, bar), ImVec2(size.x, size.y - status)));
    drawHelp(state_, ImRect(ImVec2(0, 0), size));
    drawToast(state_, picture);
}

void Interface::build(Extent2 target, float elapsedSeconds) {
    const double begin = threadCpuMs();
    ImGui::SetCurrentContext(imgui_);
    ImGuiIO& io = ImGui::GetIO();
    framesToSettle_ = input_.empty() ? std::max(framesToSettle_ - 1, 0) : kSettlingFrames;
    messagesSeen_ = state_.log.serial();
    revisionSeen_ = state_.session.revision();
    checkSeen_ = state_.session.signalCheck();
    measuredSeen_ = state_.metrics.latest();
    referenceSeen_ = state_.referencePictures.serial();
    state_.metrics.choose(wantedMetrics(state_), state_.errorMap);
    const FrameInput input = input_.applyFrame();
    io.DisplaySize = ImVec2(static_cast<float>(target.width), static_cast<float>(target.height));
    io.DeltaTime = std::max(elapsedSeconds, 1e-4f);
    context_->map.clear();
    state_.beginFrame();
    ImGui::NewFrame();
    dispatch(input);
    layOut(target);
    ImGui::Render();
    state_.timing.add(threadCpuMs() - begin);
}

void Interface::draw(Extent2 target) {
    const ImVec4 background = toVec4(palette::kBackground);
    gl_.Viewport(0, 0, target.width, target.height);
    gl_.ClearColor(background.x, background.y, background.z, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    for (int pane = 0; pane < ImagePainter::kPictures; ++pane) painter_.setPicture(pane, state_.picture(pane));
    painter_.draw(pictures_, target, {background.x, background.y, background.z, 1});
    renderer_.draw(*ImGui::GetDrawData(), target);
}

bool Interface::busy() const {
    const ImGuiIO& io = imgui_->IO;
    const auto held = [](const auto& states) {
        return std::any_of(std::begin(states), std::end(states), [](bool down) { return down; });
    };
    return framesToSettle_ > 0 || held(io.MouseDown) || held(io.KeysDown) || state_.session.loadStatus().loading ||
           state_.session.checkingSignals() || state_.session.steppingBack() || state_.metrics.reference().working ||
           state_.orbitTarget.valid();
}

bool Interface::wantsFrame() const {
    if (!input_.empty() || busy()) return true;
    const auto latest = state_.session.snapshot();
    if (latest && (!state_.snapshot || latest->serial != state_.snapshot->serial)) return true;
    if (state_.session.signalCheck() != checkSeen_ || state_.metrics.latest() != measuredSeen_) return true;
    if (state_.referencePictures.serial() != referenceSeen_) return true;
    return state_.log.serial() != messagesSeen_ || state_.session.revision() != revisionSeen_;
}

PointerShape Interface::pointer() const {
    switch (ImGui::GetMouseCursor()) {
        case ImGuiMouseCursor_TextInput: return PointerShape::Text;
        case ImGuiMouseCursor_ResizeEW: return PointerShape::ResizeHorizontal;
        case ImGuiMouseCursor_ResizeNS: return PointerShape::ResizeVertical;
        case ImGuiMouseCursor_ResizeAll: return PointerShape::Move;
        case ImGuiMouseCursor_Hand: return PointerShape::Hand;
        default: return PointerShape::Arrow;
    }
}

}  // namespace lumi

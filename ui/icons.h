#pragma once
#include "ui/context.h"

namespace lumi {

enum class Icon {
    Play,
    Pause,
    Step,
    StepBack,
    Restart,
    Camera,
    Folder,
    Help,
    Close,
    Chevron,
    Single,
    SideBySide,
    Wipe,
    Search,
    Undo,
    Redo,
    Warning,
    Error,
    Info,
    Fit,
    Loupe,
    Reset,
    Bookmark,
    Eye,
    Pin,
    Layers,
    Lens
};

/// Draws an icon as lines, sharp at any scale; `size` is the edge of its box in framebuffer pixels.
void drawIcon(ImDrawList& list, Icon icon, ImVec2 centre, float size, ImU32 colour);

/// The program's mark: a lens that splits light.
void drawMark(ImDrawList& list, ImVec2 centre, float size);

}  // namespace lumi

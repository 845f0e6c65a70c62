#pragma once
#define IMGUI_DEFINE_MATH_OPERATORS
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <string>

#include "ui/ui_map.h"

namespace lumi {

/// Fonts at the present scale.
struct Fonts {
    ImFont* body = nullptr;
    ImFont* strong = nullptr;  ///< headings, names
    ImFont* small = nullptr;   ///< labels, hints
    ImFont* mono = nullptr;    ///< numbers in tables
    ImFont* title = nullptr;
};

/// What every widget needs beside ImGui's own state; ImGui's IO carries the pointer.
struct UiContext {
    Fonts fonts;
    float scale = 1;  ///< framebuffer pixels for each design pixel (HiDPI)
    UiMap map;
};

inline UiContext& ui() { return *static_cast<UiContext*>(ImGui::GetIO().UserData); }

/// Design pixels to framebuffer pixels.
inline float px(float design) { return design * ui().scale; }

/// Names the item drawn last, so that scripts and tests can click it.
void markItem(const std::string& name);
void markRect(const std::string& name, ImVec2 lower, ImVec2 upper);

/// Sets a font for a scope.
class WithFont {
public:
    explicit WithFont(ImFont* font) { ImGui::PushFont(font); }
    ~WithFont() { ImGui::PopFont(); }
    WithFont(const WithFont&) = delete;
    WithFont& operator=(const WithFont&) = delete;
};

}  // namespace lumi

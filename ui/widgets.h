#pragma once
#include <initializer_list>
#include <string>

#include "ui/icons.h"
#include "ui/shortcuts.h"
#include "ui/theme.h"

namespace lumi {

/// A square button with an icon. `tip` is shown after a moment; `name` is what scripts click.
bool iconButton(const char* name, Icon icon, const std::string& tip, bool on = false, float design = 28);

/// A button with text (and an icon before it if `icon` is not null); `primary` fills it with the accent.
bool textButton(const char* name, const std::string& text, const Icon* icon = nullptr, bool primary = false,
                float width = 0);

/// Some exclusive choices in one frame, the chosen one raised. Returns the index clicked, or -1.
int segments(const char* name, std::initializer_list<const char*> texts, int chosen, float width = 0);
int iconSegments(const char* name, std::initializer_list<Icon> icons, std::initializer_list<const char*> tips,
                 int chosen);

/// A switch that slides. True when it was clicked.
bool toggleSwitch(const char* name, bool& value);

/// A line with a filled part; `fraction` < 0 runs to and fro.
void progressBar(float fraction, float width, float height, ImU32 colour = palette::kAccent);

/// Text helpers.
void dimText(const std::string& text);
void smallText(const std::string& text, ImU32 colour = palette::kDim);
void heading(const std::string& text);

/// A heading that folds what is below it. Returns whether it is open.
bool section(const char* title, bool openAtFirst = true);

/// Help under the pointer, wrapped. The chord, if any, stands beside the title.
void tooltip(const std::string& title, const std::string& text = "", const std::string& chord = "");
std::string tipFor(const char* what, UiCommand command);

/// A field to search with; true when its text changed.
bool searchField(const char* name, std::string& text, const char* hint, float width = -1);

/// `text` with its middle (a path) or its end (a label) left out where it is wider than `width`.
std::string elided(const std::string& text, float width);
std::string shortened(const std::string& text, float width);

/// Of a row's width, for its label.
constexpr float kLabelShare = 0.45f;

}  // namespace lumi

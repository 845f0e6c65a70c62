#pragma once
#include "ui/context.h"

namespace lumi {

/// The palette: neutral greys that do not tint the judgement of a picture, and one accent.
namespace palette {
constexpr ImU32 kBackground = IM_COL32(15, 16, 18, 255);  ///< around the picture
constexpr ImU32 kPanel = IM_COL32(24, 25, 28, 255);
constexpr ImU32 kBar = IM_COL32(20, 21, 23, 255);
constexpr ImU32 kRaised = IM_COL32(36, 38, 42, 255);  ///< fields, buttons
constexpr ImU32 kHovered = IM_COL32(47, 50, 55, 255);
constexpr ImU32 kActive = IM_COL32(56, 60, 66, 255);
constexpr ImU32 kBorder = IM_COL32(46, 48, 53, 255);
constexpr ImU32 kText = IM_COL32(224, 226, 230, 255);
constexpr ImU32 kDim = IM_COL32(146, 150, 158, 255);
constexpr ImU32 kFaint = IM_COL32(98, 102, 110, 255);
constexpr ImU32 kAccent = IM_COL32(88, 166, 255, 255);
constexpr ImU32 kAccentDeep = IM_COL32(38, 96, 166, 255);
constexpr ImU32 kOnAccent = IM_COL32(255, 255, 255, 255);
constexpr ImU32 kGood = IM_COL32(96, 200, 138, 255);
constexpr ImU32 kWarning = IM_COL32(236, 180, 84, 255);
constexpr ImU32 kError = IM_COL32(242, 104, 104, 255);
constexpr ImU32 kOverlay = IM_COL32(30, 31, 35, 225);  ///< chips over the picture
}  // namespace palette

inline ImVec4 toVec4(ImU32 colour) { return ImGui::ColorConvertU32ToFloat4(colour); }
inline ImU32 withAlpha(ImU32 colour, float alpha) {
    return (colour & ~IM_COL32_A_MASK) |
           (static_cast<ImU32>(alpha * static_cast<float>(colour >> IM_COL32_A_SHIFT)) << IM_COL32_A_SHIFT);
}

/// Colours, spacing and rounding for `scale` (framebuffer pixels for each design pixel).
void applyTheme(float scale);

/// Rebuilds the font atlas for `scale`: Inter and JetBrains Mono where Debian's packages are installed, else DejaVu,
/// else ImGui's built-in font. Returns false if the built-in one had to do.
bool loadFonts(Fonts& fonts, float scale);

}  // namespace lumi

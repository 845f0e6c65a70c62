#include "ui/theme.h"

#include <imgui_freetype.h>

#include <filesystem>
#include <initializer_list>

namespace lumi {

namespace {

// What labels and file names are written with: Latin with its extensions, Greek, Cyrillic, dashes, arrows, mathematics.
constexpr ImWchar kGlyphs[] = {0x20,   0x17F,  0x370,  0x3FF,  0x400,  0x45F,  0x2010, 0x2027, 0x2030, 0x205E, 0x2070,
                               0x209F, 0x2190, 0x21FF, 0x2200, 0x22FF, 0x2300, 0x23CF, 0x25A0, 0x25FF, 0};

ImFont* addFont(std::initializer_list<const char*> candidates, float pixels) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    for (const char* path : candidates) {
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) continue;
        ImFontConfig config;
        config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
        config.GlyphRanges = kGlyphs;
        if (ImFont* font = atlas.AddFontFromFileTTF(path, pixels, &config)) return font;
    }
    ImFontConfig config;
    config.SizePixels = pixels;
    return atlas.AddFontDefault(&config);
}

void setColours(ImVec4* colours) {
    const auto set = [&](int slot, ImU32 colour) { colours[slot] = toVec4(colour); };

    using namespace palette;
    set(ImGuiCol_Text, kText);
    set(ImGuiCol_TextDisabled, kFaint);
    set(ImGuiCol_WindowBg, kPanel);
    set(ImGuiCol_ChildBg, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_PopupBg, IM_COL32(28, 29, 33, 252));
    set(ImGuiCol_Border, kBorder);
    set(ImGuiCol_BorderShadow, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_FrameBg, kRaised);
    set(ImGuiCol_FrameBgHovered, kHovered);
    set(ImGuiCol_FrameBgActive, kActive);
    set(ImGuiCol_TitleBg, kBar);
    set(ImGuiCol_TitleBgActive, kBar);
    set(ImGuiCol_MenuBarBg, kBar);
    set(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_ScrollbarGrab, IM_COL32(255, 255, 255, 28));
    set(ImGuiCol_ScrollbarGrabHovered, IM_COL32(255, 255, 255, 48));
    set(ImGuiCol_ScrollbarGrabActive, IM_COL32(255, 255, 255, 70));
    set(ImGuiCol_CheckMark, kAccent);
    set(ImGuiCol_SliderGrab, kAccent);
    set(ImGuiCol_SliderGrabActive, kAccent);
    set(ImGuiCol_Button, kRaised);
    set(ImGuiCol_ButtonHovered, kHovered);
    set(ImGuiCol_ButtonActive, kActive);
    set(ImGuiCol_Header, IM_COL32(255, 255, 255, 14));
    set(ImGuiCol_HeaderHovered, IM_COL32(255, 255, 255, 22));
    set(ImGuiCol_HeaderActive, IM_COL32(255, 255, 255, 30));
    set(ImGuiCol_Separator, kBorder);
    set(ImGuiCol_SeparatorHovered, kAccent);
    set(ImGuiCol_SeparatorActive, kAccent);
    set(ImGuiCol_ResizeGrip, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_Tab, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_TabHovered, kHovered);
    set(ImGuiCol_TabActive, kRaised);
    set(ImGuiCol_PlotLines, kAccent);
    set(ImGuiCol_PlotHistogram, kAccent);
    set(ImGuiCol_TextSelectedBg, withAlpha(kAccentDeep, 0.8f));
    set(ImGuiCol_DragDropTarget, kAccent);
    set(ImGuiCol_NavHighlight, kAccent);
    set(ImGuiCol_TableBorderLight, IM_COL32(255, 255, 255, 10));
    set(ImGuiCol_TableRowBgAlt, IM_COL32(255, 255, 255, 6));
}

}  // namespace

void applyTheme(float scale) {
    ImGuiStyle style;
    style.WindowPadding = ImVec2(14, 12);
    style.FramePadding = ImVec2(8, 4);
    style.ItemSpacing = ImVec2(8, 6);
    style.ItemInnerSpacing = ImVec2(6, 4);
    style.CellPadding = ImVec2(6, 3);
    style.IndentSpacing = 14;
    style.ScrollbarSize = 9;
    style.ScrollbarRounding = 5;
    style.GrabMinSize = 9;
    style.GrabRounding = 4;
    style.WindowRounding = 6;
    style.ChildRounding = 5;
    style.FrameRounding = 4;
    style.PopupRounding = 6;
    style.TabRounding = 4;
    style.WindowBorderSize = 0;
    style.ChildBorderSize = 1;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowMenuButtonPosition = ImGuiDir_None;
    style.ColorButtonPosition = ImGuiDir_Left;
    style.DisabledAlpha = 0.45f;
    style.CircleTessellationMaxError = 0.2f;
    style.ScaleAllSizes(scale);
    setColours(style.Colors);
    ImGui::GetStyle() = style;
}

bool loadFonts(Fonts& fonts, float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    constexpr const char* kInter = "/usr/share/fonts/opentype/inter/Inter-Regular.otf";
    constexpr const char* kInterStrong = "/usr/share/fonts/opentype/inter/Inter-SemiBold.otf";
    constexpr const char* kDejaVu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    constexpr const char* kDejaVuBold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
    fonts.body = addFont({kInter, kDejaVu}, 15 * scale);
    fonts.strong = addFont({kInterStrong, kDejaVuBold}, 15 * scale);
    fonts.small = addFont({kInter, kDejaVu}, 13 * scale);
    fonts.mono = addFont({"/usr/share/fonts/truetype/jetbrains-mono/JetBrainsMono-Regular.ttf",
                          "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf"},
                         13 * scale);
    fonts.title = addFont({kInterStrong, kDejaVuBold}, 21 * scale);
    atlas.Build();
    ImGui::GetIO().FontDefault = fonts.body;
    return std::filesystem::exists(kInter) || std::filesystem::exists(kDejaVu);
}

}  // namespace lumi

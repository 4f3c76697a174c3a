#include "viewer/looks/theme.h"

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "base/log.h"

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;

constexpr float letterPixels = 15.0f;       ///< nominal size of the typeface
constexpr float plainLetterPixels = 13.0f;  ///< the same of ImGui's own font, which is drawn for this size

struct Palette {
    ImVec4 panel, frame, hovered, active, line, text, quiet, accent, accentHovered, popup;
};

ImVec4 rgb(uint32_t hex, float alpha = 1.0f) {
    const auto part = [&](int shift) { return static_cast<float>((hex >> shift) & 0xFFu) / 255.0f; };
    return {part(16), part(8), part(0), alpha};
}

Palette paletteOf(bool dark) {
    if (dark)
        return {rgb(0x1d1f23), rgb(0x2a2d33), rgb(0x363a42), rgb(0x424751), rgb(0x34373e),
                rgb(0xd8dade), rgb(0x8b9099), rgb(0x3f79b8), rgb(0x5290d1), rgb(0x24262b)};
    return {rgb(0xf3f4f6), rgb(0xe1e4e9), rgb(0xd5d9e0), rgb(0xc7cdd6), rgb(0xcdd2d9),
            rgb(0x1f2328), rgb(0x68707c), rgb(0x7db0e6), rgb(0x5f9bdb), rgb(0xfbfbfc)};
}

void setColors(const Palette& p) {
    ImVec4* const colors = ImGui::GetStyle().Colors;
    const auto set = [&](std::initializer_list<int> which, const ImVec4& color) {
        for (const int at : which) colors[at] = color;
    };
    const ImVec4 none{0, 0, 0, 0};
    set({ImGuiCol_Text}, p.text);
    set({ImGuiCol_TextDisabled}, p.quiet);
    set({ImGuiCol_WindowBg}, p.panel);
    set({ImGuiCol_ChildBg, ImGuiCol_BorderShadow, ImGuiCol_TableRowBg}, none);
    set({ImGuiCol_PopupBg}, p.popup);
    set({ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong}, p.line);
    set({ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_Header, ImGuiCol_ScrollbarGrab, ImGuiCol_TitleBg,
         ImGuiCol_TitleBgActive},
        p.frame);
    set({ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered,
         ImGuiCol_ScrollbarGrabHovered},
        p.hovered);
    set({ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive, ImGuiCol_HeaderActive, ImGuiCol_ScrollbarGrabActive},
        p.active);
    set({ImGuiCol_ScrollbarBg}, none);
    set({ImGuiCol_CheckMark, ImGuiCol_PlotLines, ImGuiCol_SeparatorHovered}, p.accent);
    // The number behind it stays legible.
    set({ImGuiCol_SliderGrab}, {p.accent.x, p.accent.y, p.accent.z, 0.7f});
    set({ImGuiCol_SliderGrabActive, ImGuiCol_SeparatorActive, ImGuiCol_PlotLinesHovered}, p.accentHovered);
    ImVec4 selected = p.accent;
    selected.w = 0.45f;
    set({ImGuiCol_TextSelectedBg, ImGuiCol_DragDropTarget, ImGuiCol_NavHighlight}, selected);
    set({ImGuiCol_TableRowBgAlt}, {p.text.x, p.text.y, p.text.z, 0.03f});
}

std::vector<fs::path> fontFolders() {
    std::vector<fs::path> folders{"/usr/local/share/fonts", "/usr/share/fonts"};
    if (const char* const data = std::getenv("XDG_DATA_HOME"); data && *data)
        folders.insert(folders.begin(), fs::path(data) / "fonts");
    else if (const char* const home = std::getenv("HOME"); home && *home)
        folders.insert(folders.begin(), fs::path(home) / ".local/share/fonts");
    return folders;
}

}  // namespace

Accents accentsOf(bool dark) {
    if (dark)
        return {IM_COL32(0xe8, 0xb0, 0x4b, 255), IM_COL32(0xff, 0x85, 0x73, 255),
                IM_COL32(0x8b, 0x90, 0x99, 255), IM_COL32(0x15, 0x16, 0x19, 255)};
    return {IM_COL32(0xc7, 0x7d, 0x00, 255), IM_COL32(0xb8, 0x2a, 0x1c, 255), IM_COL32(0x68, 0x70, 0x7c, 255),
            IM_COL32(0xe6, 0xe8, 0xec, 255)};
}

void setTheme(bool dark, float scale) {
    ImGuiStyle style;
    style.WindowPadding = {10, 8};
    style.FramePadding = {7, 3};
    style.ItemSpacing = {7, 5};
    style.ItemInnerSpacing = {5, 4};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 11;
    style.GrabMinSize = 9;
    style.WindowRounding = 0;
    style.WindowBorderSize = 0;
    style.PopupBorderSize = 1;
    style.ChildRounding = style.FrameRounding = style.PopupRounding = style.GrabRounding = 4;
    style.ScrollbarRounding = 6;
    style.WindowMinSize = {1, 1};
    style.ScaleAllSizes(scale);
    ImGui::GetStyle() = style;
    setColors(paletteOf(dark));
}

fs::path findTypeface() {
    // Debian's fonts-inter, fonts-roboto-unhinted and fonts-dejavu-core.
    const char* const files[] = {"opentype/inter/Inter-Regular.otf", "truetype/inter/Inter-Regular.ttf",
                                 "truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
                                 "truetype/roboto/hinted/Roboto-Regular.ttf",
                                 "truetype/dejavu/DejaVuSans.ttf"};
    std::error_code none;
    for (const char* const file : files) {
        for (const fs::path& folder : fontFolders()) {
            for (const fs::path& candidate : {folder / file, folder / fs::path(file).filename()})
                if (fs::is_regular_file(candidate, none)) return candidate;
        }
    }
    return {};
}

void addTypeface(float scale) {
    ImGuiIO& io = ImGui::GetIO();
    const fs::path file = findTypeface();
    if (!file.empty()) {
        // Latin letters, and the dashes, quotes and bullets of texts.
        static const ImWchar glyphs[] = {0x20, 0x24F, 0x2010, 0x2026, 0};
        ImFontConfig config;
        config.OversampleH = config.OversampleV = 2;
        if (io.Fonts->AddFontFromFileTTF(file.c_str(), std::round(letterPixels * scale), &config, glyphs))
            return;
    }
    log::info(
        "found none of the typefaces of Debian's fonts-inter, fonts-roboto-unhinted and fonts-dejavu-core; "
        "the window uses a plain one");
    ImFontConfig config;
    config.SizePixels = std::round(plainLetterPixels * scale);
    io.Fonts->AddFontDefault(&config);
}

}  // namespace limpid::viewer

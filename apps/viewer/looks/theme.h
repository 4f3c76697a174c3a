// The window's colours, dark or light, and its typeface.
#pragma once

#include <imgui.h>

#include <filesystem>

namespace limpid::viewer {

/// Colours that ImGui has no name for.
struct Accents {
    ImU32 changed;  ///< marks a value that is not the default
    ImU32 fault;    ///< text of an error
    ImU32 quiet;    ///< text that is not important
    ImU32 stage;    ///< behind the picture
};
Accents accentsOf(bool dark);

/// Sets ImGui's style. `scale`: how much larger than nominal everything is drawn.
void setTheme(bool dark, float scale);

/// The first of Inter, Roboto and DejaVu Sans in the folders in which Debian installs fonts, and in the
/// user's; empty: there is none of them.
std::filesystem::path findTypeface();

/// Adds the typeface to ImGui's fonts, or ImGui's own font where there is none, with a message.
void addTypeface(float scale);

}  // namespace limpid::viewer

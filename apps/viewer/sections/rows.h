// Rows of the panel that stand for no field of the studio's state.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "renderer/method/presets.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {

void drawPreview(const Drawing& with);
void drawMagnifier(const Drawing& with);
/// Output of a high dynamic range, and what its numbers mean.
void drawHdr(const Drawing& with);
void drawTheme(const Drawing& with);

/// A click applies the whole preset, including its integrator and denoiser.
void drawPreset(const Drawing& with, const Preset& preset);

/// The first four, for the search.
struct ExtraRow {
    const char* section;
    std::vector<std::string_view> texts;  ///< what it is found by
    void (*draw)(const Drawing& with);
};
std::span<const ExtraRow> extraRows();

}  // namespace limpid::viewer

// The denoisers without a network. LIMPID_METHODS in src/denoise/CMakeLists.txt lists them; all else follows
// from it.
#pragma once

#include <span>

#include "denoise/methods/method.h"
#include "denoise/stages/taa/taa.h"
#include "method_list.h"

namespace limpid::denoise {

/// The settings of every method by its name, as in settings.svgf.alpha, and of temporal anti-aliasing.
struct FilterSettings {
#define LIMPID_SETTINGS(method) denoise::method::Settings method;
    LIMPID_METHODS(LIMPID_SETTINGS)
#undef LIMPID_SETTINGS
    TaaSettings taa;
    bool operator==(const FilterSettings&) const = default;
};

struct Method {
    std::string_view name, help;
    std::span<const std::string_view> groups;
    bool readsLayers;     ///< normal or depth, not only the surfaces
    bool readsVariances;  ///< DenoiserInput::variances
    bool oneChannel;      ///< filters visibility, the first component of diffuse and emission; not light
    bool keepsHistory;    ///< accumulates light over frames, along the motion
    uint32_t samples;     ///< what it is made for, per pixel and frame
    /// Records one frame.
    DenoiserOutput (*record)(gpu::FrameGraph&, const DenoiserInput&, const FilterSettings&);
};

/// In the order of LIMPID_METHODS, which is that of limpid_method in limpid/denoise.h.
std::span<const Method> methods();

/// Calls visit(table, group) for the ParamTable and the settings of each method and of temporal
/// anti-aliasing.
template <typename Settings, typename Visit>
void forEachGroup(Settings& settings, const Visit& visit) {
#define LIMPID_VISIT(method) visit(method::params(), settings.method);
    LIMPID_METHODS(LIMPID_VISIT)
#undef LIMPID_VISIT
    visit(taaParams(), settings.taa);
}

}  // namespace limpid::denoise

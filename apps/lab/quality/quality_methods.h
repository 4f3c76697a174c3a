// Which methods `limpid bench quality` compares.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/method/settings.h"

namespace limpid::cli {

/// A denoiser with its parameters.
struct QualityMethod {
    std::string name;
    RenderSettings settings;
};

/// As on the command line.
struct MethodChoice {
    std::vector<std::string> denoisers;  ///< by name; at least one
    /// Parameters by commas, group.name=value, or preset=name: the last denoiser that a group is named after,
    /// or that has the preset, once more with these; the last of all if there is none.
    std::vector<std::string> variants;
    /// Where the rays of all frames go through their pixels; empty: as each pipeline or preset needs it.
    std::optional<Jitter> jitter;
    uint32_t samples = 1;  ///< per pixel and frame; decides where the rays go, too
    bool steps = false;    ///< SVGF as others have it, without each of its steps, and with former defaults
};

/// Denoisers, variants, steps, in this order; `common` is what all start from, its integrator too. Throws
/// UsageError if there is no such denoiser, the integrator takes none, or a variant names no parameter or an
/// unknown one.
std::vector<QualityMethod> methodsOf(const MethodChoice& choice, RenderSettings common);

}  // namespace limpid::cli

// Which methods `limpid bench quality` compares.
#pragma once

#include <string>
#include <vector>

#include "renderer/frame/settings.h"

namespace limpid::cli {

/// A pipeline with its parameters.
struct QualityMethod {
    std::string name;
    RenderSettings settings;
};

/// As on the command line.
struct MethodChoice {
    std::vector<std::string> pipelines;  ///< names of denoisers; at least one
    /// Parameters by commas, group.name=value, or preset=name: the last pipeline that a group is named after,
    /// or that has the preset, once more with these; the last of all if there is none.
    std::vector<std::string> variants;
    bool steps = false;  ///< SVGF as others have it, without each of its steps, and with former defaults
};

/// Pipelines, variants, steps, in this order; `common` is what all start from. Throws UsageError if a
/// pipeline does not denoise, or a variant names no parameter or an unknown one.
std::vector<QualityMethod> methodsOf(const MethodChoice& choice, RenderSettings common);

}  // namespace limpid::cli

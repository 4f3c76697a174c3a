// Light of the user's own, as the panel has it (scene/own_light.h).
#pragma once

#include <string>

#include "base/math.h"

namespace limpid::viewer {

struct LightChoice {
    int kind = 0;  ///< none, point, sun
    vec3 at{0.0f, 1.0f, 0.0f};
    float intensity = 1.0f;
    bool hasBackground = false;
    vec3 background{0.5f};
    /// As on the command line; empty: none.
    std::string lamp() const;
    std::string backgroundText() const;
};

/// What the command line says. Throws UsageError.
LightChoice lightChoiceOf(const std::string& lamp, const std::string& background);

}  // namespace limpid::viewer

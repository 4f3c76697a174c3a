// The parts that denoisers have in common. Each can be switched off, to see what it contributes (an
// ablation).
#pragma once

#include <array>
#include <string_view>

#include "renderer/method/settings.h"

namespace limpid {

struct DenoiserPart {
    std::string_view name;
    std::string_view help;  ///< for the user: what its absence looks like
};

/// In the order of DenoiserParts::on.
inline constexpr std::array denoiserParts{
    DenoiserPart{"temporal", "Frames before this one count; off: each frame is denoised by itself"},
    DenoiserPart{"spatial", "Neighbouring pixels count; off: grain stays where the history is short"},
    DenoiserPart{"demodulation", "Light is filtered without the surfaces' colours; off: textures blur"},
};

/// Which of them work.
struct DenoiserParts {
    std::array<bool, denoiserParts.size()> on{true, true, true};
    bool operator==(const DenoiserParts&) const = default;
};

/// Whether the denoiser (null: none) has this part and can do without it. `part`: an index into
/// denoiserParts.
bool hasPart(const denoise::Denoiser* denoiser, size_t part);

/// The same settings, with the parameters of their denoiser set so that the parts that are off do nothing.
RenderSettings withParts(const RenderSettings& settings, const DenoiserParts& parts);

}  // namespace limpid

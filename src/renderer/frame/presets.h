// Ways to render that a paper, a course or a tutorial describes, as --preset
// names them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/frame/settings.h"

namespace limpid {

struct Preset {
    std::string name;
    std::string help;  ///< what it follows, and where it does not
    /// That it is for; the first of each unless another one is asked for.
    std::vector<std::string> integrators, denoisers;
    Jitter jitter = Jitter::Off;
    /// Without a denoiser: the mean in single precision, launch after launch.
    bool progressive = false;
    std::vector<std::string> assignments;  ///< as for assign()

    bool isFor(const Pipeline& pipeline) const;
    /// The first of each.
    Pipeline pipeline() const;
};

const std::vector<Preset>& presets();

/// Throws UsageError listing the presets if there is none of this name.
const Preset& findPreset(std::string_view name);

/// Its jitter and parameters; integrator and denoiser stay. What the user chose besides
/// is set after this.
void applyPreset(RenderSettings& settings, std::string_view name);

/// As after --integrator and --denoiser; "" where the user says nothing.
struct PipelineChoice {
    std::string integrator, denoiser;
};

/// What the user asked for. What is left open is the last preset's first integrator and denoiser that all
/// presets are for; without presets it is that of `otherwise`, as far as the two go together. Throws
/// UsageError as parsePipeline(), and if one of the presets is for others: it would be ignored.
Pipeline pipelineFor(std::span<const std::string> presetNames, const PipelineChoice& asked,
                     const Pipeline& otherwise);

}  // namespace limpid

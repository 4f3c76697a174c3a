// Presets for --preset: settings that a paper, a course or a tutorial describes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/method/settings.h"

namespace limpid {

struct Preset {
    std::string name;
    std::string help;  ///< its source, and where it deviates from it
    /// Supported integrators and denoisers; the first of each is the default.
    std::vector<std::string> integrators, denoisers;
    Jitter jitter = Jitter::Off;
    /// Without a denoiser: accumulate in single precision, launch after launch.
    bool progressive = false;
    std::vector<std::string> assignments;  ///< as for assign()

    bool isFor(const Pipeline& pipeline) const;
    bool isForDenoiser(std::string_view denoiser) const;
    /// The default integrator and denoiser.
    Pipeline pipeline() const;
};

const std::vector<Preset>& presets();

/// Throws UsageError with the list of presets if the name is unknown.
const Preset& findPreset(std::string_view name);

/// Sets jitter and parameters, but not integrator and denoiser. Set the user's other choices after this. ""
/// changes nothing.
void applyPreset(RenderSettings& settings, std::string_view name);

/// Like applyPreset(), but first resets every parameter that any preset sets to its default, so that an
/// earlier preset leaves no trace.
void applyOnlyPreset(RenderSettings& settings, std::string_view name);

/// Values of --integrator and --denoiser; "" if not given.
struct PipelineChoice {
    std::string integrator, denoiser;
};

/// Returns the pipeline that the user chose. A missing integrator or denoiser is the preset's first one.
/// Without a preset ("") it is that of `otherwise`, if the two can be combined. Throws UsageError like
/// parsePipeline(), and if the preset does not support the result and would be ignored.
Pipeline pipelineFor(std::string_view presetName, const PipelineChoice& asked, const Pipeline& otherwise);

}  // namespace limpid

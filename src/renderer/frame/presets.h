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
    std::string help;                    ///< what it follows, and where it does not
    std::vector<std::string> pipelines;  ///< that it is for; the first unless another one is asked for
    Jitter jitter = Jitter::Off;
    /// Of the pipeline `path`: the mean in single precision, launch after launch.
    bool progressive = false;
    std::vector<std::string> assignments;  ///< as for assign()

    bool isFor(const Pipeline& pipeline) const;
};

const std::vector<Preset>& presets();

/// Throws UsageError listing the presets if there is none of this name.
const Preset& findPreset(std::string_view name);

/// Its jitter and parameters; the pipeline stays. What the user chose besides
/// is set after this.
void applyPreset(RenderSettings& settings, std::string_view name);

/// The pipeline `asked`; if that is empty the last preset's first; without
/// presets `otherwise`. Throws UsageError if one of the presets is for other
/// pipelines: it would be ignored.
Pipeline pipelineFor(std::span<const std::string> presetNames, std::string_view asked,
                     std::string_view otherwise);

}  // namespace limpid

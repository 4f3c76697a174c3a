// A pass for debugging: why the reprojection stage kept or rejected the history of each pixel.
#pragma once

#include <string>

#include "denoise/api/denoiser_input.h"
#include "denoise/stages/reproject/reasons_params.h"

namespace limpid::denoise {

/// The reasons for one signal's histories.
struct SignalReasons {
    std::string signal;      ///< "diffuse", "specular", or "joint" for all light
    gpu::ImageHandle image;  ///< rg32ui: see reasons_params.h
};

/// How a method looked for a signal's histories.
struct ReasonsQuestion {
    std::string method, signal;  ///< such as "svgf", "diffuse"
    ReprojectTests tests{};
    bool instances = true;  ///< instances must be equal
    gpu::History frames;    ///< the fourth component counts frames of history
    float longest = 0.0f;   ///< frames: longer histories count for as many
    bool shortens = false;  ///< anti-lag does, after reprojection
    gpu::ImageHandle reflectionMotion = gpu::ImageHandle();  ///< empty: the surface's motion is followed
    float lobeScale = 0.0f;                                  ///< see lobe.glsl; 0: lobes do not count
};

/// Records the pass "METHOD/reasons SIGNAL", which must come after those that write the histories. It writes
/// a second image with colours for the reasons: blue: nothing seen; white: first frame; yellow: outside the
/// previous picture; red: other object; orange: other distance; green: other normal; violet: other reasons;
/// grey: kept, brighter the longer; with a tint of cyan: shortened by anti-lag.
SignalReasons recordReasons(gpu::FrameGraph& graph, const DenoiserInput& input, const gpu::History& surfaces,
                            const ReasonsQuestion& question);

}  // namespace limpid::denoise

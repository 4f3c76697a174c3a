// The denoisers without a network, composed of stages: each function records one frame.
#pragma once

#include "denoise/methods/atrous/atrous.h"
#include "denoise/methods/svgf/svgf.h"
#include "denoise/methods/temporal/temporal.h"
#include "denoise/stages/taa/taa.h"

namespace limpid::denoise {

/// One struct per technique; a denoiser uses its own.
struct FilterSettings {
    TemporalSettings temporal;
    AtrousSettings atrous;
    SvgfSettings svgf;
    TaaSettings taa;
    bool operator==(const FilterSettings&) const = default;
};

struct DenoiserOutput {
    gpu::ImageHandle beauty;        ///< rgba32f: clean radiance with emission; alpha 1
    gpu::ImageHandle disocclusion;  ///< TemporalImages::disocclusion; empty without temporal accumulation
};

DenoiserOutput recordTemporal(gpu::FrameGraph& graph, const DenoiserInput& input,
                              const FilterSettings& settings);
DenoiserOutput recordAtrous(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const FilterSettings& settings);
DenoiserOutput recordSvgf(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);

}  // namespace limpid::denoise

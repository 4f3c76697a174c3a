// What the list of methods (methods.h) needs of each. A method's header has a namespace of the method's name,
// with
//
//     using Settings = ...;                           user settings
//     const ParamTable<Settings>& params();           their names, ranges and descriptions
//     inline constexpr std::string_view help = ...;   one sentence, for `limpid info`
//     inline constexpr std::array groups{...};        parameter groups that record() reads, std::string_view
//     inline constexpr bool readsLayers = ...;        record() reads normal or depth, not only the surfaces
//     inline constexpr bool readsVariances = ...;     record() reads DenoiserInput::variances
//     inline constexpr bool oneChannel = ...;         filters visibility, not light
//     inline constexpr bool keepsHistory = ...;       accumulates light over frames, along the motion
//     inline constexpr uint32_t samples = ...;        what it is made for, per pixel and frame
//     DenoiserOutput record(gpu::FrameGraph&, const DenoiserInput&, const FilterSettings&);
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "denoise/stages/reproject/reasons.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

struct FilterSettings;

/// The result of a method for one frame.
struct DenoiserOutput {
    gpu::ImageHandle beauty;        ///< rgba32f: clean radiance with emission; alpha 1
    gpu::ImageHandle disocclusion;  ///< TemporalImages::disocclusion; empty without temporal accumulation
    /// The fourth component counts the frames of a pixel's history; empty without temporal accumulation.
    gpu::ImageHandle frames;
    /// With DenoiserInput::reasons.wanted, for each signal; empty without temporal accumulation.
    std::vector<SignalReasons> reasons = {};
    /// With DenoiserInput::wantsSignals, of SVGF and of methods that go on from it: the filtered signals,
    /// rgba32f, with albedo, without emission, alpha 1. If there is one signal, `diffuse` is all light that
    /// was filtered, and `specular` is empty.
    gpu::ImageHandle diffuse = {}, specular = {};
};

}  // namespace limpid::denoise

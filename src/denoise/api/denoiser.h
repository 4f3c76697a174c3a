// Every denoiser by name, and how to run one inside any renderer:
//
//     denoise::DenoiserSettings settings;            // or from --set and --preset
//     graph.beginFrame();
//     denoise::DenoiserInput input = ...;            // your images, or denoise::upload(graph, hostFrame)
//     const auto& method = *denoise::findDenoiser("atrous");
//     const gpu::ImageHandle beauty = method.record(graph, input, settings).beauty;
//     graph.execute(device);
//
// One FrameGraph holds one sequence: its histories. Frames must come in order; at a cut, mark all motion
// invalid or call graph.resetHistories().
#pragma once

#include <span>
#include <string_view>

#include "denoise/api/denoiser_input.h"
#include "denoise/kpcn/kpcn.h"
#include "denoise/methods/atrous/atrous.h"
#include "denoise/methods/history/history.h"
#include "denoise/methods/svgf/svgf.h"
#include "denoise/stages/taa/taa.h"

namespace limpid::denoise {

/// One struct per technique.
struct DenoiserSettings {
    HistorySettings history;
    AtrousSettings atrous;
    SvgfSettings svgf;
    KpcnSettings kpcn;
    TaaSettings taa;
    bool operator==(const DenoiserSettings&) const = default;
};

struct DenoiserOutput {
    gpu::ImageHandle beauty;  ///< rgba32f: clean radiance with emission; alpha 1
    gpu::ImageHandle cases;   ///< HistoryImages::cases, where history is tracked; else empty
};

struct Denoiser {
    std::string_view name;  ///< as after --pipeline and --method
    std::string_view help;
    /// Records one frame.
    DenoiserOutput (*record)(gpu::FrameGraph&, const DenoiserInput&, const DenoiserSettings&);
    /// Parameter groups that it heeds.
    std::span<const std::string_view> groups;
    /// dB of PSNR that the tests demand over the noisy frames, after 24 of them.
    double leastGain;
    bool network = false;  ///< needs settings.kpcn.network, and frames with variances of several samples
};

std::span<const Denoiser> denoisers();
/// Null if there is none of that name.
const Denoiser* findDenoiser(std::string_view name);

}  // namespace limpid::denoise

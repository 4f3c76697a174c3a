// Kernel-predicting networks: S. Bako et al., "Kernel-Predicting Convolutional Networks for Denoising Monte
// Carlo Renderings", SIGGRAPH 2017. docs/kpcn.md has the formulas.
#pragma once

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "denoise/kpcn/kpcn_network.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// What a user may set; kpcnParams() is where range and meaning stand.
struct KpcnSettings {
    int tile = 512;
    float standardErrors = 6.0f;
    int levels = 4;
    float phiColor = 3.5f;
    bool half = true;     ///< heeded when the network is made: kpcnPrecision()
    bool cis565 = false;  ///< ... when its weights are read: renderer/frame/network_file.h
    bool operator==(const KpcnSettings&) const = default;
};
const ParamTable<KpcnSettings>& kpcnParams();

/// The beauty, rgba32f, alpha 1, from this frame alone. `input.samples` and the variances in alpha must be
/// true. Passes: "kpcn/distances", "kpcn/largest", of each side and tile "kpcn/diffuse features",
/// "kpcn/diffuse hidden 1" and so on, "kpcn/diffuse kernel"; of each side "kpcn/diffuse level 1" and so on;
/// "kpcn/compose". The network lies on the device that executes the graph, and lives until it has.
gpu::ImageHandle filterKpcn(gpu::FrameGraph& graph, const DenoiserInput& input, const KpcnSettings& settings,
                            const KpcnNetwork& network);

}  // namespace limpid::denoise

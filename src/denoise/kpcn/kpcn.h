// Kernel-predicting networks: S. Bako et al., "Kernel-Predicting Convolutional Networks for Denoising Monte
// Carlo Renderings", SIGGRAPH 2017. docs/kpcn.md has the formulas.
#pragma once

#include "base/params.h"
#include "denoise/api/denoiser_input.h"
#include "denoise/kpcn/kpcn_network.h"
#include "gpu/graph/frame_graph.h"

namespace limpid::denoise {

/// User settings; kpcnParams() gives ranges and descriptions.
struct KpcnSettings {
    int tile = 512;
    float standardErrors = 6.0f;
    int levels = 4;
    float phiColor = 3.5f;
    bool half = true;     ///< used when the network is created: kpcnPrecision()
    bool cis565 = false;  ///< used when the weights are read: renderer/method/network_file.h
    bool operator==(const KpcnSettings&) const = default;
};
const ParamTable<KpcnSettings>& kpcnParams();

/// Adds the passes that denoise a frame by itself, and returns the denoised beauty (rgba32f, alpha 1).
/// `input.samples` and the variances in alpha must be correct. The network must be on the device that
/// executes the graph, and must outlive that execution. Passes, in this order:
/// - "kpcn/distances" and "kpcn/largest" find the largest distance in the picture;
/// - for each side (diffuse, specular) and tile: "kpcn/diffuse features", "kpcn/diffuse hidden 1" and so on,
///   "kpcn/diffuse kernel";
/// - for each side: the filter levels after the network, "kpcn/diffuse level 1" and so on;
/// - "kpcn/compose".
gpu::ImageHandle filterKpcn(gpu::FrameGraph& graph, const DenoiserInput& input, const KpcnSettings& settings,
                            const KpcnNetwork& network);

}  // namespace limpid::denoise

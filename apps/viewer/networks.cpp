#include "networks.h"

#include "renderer/frame/network_file.h"

namespace limpid::viewer {

namespace {

bool needsNetwork(const Pipeline& pipeline) {
    return pipeline.denoiser && pipeline.denoiser->network;
}

}  // namespace

bool Networks::lacks(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) const {
    return needsNetwork(pipeline) && (!loaded_.kpcn.network || loaded_.kpcn.half != settings.kpcn.half ||
                                      loaded_.kpcn.cis565 != settings.kpcn.cis565);
}

void Networks::load(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) {
    loaded_.kpcn.half = settings.kpcn.half;
    loaded_.kpcn.cis565 = settings.kpcn.cis565;
    denoise::DenoiserSettings fresh = settings;
    loadNetwork(device_, pipeline.denoiser, weights_, fresh);
    loaded_ = fresh;
}

void Networks::set(RenderSettings& settings) const {
    settings.denoisers.kpcn.network = needsNetwork(settings.pipeline) ? loaded_.kpcn.network : nullptr;
}

}  // namespace limpid::viewer

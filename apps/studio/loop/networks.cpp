#include "studio/loop/networks.h"

#include "renderer/frame/network_file.h"

namespace limpid::studio {

bool Networks::lacks(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) const {
    return pipeline.usesNetwork() && (!networks_.kpcn || loadedFor_.half != settings.kpcn.half ||
                                      loadedFor_.cis565 != settings.kpcn.cis565);
}

void Networks::load(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) {
    loadedFor_ = settings.kpcn;
    networks_ = loadNetworks(device_, pipeline.denoiser, weights_, settings);
}

void Networks::set(RenderSettings& settings) const {
    settings.networks = settings.pipeline.usesNetwork() ? networks_ : denoise::DenoiserNetworks{};
}

}  // namespace limpid::studio

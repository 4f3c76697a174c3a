#include "studio/background/networks.h"

#include <chrono>
#include <utility>

#include "renderer/method/network_file.h"

namespace limpid::studio {
namespace {

bool hasEnded(const std::future<denoise::DenoiserNetworks>& loading) {
    return loading.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

bool sameNetwork(const denoise::KpcnSettings& a, const denoise::KpcnSettings& b) {
    return a.half == b.half && a.cis565 == b.cis565;
}

}  // namespace

Networks::Networks(gpu::Device& device, std::filesystem::path weights, NetworkLoader load)
    : device_(device),
      weights_(std::move(weights)),
      load_(load ? std::move(load) : NetworkLoader(limpid::loadNetworks)) {}

Networks::~Networks() {
    if (isLoading()) cancel();
}

bool Networks::lacks(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) const {
    return pipeline.usesNetwork() && (!networks_.kpcn || !sameNetwork(loadedFor_, settings.kpcn));
}

void Networks::begin(const Pipeline& pipeline, const denoise::DenoiserSettings& settings) {
    if (isLoading() && sameNetwork(loadingFor_, settings.kpcn)) return;
    if (isLoading()) cancel();
    loadingFor_ = settings.kpcn;
    progress_ = Progress::watched();
    loading_ =
        std::async(std::launch::async, [this, denoiser = pipeline.denoiser, settings, progress = progress_] {
            return load_(device_, denoiser, weights_, settings, progress);
        });
}

bool Networks::isDone() const {
    return isLoading() && hasEnded(loading_);
}

void Networks::take() {
    loadedFor_ = loadingFor_;
    networks_ = loading_.get();
}

void Networks::cancel() {
    std::erase_if(cancelled_, hasEnded);
    progress_.cancel();
    cancelled_.push_back(std::move(loading_));
}

void Networks::settle() {
    cancel();
    loadedFor_ = loadingFor_;
}

void Networks::set(RenderSettings& settings) const {
    settings.networks = settings.pipeline.usesNetwork() ? networks_ : denoise::DenoiserNetworks{};
}

}  // namespace limpid::studio

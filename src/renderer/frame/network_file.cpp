#include "renderer/frame/network_file.h"

#include "base/error.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

const char* shippedName(const denoise::KpcnSettings& settings) {
    return settings.cis565 ? "kpcn-cis565.safetensors" : "kpcn.safetensors";
}

}  // namespace

fs::path shippedWeights(const denoise::KpcnSettings& settings) {
    std::error_code fault;
    const fs::path folder = fs::read_symlink("/proc/self/exe", fault).parent_path();
    const char* name = shippedName(settings);
    for (const fs::path& candidate : {folder / name, folder.parent_path() / "share" / "limpid" / name}) {
        if (fs::exists(candidate, fault)) return candidate;
    }
    return {};
}

denoise::DenoiserNetworks loadNetworks(gpu::Device& device, const denoise::Denoiser* denoiser,
                                       const fs::path& file, const denoise::DenoiserSettings& settings) {
    if (!denoiser || !denoiser->network) {
        if (!file.empty()) throw UsageError("--weights: only kpcn is a network and has weights");
        return {};
    }
    const fs::path chosen = file.empty() ? shippedWeights(settings.kpcn) : file;
    if (chosen.empty())
        throw InputError(shippedName(settings.kpcn),
                         "the weights that come with Limpid are not there: --weights FILE");
    return {.kpcn = std::make_shared<denoise::KpcnNetwork>(
                device, denoise::readKpcnWeights(chosen),
                denoise::kpcnPrecision(device.info(), settings.kpcn.half))};
}

}  // namespace limpid

#include "renderer/method/network_file.h"

#include <dlfcn.h>

#include "base/error.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr double weightsRead = 0.7;  ///< share of the time of loading until the weights are read

const char* shippedName(const denoise::KpcnSettings& settings) {
    return settings.cis565 ? "kpcn-cis565.safetensors" : "kpcn.safetensors";
}

/// The folder of the file that contains this function; empty if that is unknown.
fs::path folderOfThisLibrary() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&folderOfThisLibrary), &info) == 0 || !info.dli_fname)
        return {};
    std::error_code fault;
    return fs::canonical(info.dli_fname, fault).parent_path();
}

}  // namespace

fs::path shippedWeights(const denoise::KpcnSettings& settings) {
    std::error_code fault;
    const char* name = shippedName(settings);
    for (const fs::path& folder :
         {fs::read_symlink("/proc/self/exe", fault).parent_path(), folderOfThisLibrary()}) {
        // An installed library is in lib, or in a folder below it for each architecture.
        const fs::path prefix = folder.parent_path();
        for (const fs::path& candidate : {folder / name, prefix / "share" / "limpid" / name,
                                          prefix.parent_path() / "share" / "limpid" / name})
            if (!folder.empty() && fs::exists(candidate, fault)) return candidate;
    }
    return {};
}

denoise::DenoiserNetworks loadNetworks(gpu::Device& device, const denoise::Denoiser* denoiser,
                                       const fs::path& file, const denoise::DenoiserSettings& settings,
                                       const Progress& progress) {
    if (!denoiser || !denoiser->network) {
        if (!file.empty()) throw UsageError("--weights: only kpcn is a network and has weights");
        return {};
    }
    const fs::path chosen = file.empty() ? shippedWeights(settings.kpcn) : file;
    if (chosen.empty())
        throw InputError(shippedName(settings.kpcn),
                         "the weights that come with Limpid are not there: --weights FILE");
    const denoise::KpcnWeights weights = denoise::readKpcnWeights(chosen, progress.part(0.0, weightsRead));
    const denoise::KpcnPrecision precision = denoise::kpcnPrecision(device.info(), settings.kpcn.half);
    auto network = std::make_shared<denoise::KpcnNetwork>(device, weights, precision);
    progress.at(1.0);
    return {.kpcn = std::move(network)};
}

}  // namespace limpid

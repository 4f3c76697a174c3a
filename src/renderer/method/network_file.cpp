#include "renderer/method/network_file.h"

#include <dlfcn.h>

#include <vector>

#include "base/error.h"

namespace limpid {

namespace fs = std::filesystem;

namespace {

constexpr double weightsRead = 0.7;  ///< share of the time of loading until the weights are read

const char* shippedName(const denoise::KpcnSettings& settings) {
    return settings.cis565 ? "kpcn-cis565.safetensors" : "kpcn.safetensors";
}

/// The folders of the library that contains this function and of the program; empty where that is unknown.
std::vector<fs::path> ownFolders() {
    std::error_code fault;
    const fs::path program = fs::read_symlink("/proc/self/exe", fault).parent_path();
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&ownFolders), &info) == 0 || !info.dli_fname) return {program};
    const fs::path file = info.dli_fname;
    // The program itself is called there as the user typed it, which may be a name without a folder.
    if (!file.has_parent_path()) return {program};
    const fs::path library = fs::canonical(file, fault).parent_path();
    if (!file.is_absolute()) return {program, library};
    return {library, program};  // Python may be from a prefix with other weights
}

}  // namespace

fs::path shippedWeights(const denoise::KpcnSettings& settings) {
    std::error_code fault;
    const char* name = shippedName(settings);
    // Python's modules are two folders below that of the build, and four or five below the prefix. Files
    // further up are not Limpid's.
    constexpr int toBuild = 2, toPrefix = 5;
    for (const fs::path& own : ownFolders()) {
        fs::path folder = own;
        for (int above = 0; above <= toPrefix && folder.has_relative_path(); ++above) {
            if (above <= toBuild && fs::exists(folder / name, fault)) return folder / name;
            const fs::path shared = folder / "share" / "limpid" / name;
            if (fs::exists(shared, fault)) return shared;
            folder = folder.parent_path();
        }
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

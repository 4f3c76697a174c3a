#include "denoise/api/network/installed_weights.h"

#include <dlfcn.h>

#include "base/error.h"
#include "base/text/format.h"

namespace limpid::denoise {

namespace fs = std::filesystem;

namespace {

/// Of the file that this function is in; empty if that cannot be told.
fs::path folderOfLibrary() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void*>(&folderOfLibrary), &info) == 0 || !info.dli_fname) return {};
    std::error_code fault;
    return fs::canonical(info.dli_fname, fault).parent_path();
}

}  // namespace

fs::path installedWeights(const KpcnSettings& settings) {
    const fs::path name = settings.cis565 ? "kpcn-cis565.safetensors" : "kpcn.safetensors";
    const fs::path folder = folderOfLibrary();
    const fs::path installed = (folder / LIMPID_WEIGHTS_FROM_LIBRARY / name).lexically_normal();
    std::error_code fault;
    for (const fs::path& candidate : {folder / name, installed}) {
        if (fs::exists(candidate, fault)) return candidate;
    }
    throw InputError(installed, formatText("the weights that come with Limpid are neither there nor in {}",
                                           folder.string()));
}

}  // namespace limpid::denoise

#include "denoise/api/denoiser.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "denoise/nano_host/network_host.h"

namespace limpid::denoise {
namespace {

/// Records a denoiser of the list of methods. If the device is the CPU, oneDNN computes networks, if it is
/// there.
template <DenoiserOutput (*recipe)(gpu::FrameGraph&, const DenoiserInput&, const FilterSettings&)>
DenoiserOutput recordFilter(gpu::FrameGraph& graph, const DenoiserInput& input,
                            const DenoiserSettings& settings, const DenoiserNetworks&) {
    if (!input.cpu || input.host) return recipe(graph, input, settings);
    DenoiserInput onHost = input;
    onHost.host = networkHost();
    return recipe(graph, onHost, settings);
}

DenoiserOutput recordKpcn(gpu::FrameGraph& graph, const DenoiserInput& input,
                          const DenoiserSettings& settings, const DenoiserNetworks& networks) {
    if (!networks.kpcn) throw Error("kpcn has no network: DenoiserNetworks::kpcn must be set");
    return {antialias(graph, input, filterKpcn(graph, input, settings.kpcn, *networks.kpcn), settings.taa),
            {}};
}

constexpr std::array<std::string_view, 2> kpcnGroups{"kpcn", "taa"};

#define LIMPID_ROW(method)                             \
    Denoiser{.name = #method,                          \
             .help = method::help,                     \
             .record = recordFilter<method::record>,   \
             .groups = method::groups,                 \
             .network = false,                         \
             .readsVariances = method::readsVariances, \
             .oneChannel = method::oneChannel,         \
             .keepsHistory = method::keepsHistory,     \
             .samples = method::samples},
constexpr std::array unordered{LIMPID_METHODS(LIMPID_ROW) Denoiser{
    "kpcn", "kernels predicted by a trained network: each frame by itself, of about 32 samples", recordKpcn,
    kpcnGroups, true, true, false, false, 32}};
#undef LIMPID_ROW

/// What most people want comes first in lists; limpid_method numbers methods by their age.
constexpr std::array<std::string_view, 4> first{"svgf", "nano", "film", "kpcn"};

constexpr auto all = [] {
    std::array<Denoiser, unordered.size()> ordered{};
    size_t count = 0;
    for (const std::string_view name : first)
        ordered[count++] = *std::ranges::find(unordered, name, &Denoiser::name);
    for (const Denoiser& denoiser : unordered)
        if (std::ranges::find(first, denoiser.name) == first.end()) ordered[count++] = denoiser;
    return ordered;
}();

}  // namespace

std::span<const Denoiser> denoisers() {
    return all;
}

const Denoiser* findDenoiser(std::string_view name) {
    const auto found = std::ranges::find(all, name, &Denoiser::name);
    return found == all.end() ? nullptr : &*found;
}

}  // namespace limpid::denoise

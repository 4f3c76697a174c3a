// Lists every denoiser by name. To run one inside any renderer:
//
//     denoise::DenoiserSettings settings;            // or from --set and --preset
//     graph.beginFrame();
//     denoise::DenoiserInput input = ...;            // your images, or denoise::upload(graph, hostFrame)
//     const auto& method = *denoise::findDenoiser("atrous");
//     const gpu::ImageHandle beauty = method.record(graph, input, settings, {}).beauty;
//     graph.execute(device);
//
// One FrameGraph holds the histories of one sequence. Frames must come in order; at a cut, mark all motion
// invalid or call graph.resetHistories().
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "denoise/api/denoiser_input.h"
#include "denoise/kpcn/kpcn.h"
#include "denoise/methods/methods.h"

namespace limpid::denoise {

struct DenoiserSettings : FilterSettings {
    KpcnSettings kpcn;
    bool operator==(const DenoiserSettings&) const = default;
};

/// Trained networks, on the device that executes the graph. Null if no denoiser needs it.
struct DenoiserNetworks {
    std::shared_ptr<const KpcnNetwork> kpcn;
    bool operator==(const DenoiserNetworks&) const = default;
};

struct Denoiser {
    std::string_view name;  ///< as for --denoiser
    std::string_view help;
    /// Records one frame. Throws Error if a network is missing.
    DenoiserOutput (*record)(gpu::FrameGraph&, const DenoiserInput&, const DenoiserSettings&,
                             const DenoiserNetworks&) = nullptr;
    /// The parameter groups that it uses.
    std::span<const std::string_view> groups;
    bool network = false;  ///< needs one of DenoiserNetworks, and frames with variances of several samples
    bool readsVariances = false;  ///< of several samples, where frames have them
    bool oneChannel = false;      ///< Method::oneChannel
    bool keepsHistory = false;    ///< Method::keepsHistory
    uint32_t samples = 1;         ///< Method::samples
};

/// In the order of lists for users.
std::span<const Denoiser> denoisers();
/// Returns null if there is no denoiser of that name.
const Denoiser* findDenoiser(std::string_view name);

}  // namespace limpid::denoise

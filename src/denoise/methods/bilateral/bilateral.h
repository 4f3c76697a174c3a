// A joint bilateral filter of one frame, without history: the simplest denoiser here, and an example for new
// ones. Each pixel becomes the weighted mean of the light around it; a neighbour's weight is
//
//     exp(-|p - q|^2 / (2 sigma^2)) * max(n_p . n_q, 0)^normal_power * exp(-d / (plane * z))
//
// with sigma = radius / 2, the normals n, q's distance d from the plane through p's surface point, and the
// distance z of that point from the eye. Light is divided by max(albedo, min_albedo) while it is filtered. C.
// Tomasi and R. Manduchi, "Bilateral Filtering for Gray and Color Images", ICCV 1998; G. Petschnigg et al.,
// "Digital Photography with Flash and No-Flash Image Pairs", SIGGRAPH 2004.
#pragma once

#include "denoise/methods/method.h"

namespace limpid::denoise {

/// User settings; bilateral::params() gives ranges and descriptions.
struct BilateralSettings {
    int radius = 6;
    float normalPower = 32.0f;
    float minAlbedo = 0.05f;
    float plane = 0.01f;
    bool operator==(const BilateralSettings&) const = default;
};

/// The filtered beauty, rgba32f, alpha 1. Pass: "bilateral".
gpu::ImageHandle filterBilateral(gpu::FrameGraph& graph, const DenoiserInput& input,
                                 const BilateralSettings& settings);

/// The entry in the list of methods (methods.h).
namespace bilateral {
using Settings = BilateralSettings;
inline constexpr std::string_view help =
    "a joint bilateral filter of one frame: the simplest method, an example";
inline constexpr std::array<std::string_view, 2> groups{"bilateral", "taa"};
const ParamTable<Settings>& params();
inline constexpr bool readsLayers = true;
inline constexpr bool readsVariances = false;
inline constexpr bool oneChannel = false;
inline constexpr bool keepsHistory = false;
inline constexpr uint32_t samples = 1;
DenoiserOutput record(gpu::FrameGraph& graph, const DenoiserInput& input, const FilterSettings& settings);
}  // namespace bilateral

}  // namespace limpid::denoise

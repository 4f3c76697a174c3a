// One view with few samples and with many: what a network learns from. docs/kpcn.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "neural/tensor_file.h"
#include "renderer/method/settings.h"
#include "scene/device/gpu_scene.h"

namespace limpid::cli {

/// References are independent of the noisy pictures: their seed differs by these bits.
inline constexpr uint32_t referenceSeed = 0x9E3779B9u;

struct ExampleSettings {
    gpu::Extent extent{256, 256};
    std::vector<uint32_t> samples{1, 4, 8, 32,
                                  128};  ///< per pixel, ascending; each of them contains those before
    uint32_t referenceSamples = 1024;    ///< independent of the others
    uint32_t seed = 0;
    Jitter jitter = Jitter::Pixel;
};

/// Adds tensors (channels, rows, columns) of halves to `file`, all finite: for each number of samples N
/// "NAME/N/LAYER" with the layers diffuse, specular, albedo, normal (3 channels), depth (1; 0: nothing is
/// seen) and of each LAYER.variance (1; of the mean, as docs/layers.md says), and "NAME/reference/diffuse"
/// and "NAME/reference/specular".
void addExample(gpu::Device& device, scene::GpuScene& scene, const scene::Camera& camera,
                const ExampleSettings& settings, const std::string& name, neural::TensorFile& file);

}  // namespace limpid::cli

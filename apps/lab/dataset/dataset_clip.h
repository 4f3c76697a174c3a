// Frames of a sequence as a network that filters accumulated light sees them, and clean ones.
// docs/kpcn.md.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "neural/tensor_file.h"
#include "renderer/method/settings.h"
#include "renderer/sequence/sequence.h"
#include "scene/device/gpu_scene.h"

namespace limpid::cli {

struct ClipSettings {
    gpu::Extent extent{256, 256};
    std::vector<uint32_t> frames{1, 3, 7, 15};  ///< the numbers of those that are stored, ascending
    uint32_t samples = 1;                       ///< per pixel and frame
    uint32_t referenceSamples = 1024;           ///< of each of both references
    uint32_t seed = 0;
    Jitter jitter = Jitter::Off;    ///< or Pixel, for several samples
    std::string denoiser = "svgf";  ///< or "nano", "film"
};

/// Renders the frames from 0 on, filters them by the denoiser with its defaults, and adds tensors (channels,
/// rows, columns) of halves to `file`, all finite. For each stored frame F and each SIGNAL of "diffuse" and
/// "specular":
/// - "NAME/F/SIGNAL" (4): accumulated light without albedo, and the expected deviation of its luminance,
///   below 0 where nothing is seen;
/// - "NAME/F/SIGNAL.first" (4): the same after the first level of the filter, or where the history is short
///   after "svgf/young";
/// - "NAME/F/SIGNAL.svgf" (4): the same after SVGF's last level;
/// - "NAME/F/SIGNAL.past" (3): stabilised light of the frame before;
/// - "NAME/F/SIGNAL.frames" (1): the length of the history;
/// - "NAME/F/LAYER" with the layers albedo, albedoSpecular, emission, normal (3), motion (2; 65504: none),
///   depth, roughness (1);
/// - "NAME/F/svgf" (4): the denoiser's picture;
/// - "NAME/F/reference" (3): clean beauty with the same jitter, and "NAME/F/reference2" the same with noise
///   that is independent of the first one's;
/// - "NAME/F/camera" (4, 3; float32): the camera's right, up and forward vectors, and its origin.
void addClip(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
             const ClipSettings& settings, const std::string& name, neural::TensorFile& file);

}  // namespace limpid::cli

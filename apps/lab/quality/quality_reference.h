// Converged frames that `limpid bench quality` judges by: rendered, or read from files of an earlier run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "gpu/vulkan/device.h"
#include "image/metrics/geometry.h"
#include "renderer/method/settings.h"
#include "renderer/sequence/sequence.h"
#include "scene/device/gpu_scene.h"

namespace limpid::cli {

/// Frames `first` to `count` - 1 are compared; those before fill the histories.
struct QualityFrames {
    uint64_t first = 16, count = 61;
};

struct Reference {
    image::Image picture;  ///< linear radiance
    image::Geometry geometry;
    image::Image difference;  ///< of its two halves, each of independent samples: tells the picture's error
};

/// Where references are kept from run to run.
struct ReferenceFiles {
    std::filesystem::path folder;  ///< empty: they are not kept
    std::string sequence;          ///< what files are named after
    uint64_t sceneHash = 0;        ///< renderer/long/render_identity.h
};

/// The references of `frames`, in order, of `samples` (at least 2) per pixel, through the pixels' centres
/// with Jitter::Off. A file's name says the sequence, size, samples, frame, and by a hash the scene's
/// content, the camera and the path tracer's parameters: a file of that name is read instead of rendered, and
/// written where there is none. Throws InputError if a file is damaged or is not what its name says.
std::vector<Reference> makeReferences(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                                      const RenderSettings& settings, const QualityFrames& frames,
                                      uint64_t samples, const ReferenceFiles& files);

}  // namespace limpid::cli

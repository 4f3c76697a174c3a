// What `limpid bench quality` measures: pipelines on a moving sequence against converged references of the
// same frames.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "image/frame_scores.h"
#include "renderer/sequence.h"
#include "renderer/settings.h"

namespace limpid::cli {

/// Frames `first` to `count` - 1 are compared; those before fill the histories.
struct QualityFrames {
    uint64_t first = 16, count = 61;
};

/// The noisy frames, or what a pipeline made of them.
struct MethodQuality {
    std::string name;
    std::vector<image::FrameScores> scores;
    image::Image last;                       ///< linear radiance
    std::map<std::string, double> medianMs;  ///< by pass; empty for the noisy frames
};

struct SequenceQuality {
    std::vector<MethodQuality> methods;  ///< the noisy frames first
    /// PSNR of the mean reference against the truth, from the difference of its two independent halves.
    double referencePsnr = 0.0;
    float exposure = 0.0f;   ///< stops, from the references
    image::Image reference;  ///< of the last frame
};

/// A pipeline with its parameters.
struct QualityMethod {
    std::string name;
    RenderSettings settings;
};

/// Renders references of `referenceSamples` (at least 2) per pixel, and every method at `samples` per
/// frame. Rays go through the pixels' centres in both.
SequenceQuality measureQuality(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                               const std::vector<QualityMethod>& methods, const QualityFrames& frames,
                               uint64_t referenceSamples, uint32_t samples);

}  // namespace limpid::cli

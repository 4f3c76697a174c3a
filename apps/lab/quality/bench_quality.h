// What `limpid bench quality` measures: denoisers on a moving sequence against converged references of the
// same frames.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "gpu/vulkan/device.h"
#include "image/metrics/frame_scores.h"
#include "lab/quality/quality_methods.h"
#include "lab/quality/quality_reference.h"
#include "renderer/method/settings.h"
#include "renderer/sequence/sequence.h"

namespace limpid::cli {

/// The noisy frames, or what a denoiser made of them.
struct MethodQuality {
    std::string name;
    std::vector<image::FrameScores> scores;
    image::Image last;  ///< linear radiance
    /// PNGs for the report, one of each compared frame: the picture as the metrics see it (exposed, clamped,
    /// sRGB), and its FLIP map, grey, 255 for 1. Empty without a report.
    std::vector<std::vector<char>> pictures, errorMaps;
    std::map<std::string, double> medianMs;  ///< by pass; empty for the noisy frames
    std::vector<double> denoisingMs;  ///< of the denoising passes, by compared frame; empty for noisy frames
    /// Device memory of all images that the denoising passes write, with their histories; 0 for noisy frames.
    double denoisingBytesPerPixel = 0.0;
};

struct SequenceQuality {
    std::vector<MethodQuality> methods;  ///< the noisy frames first
    /// PSNR of the mean reference against the truth, from the difference of its two independent halves.
    double referencePsnr = 0.0;
    float exposure = 0.0f;                             ///< stops, from the references
    image::Image reference;                            ///< of the last frame
    std::vector<std::vector<char>> referencePictures;  ///< like MethodQuality::pictures
};

/// Judges every method, at `samples` per frame, by the references of `frames` (makeReferences). Rays go
/// through the pixels' centres. With `keepPictures`, the PNGs for a report are made, too.
SequenceQuality measureQuality(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                               const std::vector<QualityMethod>& methods, const QualityFrames& frames,
                               const std::vector<Reference>& references, uint32_t samples, bool keepPictures);

}  // namespace limpid::cli

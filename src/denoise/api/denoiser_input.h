// What every denoiser reads.
#pragma once

#include "denoise/api/host_frame.h"
#include "gpu/graph/frame_graph.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

/// One frame: images of one size, rgba32f unless said otherwise. What their components hold is in
/// docs/denoising.md, "What a frame gives"; rays go through the pixels' centres. NaN and infinity are
/// allowed: such radiance is rejected, such a distance or motion counts as missing, and so does such a normal
/// (SVGF takes it as +Z).
struct DenoiserInput {
    gpu::ImageHandle diffuse, specular;  ///< scattered light, cd/m^2, albedo multiplied in
    gpu::ImageHandle emission;           ///< what the camera sees directly
    gpu::ImageHandle albedo, albedoSpecular;
    gpu::ImageHandle normal, depth;
    gpu::ImageHandle motion, reflectionMotion, previousNormal;
    gpu::ImageHandle ids;  ///< rg32ui: instance, material; UINT32_MAX where nothing is seen
    CameraParams camera{};
    /// Per pixel, in these means. Alpha of diffuse, specular, albedo and normal is the mean squared deviation
    /// over them, of the luminance (of normals the components' mean), and of depth its own; only networks
    /// look at it.
    uint32_t samples = 1;
    gpu::Backing filters = gpu::Backing::Image;  ///< gpu::filterBacking(device)
};

/// The frame's images on the device. Throws Error if an image of `frame` has another size than the frame.
DenoiserInput upload(gpu::FrameGraph& graph, const HostFrame& frame);

}  // namespace limpid::denoise

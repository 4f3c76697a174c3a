// What every denoiser reads.
#pragma once

#include "base/layers/layer_set.h"
#include "denoise/api/host_frame.h"
#include "gpu/graph/frame_graph.h"
#include "shaders/common/camera.h"

namespace limpid::denoise {

/// One frame: an image for each layer of base/layers/layer_table.h, all of one size, rgba32f; `ids` is
/// rg32ui: instance, material; UINT32_MAX where nothing is seen. What the components hold is in
/// docs/denoising.md, "What a frame gives"; rays go through the pixels' centres. NaN and infinity are
/// allowed: such radiance is rejected, such a distance or motion counts as missing, and so does such a normal
/// (SVGF takes it as +Z).
struct DenoiserInput : LayerSet<gpu::ImageHandle> {
    CameraParams camera{};
    /// Per pixel, in these means. Alpha of diffuse, specular, albedo and normal is the mean squared deviation
    /// over them, of the luminance (of normals the components' mean), and of depth its own; only networks
    /// look at it.
    uint32_t samples = 1;
    gpu::Backing filters = gpu::Backing::Image;  ///< gpu::filterBacking(device)
};

/// The frame's images on the device; zeros for optional layers that are empty. Throws Error if an image of
/// `frame` has another size than the frame.
DenoiserInput upload(gpu::FrameGraph& graph, const HostFrame& frame);

}  // namespace limpid::denoise

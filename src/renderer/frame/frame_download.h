// What a frame left on the device, as images and numbers on the host.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/device.h"
#include "renderer/frame/frame.h"
#include "renderer/layers/layers.h"

namespace limpid {

struct RenderCounters {
    uint64_t rays = 0;      ///< closest-hit and shadow rays
    uint64_t rejected = 0;  ///< samples dropped because they were NaN or infinite
};

/// The sum over the pixels of the image `counters`: rays | rejected, as downloaded.
RenderCounters sumCounters(std::span<const uint32_t> pixels);

/// For --dump: the images, by name, that the named pass wrote in the graph's last frame, and the history
/// images that it read. Throws UsageError with the list of passes if there is no such pass.
std::vector<std::pair<std::string, image::Image>> imagesOfPass(gpu::FrameGraph& graph, gpu::Device& device,
                                                               const std::string& pass);

/// Downloads a graph's last frame without its empty images. `samples`: samples per pixel in the means. Waits
/// for the device. Throws Error if there is no frame.
RenderedLayers downloadLayers(gpu::FrameGraph& graph, gpu::Device& device, const FrameImages& images,
                              uint64_t samples);

}  // namespace limpid

// The network's frame in host memory, from other programs' images.
#pragma once

#include <cstdint>
#include <vector>

#include "base/message.h"
#include "denoise/api/denoiser_input.h"
#include "limpid/neural.h"

namespace limpid::denoise {

/// Four floats a pixel, as DenoiserInput has them.
struct NetworkPixels {
    uint32_t width = 0, height = 0;
    uint32_t samples = 0;  ///< at least 2, so that variances count
    std::vector<float> diffuse, specular, emission, albedo, normal, depth;
};

/// Throws UsageError if the size is impossible, a needed image is missing, an image has another number of
/// components than possible, or light has no finite pixel. Tells `messages` of pixels that are not finite.
NetworkPixels readNetworkFrame(const limpid_network_frame& frame, float farDepth,
                               const MessageCallback& messages);

/// What filterKpcn() reads of it; the other images are empty.
DenoiserInput uploadNetworkFrame(gpu::FrameGraph& graph, const NetworkPixels& pixels);

}  // namespace limpid::denoise

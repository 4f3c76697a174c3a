#include "viewer/compare/texels.h"

namespace limpid::viewer {

void Texels::show(gpu::Device& device, const std::vector<uint32_t>& texels, gpu::Extent extent) {
    graph_.beginFrame();
    shown_ = graph_.transient("texels", gpu::Format::RGBA8Unorm, extent);
    graph_.upload(shown_, std::as_bytes(std::span(texels)));
    graph_.execute(device);
}

}  // namespace limpid::viewer

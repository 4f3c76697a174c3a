#include "viewer/compare/texels.h"

namespace limpid::viewer {

void Texels::show(gpu::Device& device, const std::vector<uint32_t>& texels, gpu::Extent extent) {
    upload(device, gpu::Format::RGBA8Unorm, std::as_bytes(std::span(texels)), extent);
}

void Texels::show(gpu::Device& device, const studio::Picture& picture) {
    if (picture.extended.empty()) return show(device, picture.texels, picture.extent);
    upload(device, gpu::Format::RGBA16Float, std::as_bytes(std::span(picture.extended)), picture.extent);
}

void Texels::upload(gpu::Device& device, gpu::Format format, std::span<const std::byte> texels,
                    gpu::Extent extent) {
    graph_.beginFrame();
    shown_ = graph_.transient("texels", format, extent);
    graph_.upload(shown_, texels);
    graph_.execute(device);
}

}  // namespace limpid::viewer

#include "studio/live/picture_copy.h"

#include <span>
#include <vector>

namespace limpid::studio {

namespace {

/// Texels are as aligned as the readback's memory, so that they are copied once, and not cleared before.
template <typename Texel>
std::vector<Texel> texelsOf(std::span<const std::byte> pixels) {
    const auto* const texels = reinterpret_cast<const Texel*>(pixels.data());
    return {texels, texels + pixels.size() / sizeof(Texel)};
}

}  // namespace

void PictureCopy::start(gpu::FrameGraph& graph, gpu::ImageHandle image) {
    picture_.reset();
    extent_ = graph.extent(image);
    extended_ = graph.format(image) == gpu::Format::RGBA16Float;
    readback_.start(graph, image);
}

const std::shared_ptr<const Picture>& PictureCopy::picture() {
    if (picture_) return picture_;
    const std::span<const std::byte> pixels = readback_.pixels();
    Picture picture{.extent = extent_, .texels = {}};
    if (extended_)
        picture.extended = texelsOf<uint64_t>(pixels);
    else
        picture.texels = texelsOf<uint32_t>(pixels);
    picture_ = std::make_shared<const Picture>(std::move(picture));
    return picture_;
}

}  // namespace limpid::studio

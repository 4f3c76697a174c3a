#include "studio/loop/picture_copy.h"

#include <span>
#include <vector>

namespace limpid::studio {

void PictureCopy::start(gpu::FrameGraph& graph, gpu::ImageHandle image) {
    picture_.reset();
    extent_ = graph.extent(image);
    readback_.start(graph, image);
}

const std::shared_ptr<const Picture>& PictureCopy::picture() {
    if (!picture_) {
        const std::span<const std::byte> pixels = readback_.pixels();
        // Texels are as aligned as the readback's memory, so that they are copied once, and not cleared
        // before.
        const auto* const texels = reinterpret_cast<const uint32_t*>(pixels.data());
        picture_ = std::make_shared<const Picture>(
            Picture{extent_, std::vector<uint32_t>(texels, texels + pixels.size() / sizeof(uint32_t))});
    }
    return picture_;
}

}  // namespace limpid::studio

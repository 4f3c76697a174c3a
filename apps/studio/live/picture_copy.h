// Brings the picture of a frame to the host, while the next frame may be rendered.
#pragma once

#include <memory>

#include "gpu/vulkan/image_readback.h"
#include "studio/picture.h"

namespace limpid::studio {

class PictureCopy {
  public:
    /// The device outlives this.
    explicit PictureCopy(gpu::Device& device) : readback_(device) {}

    /// Submits the copy of an RGBA8Unorm or RGBA16Float image of the graph's last executed frame. Does not
    /// wait for it, but for the copy before it.
    void start(gpu::FrameGraph& graph, gpu::ImageHandle image);
    /// Waits until the device has finished the frame.
    void wait() { readback_.wait(); }
    /// Waits, too. The same object each time.
    const std::shared_ptr<const Picture>& picture();

  private:
    gpu::ImageReadback readback_;
    gpu::Extent extent_;
    bool extended_ = false;
    std::shared_ptr<const Picture> picture_;
};

}  // namespace limpid::studio

// Draws the presenter's Overlay: textured triangles over a picture in a window.
#pragma once

#include "gpu/present/graphics_pipeline.h"
#include "gpu/present/presenter.h"
#include "gpu/vulkan/memory/buffer.h"
#include "gpu/vulkan/memory/transfer.h"

namespace limpid::gpu {

class OverlayDrawer {
  public:
    explicit OverlayDrawer(std::shared_ptr<const Context> context);
    /// The format of the render targets, before the first draw(). The device must be idle.
    void setTarget(VkFormat format);

    /// The triangles of one picture in flight.
    struct Triangles {
        std::shared_ptr<BufferStorage> buffer;  ///< vertices, then indices
        uint64_t indicesAt = 0;
    };

    void setTexture(Transfer& transfer, Extent extent, std::span<const uint32_t> texels);
    /// `triangles` must not be in use on the device.
    void upload(Triangles& triangles, const Overlay& overlay) const;
    /// Records drawing over the content of `target`, which is in that layout. Does nothing if there is no
    /// texture.
    void draw(VkCommandBuffer commands, const Triangles& triangles, const Overlay& overlay,
              VkImageView target, VkImageLayout layout, Extent extent) const;

  private:
    std::shared_ptr<const Context> context_;
    SmallLayout layout_;
    UniquePipeline pipeline_;
    std::shared_ptr<BufferStorage> texture_;
    Extent textureExtent_;
};

}  // namespace limpid::gpu

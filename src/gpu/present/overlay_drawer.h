// Draws the presenter's Overlay: textured triangles over a picture in a window.
#pragma once

#include "gpu/present/presenter.h"
#include "gpu/vulkan/memory/buffer.h"
#include "gpu/vulkan/memory/transfer.h"

namespace limpid::gpu {

class OverlayDrawer {
  public:
    /// `target` is the format of the render targets.
    OverlayDrawer(std::shared_ptr<const Context> context, VkFormat target);

    /// The triangles of one picture in flight.
    struct Triangles {
        std::shared_ptr<BufferStorage> buffer;  ///< vertices, then indices
        uint64_t indicesAt = 0;
    };

    void setTexture(Transfer& transfer, Extent extent, std::span<const uint32_t> texels);
    /// `triangles` must not be in use on the device.
    void upload(Triangles& triangles, const Overlay& overlay) const;
    /// Records drawing over the content of `target`, which must be in COLOR_ATTACHMENT_OPTIMAL layout. Does
    /// nothing if there is no texture.
    void draw(VkCommandBuffer commands, const Triangles& triangles, const Overlay& overlay,
              VkImageView target, Extent extent) const;

  private:
    void makeLayout();
    void makeDescriptors();

    std::shared_ptr<const Context> context_;
    UniqueSetLayout setLayout_;
    UniquePipelineLayout layout_;
    UniquePipeline pipeline_;
    UniqueDescriptorPool descriptors_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    std::shared_ptr<BufferStorage> texture_;
    Extent textureExtent_;
};

}  // namespace limpid::gpu

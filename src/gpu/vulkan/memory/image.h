// Images on the device: storage images of one layer and one level, always in GENERAL layout; or texels in a
// buffer.
#pragma once

#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/memory/buffer.h"
#include "gpu/vulkan/memory/memory.h"

namespace limpid::gpu {

struct Image {
    std::shared_ptr<const Context> context;
    Memory memory;
    UniqueImage image;
    UniqueImageView view;
    std::shared_ptr<BufferStorage> buffer;  ///< with Backing::Buffer, replaces the three members above
    Format format{};
    Extent extent;
};

/// The image is in UNDEFINED layout at first. `moreUsage`: beyond storage, sampling and copies. Throws Error
/// naming the limit if the extent exceeds one.
Image makeImage(std::shared_ptr<const Context> context, const std::string& name, Format format, Extent extent,
                Backing backing = Backing::Image, VkImageUsageFlags moreUsage = 0);

VkImageSubresourceRange wholeImage();

}  // namespace limpid::gpu

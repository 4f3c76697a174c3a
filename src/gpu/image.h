// Storage images on the device: one layer, one level, GENERAL layout for all their life.
#pragma once

#include "gpu/frame_graph.h"
#include "gpu/memory.h"

namespace limpid::gpu {

struct Image {
    std::shared_ptr<const Context> context;
    Memory memory;
    UniqueImage image;
    UniqueImageView view;
    Format format{};
    Extent extent;
};

/// In UNDEFINED layout at first. Throws Error if the extent exceeds maxImageDimension2D.
Image makeImage(std::shared_ptr<const Context> context, const std::string& name, Format format,
                Extent extent);

VkImageSubresourceRange wholeImage();

}  // namespace limpid::gpu

// A window of a high dynamic range is composed in an image of its own, and then converted for its surface.
#pragma once

#include <optional>

#include "gpu/present/graphics_pipeline.h"
#include "gpu/present/presenter.h"
#include "gpu/present/surface_format.h"
#include "gpu/vulkan/memory/image.h"

namespace limpid::gpu {

class SurfaceEncoder {
  public:
    static constexpr VkFormat composedFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

    /// `surface`: ScRgb or Hdr10.
    SurfaceEncoder(std::shared_ptr<const Context> context, const SurfaceFormat& surface);

    /// The device must not use the image before.
    void resize(Extent extent);
    /// Encoded sRGB whose curve continues above 1, the paper white; always in GENERAL layout, but UNDEFINED
    /// at first. Can be blitted to and drawn into.
    const Image& composed() const { return *composed_; }
    /// Records the conversion of all its pixels. `target` has its extent, and is in that layout.
    void encode(VkCommandBuffer commands, VkImageView target, VkImageLayout layout,
                const HighRange& range) const;

  private:
    std::shared_ptr<const Context> context_;
    SurfaceEncoding encoding_;
    SmallLayout layout_;
    UniquePipeline pipeline_;
    std::optional<Image> composed_;
};

}  // namespace limpid::gpu

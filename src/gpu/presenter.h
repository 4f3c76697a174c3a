// Pictures of a frame graph in a window, with triangles over them: a user interface.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "gpu/frame_graph.h"

namespace limpid::gpu {

struct OverlayVertex {
    float x, y;      ///< pixels of the window, from its upper left corner
    float u, v;      ///< of the texture, 0 to 1
    uint32_t color;  ///< RGBA8, red in the lowest byte; multiplied with the texture's
};

/// A run of triangles within a rectangle.
struct OverlayDraw {
    float left, top, right, bottom;  ///< pixels
    uint32_t firstIndex, indexCount, firstVertex;
};

struct Overlay {
    std::span<const OverlayVertex> vertices;
    std::span<const uint16_t> indices;  ///< three a triangle, counted from a draw's first vertex
    std::span<const OverlayDraw> draws;
};

class Presenter {
  public:
    /// `makeSurface` gets the VkInstance and returns a VkSurfaceKHR, which belongs to the presenter from then
    /// on; it may throw. The device must have been made with DeviceOptions::surfaceExtensions, and outlives
    /// the presenter. Throws Error if it cannot show pictures on this surface.
    Presenter(Device& device, const std::function<uint64_t(void* instance)>& makeSurface);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// RGBA8 texels of what overlays are textured with.
    void setTexture(Extent extent, std::span<const uint32_t> texels);

    /// Shows an image (RGBA8Unorm, not in a buffer) of the graph's last executed frame, scaled to the window,
    /// and the overlay over it. `window`: its size in pixels. Returns false if nothing was shown: the window
    /// has no pixels, or has just changed its size.
    bool present(FrameGraph& graph, ImageHandle picture, Extent window, const Overlay& overlay);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    Device& device_;
};

}  // namespace limpid::gpu

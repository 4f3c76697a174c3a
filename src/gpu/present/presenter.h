// Pictures of a frame graph in a window, with triangles over them: a user interface.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "gpu/graph/frame_graph.h"

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

/// A part of a picture or of a window, from 0 to 1: its left and upper edge, and its right and lower one.
struct Rectangle {
    float left = 0.0f, top = 0.0f, right = 1.0f, bottom = 1.0f;
};

/// A picture in a part of the window.
struct Pane {
    FrameGraph* graph = nullptr;
    ImageHandle picture;       ///< of its last executed frame; RGBA8Unorm, not in a buffer
    Rectangle source, target;  ///< which part of the picture, and of the window
    bool enlarge = false;      ///< pixels stay squares instead of being smoothed
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

    /// Shows the panes, each scaled to its part of the window, later ones over earlier ones, and the overlay
    /// over all. `window`: its size in pixels. Returns false if nothing was shown: the window has no pixels,
    /// or has just changed its size.
    bool present(std::span<const Pane> panes, Extent window, const Overlay& overlay);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    Device& device_;
};

}  // namespace limpid::gpu

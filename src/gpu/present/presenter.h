// Shows pictures of a frame graph in a window, with triangles of a user interface on top.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

struct OverlayVertex {
    float x, y;      ///< pixels of the window, from its upper left corner
    float u, v;      ///< texture coordinates, 0 to 1
    uint32_t color;  ///< RGBA8, red in the lowest byte; multiplied by the texture's colour
};

/// A range of triangles, clipped to a rectangle.
struct OverlayDraw {
    float left, top, right, bottom;  ///< pixels
    uint32_t firstIndex, indexCount, firstVertex;
};

struct Overlay {
    std::span<const OverlayVertex> vertices;
    std::span<const uint16_t> indices;  ///< three per triangle, relative to a draw's first vertex
    std::span<const OverlayDraw> draws;
};

/// A part of a picture or of a window, from 0 to 1: left, upper, right and lower edge.
struct Rectangle {
    float left = 0.0f, top = 0.0f, right = 1.0f, bottom = 1.0f;
};

/// Output of a high dynamic range (HDR).
struct HighRange {
    float paperWhite = 203.0f;  ///< cd/m^2 of white, 1 in pictures and in the overlay (ITU-R BT.2408)
    float peak = 1000.0f;       ///< cd/m^2 at which each channel is clipped; at least paperWhite
    bool operator==(const HighRange&) const = default;
};

/// A picture shown in a part of the window.
struct Pane {
    FrameGraph* graph = nullptr;
    /// From its last executed frame; encoded sRGB, not in a buffer: RGBA8Unorm, or RGBA16Float, whose curve
    /// continues above 1 (with HighRange; else it is clipped).
    ImageHandle picture;
    Rectangle source, target;  ///< the shown part of the picture, and where it goes in the window
    bool enlarge = false;      ///< show pixels as squares instead of filtering them
};

class Presenter {
  public:
    /// `makeSurface` receives the VkInstance and returns a VkSurfaceKHR, which the presenter then owns; it
    /// may throw. The device must have been created with DeviceOptions::surfaceExtensions and must outlive
    /// the presenter. Throws Error if it cannot present on this surface.
    Presenter(Device& device, const std::function<uint64_t(void* instance)>& makeSurface);
    ~Presenter();
    Presenter(const Presenter&) = delete;
    Presenter& operator=(const Presenter&) = delete;

    /// Sets the RGBA8 texels of the texture that overlays use.
    void setTexture(Extent extent, std::span<const uint32_t> texels);

    /// Why the window cannot show a high dynamic range; empty: it can. The answer may change with the
    /// window's place and size. A surface that can need not mean a display that does.
    std::string highRangeFault() const;
    /// Shows a high dynamic range where the window can; none: the range of sRGB, as at first.
    void setHighRange(const std::optional<HighRange>& wanted);

    /// Shows the panes, each scaled to its part of the window, later ones over earlier ones, and the overlay
    /// on top. `window`: its size in pixels. Returns false if nothing was shown: the window has no pixels, or
    /// has just been resized.
    bool present(std::span<const Pane> panes, Extent window, const Overlay& overlay);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
    Device& device_;
};

}  // namespace limpid::gpu

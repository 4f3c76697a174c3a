// Brings images to the host while the device computes the next frame.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "gpu/graph/frame_graph.h"

namespace limpid::gpu {

class Device;

/// Copies one image at a time. FrameGraph::download...() waits instead, and copies once more.
class ImageReadback {
  public:
    /// The device must outlive this. Throws Error on an adopted device.
    explicit ImageReadback(Device& device);
    /// Waits for a copy that is under way.
    ~ImageReadback();
    ImageReadback(ImageReadback&&) noexcept;
    ImageReadback& operator=(ImageReadback&&) = delete;

    /// Submits the copy of an image of the graph's last executed frame, and returns without waiting. Frames
    /// that are executed afterwards do not change what is copied. Waits first for the copy before this one.
    /// Throws Error if the image cannot be downloaded.
    void start(FrameGraph& graph, ImageHandle image);
    /// Waits until the copy is finished, and with it the frame. Throws DeviceLost.
    void wait();
    /// The pixels of the last copy, all components, row 0 first; valid until the next start(). Waits.
    std::span<const std::byte> pixels();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace limpid::gpu

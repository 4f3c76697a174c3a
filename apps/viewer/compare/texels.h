// A picture that the host has made, for the window.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/present/presenter.h"
#include "studio/picture.h"

namespace limpid::viewer {

class Texels {
  public:
    /// RGBA8, red in the lowest byte.
    void show(gpu::Device& device, const std::vector<uint32_t>& texels, gpu::Extent extent);
    void show(gpu::Device& device, const studio::Picture& picture);
    /// Of what was shown last.
    gpu::Pane pane() { return {&graph_, shown_, {}, {}}; }

  private:
    void upload(gpu::Device& device, gpu::Format format, std::span<const std::byte> texels,
                gpu::Extent extent);

    gpu::FrameGraph graph_;
    gpu::ImageHandle shown_;
};

}  // namespace limpid::viewer

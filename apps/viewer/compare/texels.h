// A picture that the host has made, for the window.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/present/presenter.h"

namespace limpid::viewer {

class Texels {
  public:
    /// RGBA8, red in the lowest byte.
    void show(gpu::Device& device, const std::vector<uint32_t>& texels, gpu::Extent extent);
    /// Of what was shown last.
    gpu::Pane pane() { return {&graph_, shown_, {}, {}}; }

  private:
    gpu::FrameGraph graph_;
    gpu::ImageHandle shown_;
};

}  // namespace limpid::viewer

// A scene on the device: the buffers that shaders/scene_data.glsl declares.
#pragma once

#include <array>
#include <vector>

#include "gpu/device.h"
#include "gpu/frame_graph.h"
#include "scene/scene_data.h"

namespace limpid::scene {

class GpuScene {
  public:
    /// Uploads. Throws Error naming the limit if a buffer exceeds what the device allows.
    GpuScene(gpu::Device& device, const SceneData& data);

    /// What every pass that includes scene_data.glsl binds.
    std::vector<gpu::Binding> bindings() const;
    std::vector<gpu::ConstantValue> constants() const;
    const layout::SceneParams& params() const { return params_; }
    uint64_t byteCount() const;

  private:
    struct NamedBuffer {
        const char* name;
        gpu::Buffer buffer;
    };
    std::vector<NamedBuffer> buffers_;
    SceneFeatures features_;
    layout::SceneParams params_;
    uint32_t stackSize_;
    uint32_t texelBufferCount_ = 1;
    bool cpuDevice_;
};

}  // namespace limpid::scene

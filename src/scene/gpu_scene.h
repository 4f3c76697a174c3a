// A scene on the device: the buffers that shaders/scene_data.glsl declares.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "gpu/device.h"
#include "gpu/frame_graph.h"
#include "scene/scene_data.h"
#include "scene/tracer.h"

namespace limpid::scene {

class GpuScene {
  public:
    /// Uploads. Throws Error naming the limit if a buffer exceeds what the device allows, or if the device
    /// lacks the tracer.
    GpuScene(gpu::Device& device, const SceneData& data, Tracer tracer = Tracer::Compute);

    Tracer tracer() const { return structures_ ? Tracer::Pipeline : Tracer::Compute; }

    /// What every pass that includes scene_data.glsl binds.
    std::vector<gpu::Binding> bindings() const;
    std::vector<gpu::ConstantValue> constants() const;
    const layout::SceneParams& params() const { return params_; }
    /// Of the frame from now on (scene/scene_animator.h).
    void setParams(const layout::SceneParams& params) { params_ = params; }
    /// One of the buffers of scene_data.glsl, or of passes/deform. Throws Error if there is none of that
    /// name.
    const gpu::Buffer& buffer(std::string_view name) const;
    /// Of the `pipeline` tracer; null with the other.
    const gpu::AccelerationStructures* structures() const { return structures_ ? &*structures_ : nullptr; }
    uint64_t byteCount() const;

  private:
    struct NamedBuffer {
        const char* name;
        gpu::Buffer buffer;
    };
    void addDeformBuffers(gpu::Device& device, const SceneData& data);

    std::vector<NamedBuffer> buffers_;
    std::vector<NamedBuffer> deformBuffers_;  ///< of passes/deform alone
    std::optional<gpu::AccelerationStructures> structures_;
    SceneFeatures features_;
    layout::SceneParams params_;
    uint32_t stackSize_;
    uint32_t texelBufferCount_ = 1;
    bool cpuDevice_;
};

}  // namespace limpid::scene

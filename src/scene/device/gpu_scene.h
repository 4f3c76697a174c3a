// A scene on the device: the buffers that shaders/common/scene_data.glsl declares.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/device.h"
#include "scene/device/scene_data.h"
#include "scene/device/trees/tracer.h"

namespace limpid::scene {

class GpuScene {
  public:
    /// Uploads the scene. Throws Error naming the limit if a buffer exceeds the device's limits, or if the
    /// device does not support the tracer.
    GpuScene(gpu::Device& device, const SceneData& data, const TraceOptions& options = {});

    Tracer tracer() const { return structures_ ? Tracer::Hardware : Tracer::Compute; }

    /// Returns the bindings for every pass that includes scene_data.glsl.
    std::vector<gpu::Binding> bindings() const;
    std::vector<gpu::ConstantValue> constants() const;
    const layout::SceneParams& params() const { return params_; }
    /// Sets the parameters from the current frame on (scene/motion/scene_animator.h).
    void setParams(const layout::SceneParams& params) { params_ = params; }
    /// Returns a buffer of scene_data.glsl, passes/deform or passes/light_distances. "quantisedNodes" are
    /// bvhNodes, or the nodes from which those are expanded. Throws Error if there is no buffer of that name.
    const gpu::Buffer& buffer(std::string_view name) const;
    /// True if bvhNodes are expanded copies: changes of "quantisedNodes" must be repeated there.
    bool expandsNodes() const { return gpuTraversal_; }
    /// For the `hardware` tracer; null with the other one.
    const gpu::AccelerationStructures* structures() const { return structures_ ? &*structures_ : nullptr; }
    /// True if lights are chosen by the light tree: it was built, and is `wanted`, or there are more than 256
    /// point and spot lights, too many to be evaluated one by one for each sample.
    bool usesLightTree(bool wanted) const;
    /// The number of maps in "lightDistances"; 0 if the scene has fewer than two point and spot lights.
    uint32_t mappedLights() const { return mappedLights_; }
    /// True if geometry or lights have changed since the distances were measured, and at first. Stale maps
    /// cost samples, not correctness: at first they hide nothing.
    bool lightDistancesStale() const { return lightDistancesStale_; }
    void setLightDistancesStale(bool stale) { lightDistancesStale_ = stale && mappedLights_ > 0; }
    uint64_t byteCount() const;

  private:
    struct NamedBuffer {
        const char* name;
        gpu::Buffer buffer;
    };
    void addNodes(gpu::Device& device, const SceneData& data);
    void addLightDistances(gpu::Device& device, const SceneData& data);
    void addDeformBuffers(gpu::Device& device, const SceneData& data);

    std::vector<NamedBuffer> buffers_;
    std::vector<NamedBuffer> passBuffers_;  ///< used by passes/deform and passes/light_distances only
    std::optional<gpu::AccelerationStructures> structures_;
    SceneFeatures features_;
    layout::SceneParams params_;
    uint32_t stackSize_;
    uint32_t texelBufferCount_ = 1;
    uint32_t mappedLights_ = 0;
    bool lightDistancesStale_ = false;
    bool gpuTraversal_;
};

}  // namespace limpid::scene

// Creates ray-tracing pipelines and their shader-binding tables.
#pragma once

#include <span>

#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

/// One ray-generation shader, one miss shader and one hit group: the regions passed to vkCmdTraceRaysKHR.
struct ShaderTable {
    std::shared_ptr<const BufferStorage> buffer;
    VkStridedDeviceAddressRegionKHR rayGeneration{}, miss{}, hit{};
};

/// `stages`: ray generation, miss, closest hit, any hit. Only ray generation traces rays.
UniquePipeline makeRayPipeline(const Context& context,
                               std::span<const VkPipelineShaderStageCreateInfo> stages,
                               VkPipelineLayout layout, VkPipelineCache cache);
ShaderTable makeShaderTable(const std::shared_ptr<const Context>& context, VkPipeline pipeline,
                            const std::string& name);

}  // namespace limpid::gpu

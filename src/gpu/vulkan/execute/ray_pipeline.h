// Ray-tracing pipelines and their shader-binding tables.
#pragma once

#include <span>

#include "gpu/vulkan/memory/buffer.h"

namespace limpid::gpu {

/// One ray-generation shader, one miss shader, one hit group: the regions that vkCmdTraceRaysKHR takes.
struct ShaderTable {
    std::shared_ptr<const BufferStorage> buffer;
    VkStridedDeviceAddressRegionKHR rayGeneration{}, miss{}, hit{};
};

/// `stages`: ray generation, miss, closest hit, any hit. Rays are traced from ray generation alone.
UniquePipeline makeRayPipeline(const Context& context,
                               std::span<const VkPipelineShaderStageCreateInfo> stages,
                               VkPipelineLayout layout, VkPipelineCache cache);
ShaderTable makeShaderTable(const std::shared_ptr<const Context>& context, VkPipeline pipeline,
                            const std::string& name);

}  // namespace limpid::gpu

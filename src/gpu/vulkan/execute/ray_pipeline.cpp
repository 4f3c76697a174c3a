#include "gpu/vulkan/execute/ray_pipeline.h"

#include <array>
#include <cstring>

#include "base/error.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

enum Group : uint32_t { rayGenerationGroup, missGroup, hitGroup, groupCount };

}  // namespace

UniquePipeline makeRayPipeline(const Context& context,
                               std::span<const VkPipelineShaderStageCreateInfo> stages,
                               VkPipelineLayout layout, VkPipelineCache cache) {
    std::array<VkRayTracingShaderGroupCreateInfoKHR, groupCount> groups{};
    for (uint32_t i = 0; i < groupCount; ++i) {
        groups[i].sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
        groups[i].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
        groups[i].generalShader = i;
        groups[i].closestHitShader = groups[i].anyHitShader = groups[i].intersectionShader =
            VK_SHADER_UNUSED_KHR;
    }
    groups[hitGroup].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    groups[hitGroup].generalShader = VK_SHADER_UNUSED_KHR;
    groups[hitGroup].closestHitShader = 2;
    groups[hitGroup].anyHitShader = 3;
    VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
    info.stageCount = static_cast<uint32_t>(stages.size());
    info.pStages = stages.data();
    info.groupCount = groupCount;
    info.pGroups = groups.data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    LIMPID_VK(context.vk().CreateRayTracingPipelinesKHR(context.device(), VK_NULL_HANDLE, cache, 1, &info,
                                                        nullptr, &pipeline));
    return {context.vk(), pipeline};
}

ShaderTable makeShaderTable(const std::shared_ptr<const Context>& context, VkPipeline pipeline,
                            const std::string& name) {
    const RayTracingLimits& limits = context->rayTracing();
    const uint64_t handleSize = limits.handleSize;
    const uint64_t recordBytes = alignUp(handleSize, limits.handleAlignment);
    const uint64_t regionBytes = alignUp(recordBytes, limits.baseAlignment);
    std::vector<std::byte> handles(groupCount * handleSize);
    LIMPID_VK(context->vk().GetRayTracingShaderGroupHandlesKHR(context->device(), pipeline, 0, groupCount,
                                                               handles.size(), handles.data()));
    // The buffer's own address may have a smaller alignment than a region requires.
    const auto buffer = makeBuffer(context, name + " shader table", BufferUse::ShaderTable,
                                   groupCount * regionBytes + limits.baseAlignment);
    const VkDeviceAddress address = deviceAddress(*buffer);
    const VkDeviceAddress first = alignUp(address, limits.baseAlignment);
    std::array<VkStridedDeviceAddressRegionKHR, groupCount> regions{};
    for (uint32_t i = 0; i < groupCount; ++i) {
        regions[i] = {first + i * regionBytes, recordBytes, recordBytes};
        std::memcpy(buffer->memory.mapped + (regions[i].deviceAddress - address),
                    handles.data() + i * handleSize, handleSize);
    }
    return {buffer, regions[rayGenerationGroup], regions[missGroup], regions[hitGroup]};
}

}  // namespace limpid::gpu

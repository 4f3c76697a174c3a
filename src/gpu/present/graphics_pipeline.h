// Pipelines that draw triangles into one image.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "gpu/vulkan/context.h"

namespace limpid::gpu {

struct GraphicsPipeline {
    std::string name;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    std::span<const uint32_t> vertex, fragment;  ///< SPIR-V
    VkFormat target{};
    std::span<const VkVertexInputAttributeDescription> attributes = {};
    uint32_t vertexBytes = 0;  ///< of binding 0; 0: no vertices are read
    bool blends = false;       ///< over the existing content, by alpha; else it is replaced
};

/// Viewport and scissor are dynamic.
UniquePipeline makePipeline(const Context& context, const GraphicsPipeline& wanted);

/// One set with one descriptor in binding 0, which fragment shaders read, and push constants for both stages.
struct SmallLayout {
    UniqueSetLayout sets;
    UniquePipelineLayout pipelines;
    UniqueDescriptorPool pool;
    VkDescriptorSet set = VK_NULL_HANDLE;
};
SmallLayout makeSmallLayout(const Context& context, VkDescriptorType type, uint32_t pushBytes);

/// Begins to draw over the content of `target`, which is in that layout, with that pipeline and set.
void beginDrawing(const Context& context, VkCommandBuffer commands, VkImageView target, VkImageLayout layout,
                  Extent extent, VkPipeline pipeline, const SmallLayout& with);

constexpr VkShaderStageFlags drawingStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

}  // namespace limpid::gpu

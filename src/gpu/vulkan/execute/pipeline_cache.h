// Compute and ray-tracing pipelines, made at the first dispatch that needs them.
#pragma once

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/context.h"
#include "gpu/vulkan/execute/ray_pipeline.h"

namespace limpid::gpu {

class PipelineCache {
  public:
    explicit PipelineCache(std::shared_ptr<const Context> context) : context_(std::move(context)) {}

    struct Pipeline {
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const ShaderTable* table = nullptr;  ///< of ray-tracing pipelines
    };

    /// Throws Error naming the shader if it exceeds a limit of the device.
    Pipeline get(const RecordedDispatch& dispatch);

  private:
    struct Layouts {
        UniqueSetLayout set;
        UniquePipelineLayout pipeline;
        std::vector<UniqueShaderModule> modules;  ///< by stage
    };
    struct Made {
        UniquePipeline pipeline;
        std::optional<ShaderTable> table;
    };
    using Constants = std::vector<std::pair<uint32_t, uint32_t>>;

    const Layouts& layoutsOf(const std::shared_ptr<const Shader>& shader);
    Layouts makeLayouts(const Shader& shader) const;
    UniqueSetLayout makeSetLayout(const Shader& shader) const;
    UniquePipelineLayout makePipelineLayout(const Shader& shader, VkDescriptorSetLayout set) const;
    UniqueShaderModule makeModule(const Shader& shader, const Shader::Stage& stage) const;
    Made makePipeline(const RecordedDispatch& dispatch, const Layouts& layouts) const;
    UniquePipeline makeComputePipeline(const VkPipelineShaderStageCreateInfo& stage,
                                       VkPipelineLayout layout) const;

    std::shared_ptr<const Context> context_;
    // The shared pointers as keys keep the shaders alive, so that no other can take their address.
    std::map<std::shared_ptr<const Shader>, Layouts> layouts_;
    std::map<std::pair<std::shared_ptr<const Shader>, Constants>, Made> pipelines_;
};

/// The Vulkan name of a kind of binding, and of a stage.
VkDescriptorType descriptorType(BindingKind kind);
VkShaderStageFlagBits stageFlag(ShaderStage stage);

}  // namespace limpid::gpu

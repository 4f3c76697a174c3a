// Compute and ray-tracing pipelines of a device: shared by all graphs that run on it, and made by prepare(),
// or at the first dispatch that needs them.
#pragma once

#include <mutex>
#include <optional>
#include <set>

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/context.h"
#include "gpu/vulkan/execute/ray_pipeline.h"

namespace limpid::gpu {

class PipelineCache {
  public:
    explicit PipelineCache(std::shared_ptr<const Context> context);

    struct Pipeline {
        VkPipeline pipeline = VK_NULL_HANDLE;
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
        const ShaderTable* table = nullptr;  ///< of ray-tracing pipelines
    };

    /// Throws Error naming the shader if it exceeds a limit of the device. From any thread.
    Pipeline get(const RecordedDispatch& dispatch);
    /// Makes what is missing, on as many threads as the machine runs at once. From any thread.
    void prepare(std::span<const RecordedDispatch> dispatches);

    /// What the driver has compiled so far (VkPipelineCache), with a checksum.
    std::vector<std::byte> data() const;
    /// Starts the driver's cache from what data() once gave; damaged data are ignored. Throws Error if
    /// pipelines have been made.
    void load(std::span<const std::byte> data);
    size_t size() const;

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

    using Key = std::pair<uint64_t, Constants>;  ///< Shader::hash and the constants

    /// Must hold `mutex_`.
    const Layouts& layoutsOf(const Shader& shader);
    UniqueDriverCache makeDriverCache(std::span<const std::byte> data) const;
    Layouts makeLayouts(const Shader& shader) const;
    UniqueSetLayout makeSetLayout(const Shader& shader) const;
    UniquePipelineLayout makePipelineLayout(const Shader& shader, VkDescriptorSetLayout set) const;
    UniqueShaderModule makeModule(const Shader& shader, const Shader::Stage& stage) const;
    Made makePipeline(const RecordedDispatch& dispatch, const Layouts& layouts) const;
    UniquePipeline makeComputePipeline(const VkPipelineShaderStageCreateInfo& stage,
                                       VkPipelineLayout layout) const;

    std::shared_ptr<const Context> context_;
    UniqueDriverCache driverCache_;
    mutable std::mutex mutex_;             ///< of what follows; elements stay where they are
    std::map<uint64_t, Layouts> layouts_;  ///< by Shader::hash
    std::map<Key, Made> pipelines_;
};

/// The Vulkan name of a kind of binding, and of a stage.
VkDescriptorType descriptorType(BindingKind kind);
VkShaderStageFlagBits stageFlag(ShaderStage stage);

}  // namespace limpid::gpu

// The compute and ray-tracing pipelines of a device, shared by all its graphs. Created by prepare(), or at
// the first dispatch that needs them. Scenes and settings are constants of pipelines, so a program that runs
// for long would have ever more: new ones take the place of those that were not used for long.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <set>

#include "gpu/graph/frame_graph_impl.h"
#include "gpu/vulkan/context.h"
#include "gpu/vulkan/execute/ray_pipeline.h"

namespace limpid::gpu {

class PipelineCache {
  public:
    /// `specialise` and `mostPipelines`: of DeviceOptions.
    PipelineCache(std::shared_ptr<const Context> context, Specialise specialise, size_t mostPipelines);

    struct Made {
        UniquePipeline pipeline;
        std::optional<ShaderTable> table;  ///< for ray-tracing pipelines
    };
    struct Pipeline {
        std::shared_ptr<const Made> made;  ///< to be kept until the device has used it
        VkPipelineLayout layout = VK_NULL_HANDLE;
        VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;

        VkPipeline handle() const { return made->pipeline.get(); }
        const ShaderTable* table() const { return made->table ? &*made->table : nullptr; }
    };

    /// Throws Error naming the shader if it exceeds a limit of the device. Thread-safe.
    Pipeline get(const RecordedDispatch& dispatch);
    /// Creates missing pipelines, on as many threads as the machine has cores. Thread-safe.
    void prepare(std::span<const RecordedDispatch> dispatches);
    /// The same beside frames, without telling the listener.
    void prepareBeside(std::span<const RecordedDispatch> dispatches);
    /// Whether none is missing. Thread-safe.
    bool hasAll(std::span<const RecordedDispatch> dispatches) const;
    /// Device::onNewPipelines().
    void onNewPipelines(std::function<void()> listener) { listener_ = std::move(listener); }

    /// Returns what the driver has compiled so far (VkPipelineCache), with a checksum. Thread-safe.
    std::vector<std::byte> data() const;
    /// Initialises the driver's cache with earlier data(); damaged data is ignored. Throws Error if pipelines
    /// have been created.
    void load(std::span<const std::byte> data);
    /// The number of pipelines made so far.
    size_t made() const;
    /// The number of those that were not destroyed.
    size_t kept() const;

  private:
    struct Layouts {
        UniqueSetLayout set;
        UniquePipelineLayout pipeline;
        std::vector<UniqueShaderModule> modules;  ///< one per stage
    };
    using Key = std::pair<uint64_t, SpecialisationConstants>;  ///< Shader::hash and the constants
    struct Entry {
        std::shared_ptr<const Made> made;
        uint64_t lastUse = 0;  ///< the value of uses_ then
    };
    using Entries = std::map<Key, Entry>;

    struct Job {
        const RecordedDispatch* dispatch;
        const Layouts* layouts;
    };
    std::vector<Job> missing(std::span<const RecordedDispatch> dispatches);
    void makeAll(const std::vector<Job>& jobs);
    // `mutex_` must be held for these.
    const Layouts& layoutsOf(const Shader& shader);
    Entries::iterator keep(const Key& key, Made made);
    void makeRoom();
    UniqueDriverCache makeDriverCache(std::span<const std::byte> data) const;
    Layouts makeLayouts(const Shader& shader) const;
    UniqueSetLayout makeSetLayout(const Shader& shader) const;
    UniquePipelineLayout makePipelineLayout(const Shader& shader, VkDescriptorSetLayout set) const;
    UniqueShaderModule makeModule(const Shader& shader, std::span<const uint32_t> words) const;
    Made makePipeline(const RecordedDispatch& dispatch, const Layouts& layouts) const;
    UniquePipeline makeComputePipeline(const VkPipelineShaderStageCreateInfo& stage,
                                       VkPipelineLayout layout) const;

    std::shared_ptr<const Context> context_;
    Specialise specialise_;
    size_t mostPipelines_;
    bool dynamicParams_;  ///< of dynamic_params.h
    UniqueDriverCache driverCache_;
    std::function<void()> listener_;
    mutable std::mutex mutex_;             ///< protects the members below; layouts stay where they are
    std::map<uint64_t, Layouts> layouts_;  ///< key: Shader::hash
    Entries pipelines_;
    uint64_t uses_ = 0;  ///< calls of get()
    size_t made_ = 0;
};

/// The Vulkan value of a binding kind, and of a stage.
VkDescriptorType descriptorType(BindingKind kind);
VkShaderStageFlagBits stageFlag(ShaderStage stage);

}  // namespace limpid::gpu

#include "gpu/vulkan/execute/pipeline_cache.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <exception>
#include <thread>

#include "base/error.h"
#include "base/text/format.h"
#include "gpu/vulkan/check.h"
#include "gpu/vulkan/execute/dynamic_params.h"

namespace limpid::gpu {
namespace {

void checkLimit(const Context& context, const std::string& shader, std::string_view limit, uint64_t maximum,
                uint64_t asked) {
    if (asked <= maximum) return;
    throw Error(formatText("shader '{}' needs {} = {} but {} has {}", shader, limit, asked,
                           context.info().name, maximum));
}

void checkBindings(const Context& context, const Shader& shader) {
    const VkPhysicalDeviceLimits& limits = context.limits();
    uint32_t images = 0, sampled = 0, buffers = 0, blockSize = 0;
    for (const ShaderBinding& binding : shader.reflection.bindings) {
        // Vulkan counts storage texel buffers as storage images.
        if (binding.kind == BindingKind::StorageImage || binding.kind == BindingKind::StorageTexelBuffer)
            ++images;
        if (binding.kind == BindingKind::SampledImage) ++sampled;
        if (binding.kind == BindingKind::StorageBuffer) ++buffers;
        if (binding.kind == BindingKind::UniformBuffer) blockSize = binding.blockSize;
    }
    checkLimit(context, shader.name, "maxPerStageDescriptorStorageImages",
               limits.maxPerStageDescriptorStorageImages, images);
    checkLimit(context, shader.name, "maxPerStageDescriptorSampledImages",
               limits.maxPerStageDescriptorSampledImages, sampled);
    checkLimit(context, shader.name, "maxPerStageDescriptorStorageBuffers",
               limits.maxPerStageDescriptorStorageBuffers, buffers);
    checkLimit(context, shader.name, "maxPerStageResources", limits.maxPerStageResources,
               shader.reflection.bindings.size());
    checkLimit(context, shader.name, "maxUniformBufferRange", limits.maxUniformBufferRange, blockSize);
}

void checkWorkgroup(const Context& context, const RecordedDispatch& dispatch) {
    constexpr char axes[] = "xyz";
    const VkPhysicalDeviceLimits& limits = context.limits();
    uint64_t invocations = 1;
    for (size_t i = 0; i < 3; ++i) {
        invocations *= dispatch.workgroupSize[i];
        checkLimit(context, dispatch.shader->name, formatText("maxComputeWorkGroupSize.{}", axes[i]),
                   limits.maxComputeWorkGroupSize[i], dispatch.workgroupSize[i]);
    }
    checkLimit(context, dispatch.shader->name, "maxComputeWorkGroupInvocations",
               limits.maxComputeWorkGroupInvocations, invocations);
}

std::string pipelineName(const RecordedDispatch& dispatch) {
    std::string name = dispatch.shader->name;
    for (const auto& [id, value] : dispatch.constants) name += formatText(" [{}={}]", id, value);
    return name;
}

/// Calls `work` with 0 to count - 1 on several threads. After all calls have finished, rethrows an exception
/// if one was thrown.
void forEachOnThreads(size_t count, const std::function<void(size_t)>& work) {
    std::atomic<size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr fault;
    const auto run = [&] {
        for (size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!fault) fault = std::current_exception();
            }
        }
    };
    const size_t threads = std::min<size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
    {
        std::vector<std::jthread> others;
        for (size_t i = 1; i < threads; ++i) others.emplace_back(run);
        run();
    }
    if (fault) std::rethrow_exception(fault);
}

/// Callers of an adopted device may not have enabled the feature.
bool wantsDynamicParams(const Context& context) {
    const DeviceInfo& info = context.info();
    const std::pair<std::string, bool> feature("shaderUniformBufferArrayDynamicIndexing", true);
    return info.type == DeviceType::Cpu && context.submits() &&
           std::ranges::find(info.features, feature) != info.features.end();
}

/// Drivers only check the header of their cache data, so check the rest ourselves.
uint64_t checksum(std::span<const std::byte> data) {
    uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
    for (const std::byte byte : data) hash = (hash ^ static_cast<uint64_t>(byte)) * 0x100000001B3u;
    return hash;
}

}  // namespace

VkDescriptorType descriptorType(BindingKind kind) {
    switch (kind) {
        case BindingKind::StorageImage:
            return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        case BindingKind::SampledImage:
            return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        case BindingKind::StorageTexelBuffer:
            return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
        case BindingKind::StorageBuffer:
            return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        case BindingKind::UniformBuffer:
            return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        case BindingKind::AccelerationStructure:
            return VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
    }
    return VK_DESCRIPTOR_TYPE_MAX_ENUM;
}

VkShaderStageFlagBits stageFlag(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::Compute:
            return VK_SHADER_STAGE_COMPUTE_BIT;
        case ShaderStage::RayGeneration:
            return VK_SHADER_STAGE_RAYGEN_BIT_KHR;
        case ShaderStage::Miss:
            return VK_SHADER_STAGE_MISS_BIT_KHR;
        case ShaderStage::ClosestHit:
            return VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR;
        case ShaderStage::AnyHit:
            return VK_SHADER_STAGE_ANY_HIT_BIT_KHR;
    }
    return VK_SHADER_STAGE_ALL;
}

PipelineCache::PipelineCache(std::shared_ptr<const Context> context, Specialise specialise,
                             size_t mostPipelines)
    : context_(std::move(context)),
      specialise_(std::move(specialise)),
      mostPipelines_(mostPipelines),
      dynamicParams_(wantsDynamicParams(*context_)),
      driverCache_(makeDriverCache({})) {}

UniqueDriverCache PipelineCache::makeDriverCache(std::span<const std::byte> data) const {
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = data.size();
    info.pInitialData = data.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreatePipelineCache(context_->device(), &info, nullptr, &cache));
    UniqueDriverCache owned(context_->vk(), cache);
    context_->setName(cache, "limpid pipelines");
    return owned;
}

std::vector<std::byte> PipelineCache::data() const {
    const std::lock_guard lock(mutex_);
    const DeviceFunctions& vk = context_->vk();
    std::vector<std::byte> bytes;
    size_t size = 0;
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {  // other threads may make pipelines between the two calls
        LIMPID_VK(vk.GetPipelineCacheData(vk.device, driverCache_.get(), &size, nullptr));
        bytes.resize(sizeof(uint64_t) + size);
        result =
            vk.GetPipelineCacheData(vk.device, driverCache_.get(), &size, bytes.data() + sizeof(uint64_t));
    }
    LIMPID_VK(result);
    bytes.resize(sizeof(uint64_t) + size);
    const uint64_t sum = checksum(std::span(bytes).subspan(sizeof(sum)));
    std::memcpy(bytes.data(), &sum, sizeof(sum));
    return bytes;
}

void PipelineCache::load(std::span<const std::byte> data) {
    const std::lock_guard lock(mutex_);
    if (made_ > 0) throw Error("the pipeline cache cannot be loaded: pipelines have been made");
    uint64_t sum = 0;
    if (data.size() <= sizeof(sum)) return;
    std::memcpy(&sum, data.data(), sizeof(sum));
    const std::span<const std::byte> content = data.subspan(sizeof(sum));
    if (checksum(content) == sum) driverCache_ = makeDriverCache(content);
}

size_t PipelineCache::made() const {
    const std::lock_guard lock(mutex_);
    return made_;
}

size_t PipelineCache::kept() const {
    const std::lock_guard lock(mutex_);
    return pipelines_.size();
}

PipelineCache::Pipeline PipelineCache::get(const RecordedDispatch& dispatch) {
    const std::lock_guard lock(mutex_);
    const Layouts& layouts = layoutsOf(*dispatch.shader);
    const Key key{dispatch.shader->hash, dispatch.constants};
    auto found = pipelines_.find(key);
    if (found == pipelines_.end()) found = keep(key, makePipeline(dispatch, layouts));
    found->second.lastUse = ++uses_;
    return {found->second.made, layouts.pipeline.get(), layouts.set.get()};
}

PipelineCache::Entries::iterator PipelineCache::keep(const Key& key, Made made) {
    // Another thread may have made the same one.
    if (const auto found = pipelines_.find(key); found != pipelines_.end()) return found;
    makeRoom();
    ++made_;
    return pipelines_.emplace(key, Entry{std::make_shared<const Made>(std::move(made)), uses_}).first;
}

/// Destroys the oldest first. Few frames have more dispatches than `recent`, and those can make theirs again.
void PipelineCache::makeRoom() {
    constexpr uint64_t recent = 1024;
    const auto earlier = [](const auto& a, const auto& b) { return a.second.lastUse < b.second.lastUse; };
    while (pipelines_.size() >= std::max<size_t>(mostPipelines_, 1)) {
        const auto oldest = std::ranges::min_element(pipelines_, earlier);
        if (oldest->second.lastUse + recent > uses_) return;
        pipelines_.erase(oldest);
    }
}

void PipelineCache::prepare(std::span<const RecordedDispatch> dispatches) {
    const std::vector<Job> jobs = missing(dispatches);
    if (jobs.empty()) return;
    if (listener_) listener_();
    makeAll(jobs);
}

void PipelineCache::prepareBeside(std::span<const RecordedDispatch> dispatches) {
    makeAll(missing(dispatches));
}

bool PipelineCache::hasAll(std::span<const RecordedDispatch> dispatches) const {
    const std::lock_guard lock(mutex_);
    return std::ranges::all_of(dispatches, [&](const RecordedDispatch& dispatch) {
        return !dispatch.shader || pipelines_.contains(Key{dispatch.shader->hash, dispatch.constants});
    });
}

std::vector<PipelineCache::Job> PipelineCache::missing(std::span<const RecordedDispatch> dispatches) {
    std::vector<Job> jobs;
    const std::lock_guard lock(mutex_);
    std::set<Key> wanted;
    for (const RecordedDispatch& dispatch : dispatches) {
        if (!dispatch.shader) continue;
        const Key key{dispatch.shader->hash, dispatch.constants};
        if (const auto found = pipelines_.find(key); found != pipelines_.end()) {
            found->second.lastUse = uses_;  // the new ones must not take its place
            continue;
        }
        if (!wanted.insert(key).second) continue;
        jobs.push_back({&dispatch, &layoutsOf(*dispatch.shader)});
    }
    return jobs;
}

void PipelineCache::makeAll(const std::vector<Job>& jobs) {
    forEachOnThreads(jobs.size(), [&](size_t i) {
        const RecordedDispatch& dispatch = *jobs[i].dispatch;
        Made made = makePipeline(dispatch, *jobs[i].layouts);
        const std::lock_guard lock(mutex_);
        keep({dispatch.shader->hash, dispatch.constants}, std::move(made));
    });
}

const PipelineCache::Layouts& PipelineCache::layoutsOf(const Shader& shader) {
    auto found = layouts_.find(shader.hash);
    if (found == layouts_.end()) found = layouts_.emplace(shader.hash, makeLayouts(shader)).first;
    return found->second;
}

PipelineCache::Layouts PipelineCache::makeLayouts(const Shader& shader) const {
    checkBindings(*context_, shader);
    Layouts layouts;
    layouts.set = makeSetLayout(shader);
    layouts.pipeline = makePipelineLayout(shader, layouts.set.get());
    for (const Shader::Stage& stage : shader.stages)
        layouts.modules.push_back(makeModule(shader, stage.words));
    return layouts;
}

UniqueSetLayout PipelineCache::makeSetLayout(const Shader& shader) const {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    VkShaderStageFlags stages = 0;
    for (const Shader::Stage& stage : shader.stages) stages |= stageFlag(stage.reflection.stage);
    for (const ShaderBinding& binding : shader.reflection.bindings) {
        bindings.push_back({binding.binding, descriptorType(binding.kind), 1, stages, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    info.bindingCount = static_cast<uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateDescriptorSetLayout(context_->device(), &info, nullptr, &layout));
    UniqueSetLayout owned(context_->vk(), layout);
    context_->setName(layout, shader.name);
    return owned;
}

UniquePipelineLayout PipelineCache::makePipelineLayout(const Shader& shader,
                                                       VkDescriptorSetLayout set) const {
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &set;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreatePipelineLayout(context_->device(), &info, nullptr, &layout));
    UniquePipelineLayout owned(context_->vk(), layout);
    context_->setName(layout, shader.name);
    return owned;
}

UniqueShaderModule PipelineCache::makeModule(const Shader& shader, std::span<const uint32_t> words) const {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size() * sizeof(uint32_t);
    info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateShaderModule(context_->device(), &info, nullptr, &module));
    UniqueShaderModule owned(context_->vk(), module);
    context_->setName(module, shader.name);
    return owned;
}

UniquePipeline PipelineCache::makeComputePipeline(const VkPipelineShaderStageCreateInfo& stage,
                                                  VkPipelineLayout layout) const {
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    // Frames on CPUs can be cut into slices (time_slices.h).
    if (context_->info().type == DeviceType::Cpu) info.flags = VK_PIPELINE_CREATE_DISPATCH_BASE_BIT;
    info.stage = stage;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    LIMPID_VK(context_->vk().CreateComputePipelines(context_->device(), driverCache_.get(), 1, &info, nullptr,
                                                    &pipeline));
    return {context_->vk(), pipeline};
}

PipelineCache::Made PipelineCache::makePipeline(const RecordedDispatch& dispatch,
                                                const Layouts& layouts) const {
    const Shader& shader = *dispatch.shader;
    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (const auto& [id, value] : dispatch.constants) {
        entries.push_back({id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
        values.push_back(value);
    }
    VkSpecializationInfo specialisation{};
    specialisation.mapEntryCount = static_cast<uint32_t>(entries.size());
    specialisation.pMapEntries = entries.data();
    specialisation.dataSize = values.size() * sizeof(uint32_t);
    specialisation.pData = values.data();
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    std::vector<UniqueShaderModule> specialised;  // until the pipeline exists
    for (size_t i = 0; i < shader.stages.size(); ++i) {
        VkPipelineShaderStageCreateInfo& stage = stages.emplace_back();
        stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        stage.stage = stageFlag(shader.stages[i].reflection.stage);
        stage.module = layouts.modules[i].get();
        stage.pName = "main";
        stage.pSpecializationInfo = entries.empty() ? nullptr : &specialisation;
        // Not measured on GPUs, whose drivers store what they compiled.
        if (context_->info().type != DeviceType::Cpu) continue;
        std::vector<uint32_t> words;
        if (specialise_ && !entries.empty()) words = specialise_(shader.stages[i].words, dispatch.constants);
        if (!words.empty()) stage.pSpecializationInfo = nullptr;
        if (dynamicParams_) words = withDynamicParams(words.empty() ? shader.stages[i].words : words);
        if (words.empty()) continue;
        specialised.push_back(makeModule(shader, words));
        stage.module = specialised.back().get();
    }
    Made made;
    if (shader.tracesRays()) {
        made.pipeline = makeRayPipeline(*context_, stages, layouts.pipeline.get(), driverCache_.get());
        made.table.emplace(makeShaderTable(context_, made.pipeline.get(), shader.name));
    } else {
        checkWorkgroup(*context_, dispatch);
        made.pipeline = makeComputePipeline(stages.front(), layouts.pipeline.get());
    }
    context_->setName(made.pipeline.get(), pipelineName(dispatch));
    return made;
}

}  // namespace limpid::gpu

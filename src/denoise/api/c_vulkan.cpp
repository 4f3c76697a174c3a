// The C interface inside Vulkan programs (limpid/denoise_vulkan.h).
#include <algorithm>
#include <array>
#include <bit>

#include "denoise/api/c_device.h"
#include "denoise/api/c_guard.h"
#include "denoise/api/c_handles.h"
#include "denoise/stages/output/output.h"
#include "gpu/vulkan/adopted_device.h"
#include "limpid/denoise_vulkan.h"

using namespace limpid;
using namespace limpid::denoise;

namespace {

/// A feature flag that Limpid needs, and its position in the structs of a chain.
struct NeededFeature {
    const char* name;
    VkBool32* (*place)(VkBaseOutStructure* link);
};

const NeededFeature needed[] = {
    {"synchronization2",
     [](VkBaseOutStructure* link) -> VkBool32* {
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceVulkan13Features*>(link)->synchronization2;
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SYNCHRONIZATION_2_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceSynchronization2Features*>(link)->synchronization2;
         return nullptr;
     }},
    {"maintenance4",
     [](VkBaseOutStructure* link) -> VkBool32* {
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceVulkan13Features*>(link)->maintenance4;
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceMaintenance4Features*>(link)->maintenance4;
         return nullptr;
     }},
    {"scalarBlockLayout",
     [](VkBaseOutStructure* link) -> VkBool32* {
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(link)->scalarBlockLayout;
         if (link->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SCALAR_BLOCK_LAYOUT_FEATURES)
             return &reinterpret_cast<VkPhysicalDeviceScalarBlockLayoutFeatures*>(link)->scalarBlockLayout;
         return nullptr;
     }},
};

VkBool32* findPlace(VkPhysicalDeviceFeatures2* features, const NeededFeature& feature) {
    for (auto* link = reinterpret_cast<VkBaseOutStructure*>(features); link; link = link->pNext)
        if (VkBool32* const place = feature.place(link)) return place;
    throw UsageError(formatText("the chain has no struct with the feature {}", feature.name));
}

gpu::MemoryHooks hooksOf(const limpid_vulkan_device_desc& desc) {
    if (!desc.allocate && !desc.free) return {};
    if (!desc.allocate || !desc.free) throw UsageError("set both `allocate` and `free`, or neither");
    using Block = gpu::MemoryHooks::Block;
    gpu::MemoryHooks hooks;
    hooks.allocate = [allocate = desc.allocate, user = desc.memory_user](
                         const VkMemoryRequirements& requirements, VkMemoryPropertyFlags properties,
                         const char* name, Block& block) {
        limpid_vulkan_memory given{};
        const VkResult result = allocate(user, &requirements, properties, name, &given);
        block = {given.memory, given.offset, given.mapped, given.handle};
        return result;
    };
    hooks.free = [free = desc.free, user = desc.memory_user](const Block& block) {
        const limpid_vulkan_memory given{block.memory, block.offset, block.mapped, block.handle};
        free(user, &given);
    };
    return hooks;
}

/// The aspects that a barrier of such an image must name.
VkImageAspectFlags aspectsOf(VkFormat format, VkImageLayout layout) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        case VK_FORMAT_S8_UINT:
            return VK_IMAGE_ASPECT_STENCIL_BIT;
        case VK_FORMAT_D16_UNORM_S8_UINT:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            // Layouts of one aspect are only allowed for that one; other layouts are those of both.
            if (layout == VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL ||
                layout == VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL)
                return VK_IMAGE_ASPECT_DEPTH_BIT;
            if (layout == VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL ||
                layout == VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL)
                return VK_IMAGE_ASPECT_STENCIL_BIT;
            return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

gpu::ForeignImage foreign(const limpid_vulkan_image& image, const char* name) {
    if (image.view == VK_NULL_HANDLE) throw UsageError(formatText("the image '{}' has no view", name));
    return {.image = reinterpret_cast<uint64_t>(image.image),
            .view = reinterpret_cast<uint64_t>(image.view),
            .aspects = aspectsOf(image.format, image.layout),
            .layoutBefore = image.layout,
            .layoutAfter = image.layout_after,
            .stagesBefore = image.stages_before,
            .accessBefore = image.access_before,
            .stagesAfter = image.stages_after,
            .accessAfter = image.access_after};
}

bool isUnsigned(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UINT:
        case VK_FORMAT_R8G8_UINT:
        case VK_FORMAT_R8G8B8_UINT:
        case VK_FORMAT_B8G8R8_UINT:
        case VK_FORMAT_R8G8B8A8_UINT:
        case VK_FORMAT_B8G8R8A8_UINT:
        case VK_FORMAT_A8B8G8R8_UINT_PACK32:
        case VK_FORMAT_A2R10G10B10_UINT_PACK32:
        case VK_FORMAT_A2B10G10R10_UINT_PACK32:
        case VK_FORMAT_R16_UINT:
        case VK_FORMAT_R16G16_UINT:
        case VK_FORMAT_R16G16B16_UINT:
        case VK_FORMAT_R16G16B16A16_UINT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32B32_UINT:
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_S8_UINT:
            return true;
        default:
            return false;
    }
}

/// Vulkan numbers a format of signed integers directly after that of unsigned ones. S8_UINT has no such
/// format.
bool isSigned(VkFormat format) {
    const auto before = static_cast<VkFormat>(format - 1);
    return before != VK_FORMAT_S8_UINT && isUnsigned(before);
}

bool hasStencilBesideDepth(VkFormat format) {
    return format == VK_FORMAT_D16_UNORM_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT ||
           format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

/// Shaders read unsigned integers of ids, and floats of all else.
void checkFormat(size_t input, VkFormat format) {
    if (format == VK_FORMAT_UNDEFINED)
        throw UsageError(formatText("the format of the input '{}' is not set", inputName(input)));
    const bool isId = input == LIMPID_INPUT_ID;
    if (hasStencilBesideDepth(format) || (isUnsigned(format) == isId && !isSigned(format))) return;
    throw UsageError(formatText("the input '{}' is of VkFormat {}: it must hold {}", inputName(input),
                                static_cast<int>(format),
                                isId ? "unsigned integers" : "floats or normalised numbers"));
}

IngestImages importInputs(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                          const limpid_vulkan_frame& frame) {
    IngestImages images;
    for (size_t input = 0; input < LIMPID_INPUT_MAX; ++input) {
        if (frame.inputs[input].image == VK_NULL_HANDLE) continue;
        gpu::ImageHandle& handle = imageOf(images, input);
        checkFormat(input, frame.inputs[input].format);
        gpu::ForeignImage image = foreign(frame.inputs[input], inputName(input));
        if (image.layoutBefore == VK_IMAGE_LAYOUT_UNDEFINED)
            image.layoutBefore = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        const bool isId = input == LIMPID_INPUT_ID;
        handle = graph.import(std::string("input/") + inputName(input),
                              isId ? gpu::Format::RGBA32Uint : gpu::Format::RGBA32Float,
                              {desc.width, desc.height}, image);
    }
    requireInputs(desc, images);
    return images;
}

gpu::Format outputFormat(VkFormat format, const char* name) {
    if (format == VK_FORMAT_R16G16B16A16_SFLOAT) return gpu::Format::RGBA16Float;
    if (format == VK_FORMAT_R32G32B32A32_SFLOAT) return gpu::Format::RGBA32Float;
    throw UsageError(
        formatText("the output '{}' is of VkFormat {}: it must be VK_FORMAT_R16G16B16A16_SFLOAT or "
                   "VK_FORMAT_R32G32B32A32_SFLOAT",
                   name, static_cast<int>(format)));
}

/// Throws UsageError if output `i` has the image of an earlier one, since the outputs are written all at
/// once, or of an input, which passes sample in another layout and may read again after the output is
/// written.
void checkDistinct(const limpid_vulkan_frame& frame, size_t i) {
    for (size_t input = 0; input < LIMPID_INPUT_MAX; ++input)
        if (frame.inputs[input].image == frame.outputs[i].image)
            throw UsageError(formatText("the input '{}' and the output '{}' have the same image",
                                        inputName(input), outputNames[i]));
    for (size_t other = 0; other < i; ++other)
        if (frame.outputs[other].image == frame.outputs[i].image)
            throw UsageError(formatText("the outputs '{}' and '{}' have the same image", outputNames[other],
                                        outputNames[i]));
}

using Targets = std::array<gpu::ImageHandle, 3>;

/// The caller's images for the outputs, empty if they are not wanted; with `forReal` false, images that stand
/// for them.
Targets importOutputs(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc,
                      const limpid_vulkan_frame& frame, bool forReal) {
    Targets targets;
    for (size_t i = 0; i < LIMPID_OUTPUT_MAX; ++i) {
        const limpid_vulkan_image& image = frame.outputs[i];
        if (image.image == VK_NULL_HANDLE) continue;
        if (i >= targets.size()) throw UsageError("the method has no output of this number");
        checkDistinct(frame, i);
        const gpu::Format format = outputFormat(image.format, outputNames[i]);
        const gpu::Extent extent{desc.width, desc.height};
        gpu::ForeignImage target = foreign(image, outputNames[i]);
        if (target.layoutAfter == VK_IMAGE_LAYOUT_UNDEFINED) target.layoutAfter = VK_IMAGE_LAYOUT_GENERAL;
        const std::string name = std::string("output/") + outputNames[i];
        targets[i] =
            forReal ? graph.import(name, format, extent, target) : graph.transient(name, format, extent);
    }
    return targets;
}

/// Copies the outputs that the method has not written to the caller's images itself.
void recordOutputs(gpu::FrameGraph& graph, const InstanceOutputs& made, const Targets& targets) {
    const std::array<gpu::ImageHandle, 3> pictures{made.color, made.radiance, made.specular};
    for (size_t i = 0; i < targets.size(); ++i) {
        if (!targets[i] || targets[i] == pictures[i]) continue;
        if (!pictures[i]) throw UsageError(formatText("the method has no output {}", outputNames[i]));
        output(graph, outputNames[i], pictures[i], targets[i]);
    }
}

bool wantsSignals(const limpid_vulkan_frame& frame) {
    return frame.outputs[LIMPID_OUTPUT_RADIANCE].image != VK_NULL_HANDLE ||
           frame.outputs[LIMPID_OUTPUT_SPECULAR].image != VK_NULL_HANDLE;
}

std::vector<limpid_input> missingInputs(const limpid_vulkan_frame& frame) {
    std::vector<limpid_input> missing;
    for (int input = 0; input < LIMPID_INPUT_MAX; ++input)
        if (frame.inputs[input].image == VK_NULL_HANDLE) missing.push_back(static_cast<limpid_input>(input));
    return missing;
}

/// What a warm-up has of a side of the picture. lavapipe compiles a shader anew for images whose sides are
/// powers of two where before they were not.
uint32_t fewPixels(uint32_t size) {
    return std::min(size, std::has_single_bit(size) ? 16u : 15u);
}

limpid_denoiser& forRecording(limpid_denoiser* denoiser, VkCommandBuffer commands) {
    if (!commands) throw UsageError("commands is NULL");
    limpid_denoiser& d = required(denoiser, "denoiser");
    if (!d.adopted) throw UsageError("the device is Limpid's own: use limpid_denoise_host()");
    return d;
}

}  // namespace

extern "C" {

limpid_result limpid_vulkan_enable_features(VkPhysicalDeviceFeatures2* features) {
    return guarded([&] {
        required(features, "features");
        std::vector<VkBool32*> places;
        for (const NeededFeature& feature : needed) places.push_back(findPlace(features, feature));
        for (VkBool32* const place : places) *place = VK_TRUE;
        features->features.shaderStorageImageExtendedFormats = VK_TRUE;
    });
}

limpid_result limpid_device_adopt(const limpid_vulkan_device_desc* desc, limpid_device** device) {
    return guarded([&] {
        required(device, "device") = nullptr;
        const limpid_vulkan_device_desc d = wholeStruct(desc, "limpid_vulkan_device_desc");
        if (!d.instance || !d.physical_device || !d.device || !d.get_instance_proc_addr)
            throw UsageError("instance, physical_device, device and get_instance_proc_addr must be set");
        gpu::AdoptedDevice adopted;
        adopted.getInstanceProcAddr = d.get_instance_proc_addr;
        adopted.instance = d.instance;
        adopted.physicalDevice = d.physical_device;
        adopted.device = d.device;
        adopted.queueFamily = d.queue_family;
        adopted.debugUtils = d.debug_utils != 0;
        adopted.memory = hooksOf(d);
        adopted.messages = callbackOf(d.message, d.message_user);
        *device = new limpid_device{std::make_shared<gpu::Device>(adopted), true};
    });
}

limpid_result limpid_record(limpid_denoiser* denoiser, VkCommandBuffer commands,
                            const limpid_vulkan_frame* given) {
    return guarded([&] {
        limpid_denoiser& d = forRecording(denoiser, commands);
        const limpid_vulkan_frame frame = wholeStruct(given, "limpid_vulkan_frame");
        const bool hasPrevious = !d.startsAnew(frame.reset != 0);
        const IngestParams params = ingestParams(d.desc, frame.camera, hasPrevious);
        d.graph.beginFrame();
        const IngestImages images = importInputs(d.graph, d.desc, frame);
        const Targets targets = importOutputs(d.graph, d.desc, frame, true);
        recordOutputs(d.graph,
                      recordFrame(d.graph, d.desc, d.settings, images, params, gpu::filterChoice(*d.device),
                                  wantsSignals(frame), targets[LIMPID_OUTPUT_COLOR]),
                      targets);
        d.graph.record(*d.device, commands);
        d.finish();
    });
}

limpid_result limpid_warm_up(limpid_denoiser* denoiser, VkCommandBuffer commands,
                             const limpid_vulkan_frame* given) {
    return guarded([&] {
        limpid_denoiser& d = forRecording(denoiser, commands);
        const limpid_vulkan_frame frame = wholeStruct(given, "limpid_vulkan_frame");
        limpid_denoiser_desc few = d.desc;
        few.width = fewPixels(few.width);
        few.height = fewPixels(few.height);
        auto graph = std::make_unique<gpu::FrameGraph>(
            gpu::GraphOptions{.framesInFlight = 1, .prefix = "limpid/warm up/", .timestamps = false});
        graph->beginFrame();
        // Without a previous frame, whose matrices may not be set yet.
        const IngestParams params = ingestParams(few, frame.camera, false);
        const IngestImages images = importInputs(*graph, few, frame);
        const Targets targets = importOutputs(*graph, few, frame, false);
        recordOutputs(*graph,
                      recordFrame(*graph, few, d.settings, images, params, gpu::filterChoice(*d.device),
                                  wantsSignals(frame), targets[LIMPID_OUTPUT_COLOR]),
                      targets);
        graph->record(*d.device, commands);
        d.warmUps.push_back(std::move(graph));
        // Memory is given when it is first written, which takes a CPU longer than a frame.
        recordDryFrame(d.graph, d.desc, d.settings, gpu::filterChoice(*d.device),
                       {.without = missingInputs(frame), .orthographic = params.camera.orthographic != 0},
                       wantsSignals(frame));
        d.graph.clearImages(*d.device, commands);
    });
}

}  // extern "C"

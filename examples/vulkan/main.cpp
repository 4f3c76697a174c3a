// Limpid in a Vulkan program. Traces a moving scene with one path per pixel, denoises each frame with SVGF in the same
// command buffer, changes the picture's size half-way, and writes the last frame to noisy.ppm and clean.ppm.
//     limpid-vulkan [--validate] [--two]      --two: adds a second denoiser, which writes clean2.ppm
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limpid/denoise_vulkan.hpp>
#include <stdexcept>
#include <string>
#include <vector>
#include <vulkan/vulkan_raii.hpp>
using namespace vk;
using Stage = PipelineStageFlagBits2;
using Access = AccessFlagBits2;
constexpr uint32_t traceCode[] =
#include "trace.comp.inc"
    ;
constexpr uint32_t frameCount = 32, framesInFlight = 3;
constexpr Format half4 = Format::eR16G16B16A16Sfloat;
// The tracer's outputs, which are the denoiser's inputs, in formats common in engines. Same order as in trace.comp.
constexpr std::pair<limpid_input, Format> layers[] = {{LIMPID_INPUT_RADIANCE, half4},
                                                      {LIMPID_INPUT_ALBEDO, Format::eR8G8B8A8Unorm},
                                                      {LIMPID_INPUT_NORMAL, Format::eA2B10G10R10UnormPack32},
                                                      {LIMPID_INPUT_DEPTH, Format::eR32Sfloat},
                                                      {LIMPID_INPUT_MOTION, Format::eR16G16Sfloat}};
constexpr auto compute = ShaderStageFlagBits::eCompute;
constexpr DescriptorSetLayoutBinding layerBinding(0, DescriptorType::eStorageImage, std::size(layers), compute);
constexpr PushConstantRange frameNumber(compute, 0, sizeof(uint32_t));
constexpr ImageSubresourceRange wholeImage(ImageAspectFlagBits::eColor, 0, 1, 0, 1);
struct Gpu {
    raii::PhysicalDevice physical;
    raii::Device device;
    raii::Queue queue{device, 0, 0};  // queue family 0 supports compute on all drivers that we know
    raii::CommandPool pool{device, {CommandPoolCreateFlagBits::eResetCommandBuffer, 0}};
    raii::DeviceMemory allocate(const MemoryRequirements& needs, MemoryPropertyFlags wanted) const {
        const auto types = physical.getMemoryProperties().memoryTypes;
        uint32_t type = 0;
        while (!(needs.memoryTypeBits >> type & 1) || (types.at(type).propertyFlags & wanted) != wanted) ++type;
        return {device, MemoryAllocateInfo(needs.size, type)};
    }
};

struct Picture {
    using Usage = ImageUsageFlagBits;
    Picture(const Gpu& gpu, Format form, Extent2D size)
        : extent(size, 1),
          format(form),
          image(gpu.device, ImageCreateInfo({}, ImageType::e2D, form, extent, 1, 1, SampleCountFlagBits::e1, {},
                                            Usage::eStorage | Usage::eSampled | Usage::eTransferSrc)),
          memory(gpu.allocate(image.getMemoryRequirements(), MemoryPropertyFlagBits::eDeviceLocal)) {
        image.bindMemory(*memory, 0);
        view = {gpu.device, {{}, *image, ImageViewType::e2D, format, {}, wholeImage}};
    }
    Extent3D extent;
    Format format;
    raii::Image image;
    raii::DeviceMemory memory;
    raii::ImageView view = nullptr;
};

// Describes a picture to Limpid: its layout, and the stage and access that wrote it last.
limpid_vulkan_image forLimpid(const Picture& picture, VkImageLayout layout) {
    return limpid::image(*picture.image, *picture.view, VkFormat(picture.format), layout,
                         VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
}

void trace(const raii::CommandBuffer& commands, const std::vector<Picture>& pictures, const raii::Pipeline& tracer,
           const raii::PipelineLayout& layout, uint32_t frame) {
    std::vector<ImageMemoryBarrier2> barriers;
    std::vector<DescriptorImageInfo> views;
    for (const Picture& picture : pictures) {  // the denoisers of the previous frame may still read it
        barriers.emplace_back(Stage::eComputeShader, Access::eNone, Stage::eComputeShader, Access::eShaderStorageWrite,
                              ImageLayout::eUndefined, ImageLayout::eGeneral, 0, 0, *picture.image, wholeImage);
        views.emplace_back(Sampler(), *picture.view, ImageLayout::eGeneral);
    }
    const WriteDescriptorSet all({}, 0, 0, DescriptorType::eStorageImage, views);
    commands.pipelineBarrier2(DependencyInfo({}, {}, {}, barriers));
    commands.bindPipeline(PipelineBindPoint::eCompute, *tracer);
    commands.pushDescriptorSetKHR(PipelineBindPoint::eCompute, *layout, 0, all);
    commands.pushConstants<uint32_t>(*layout, compute, 0, frame);
    commands.dispatch((pictures[0].extent.width + 7) / 8, (pictures[0].extent.height + 7) / 8, 1);
}

// The camera of trace.comp: it looks along -z and moves sideways. Matrices are column-major.
void look(float time, Extent2D size, float (&view)[16], float (&projection)[16]) {
    view[0] = view[5] = view[10] = view[15] = 1.0f;
    view[12] = -0.8f * std::sin(time), view[13] = -1.2f, view[14] = -5.0f;
    projection[0] = 2.0f * size.height / size.width, projection[5] = -2.0f;  // Vulkan's clip space: y points down
    projection[10] = projection[11] = -1.0f, projection[14] = -0.1f;         // near plane 0.1, no far plane
}

// Writes a picture as an 8-bit PPM file.
void save(const Gpu& gpu, const Picture& picture, const char* name) {
    const auto [width, height, depth] = picture.extent;
    const DeviceSize size = DeviceSize{8} * width * height;
    const raii::Buffer buffer(gpu.device, {{}, size, BufferUsageFlagBits::eTransferDst});
    using Memory = MemoryPropertyFlagBits;
    const auto memory = gpu.allocate(buffer.getMemoryRequirements(), Memory::eHostVisible | Memory::eHostCoherent);
    buffer.bindMemory(*memory, 0);
    const auto commands = std::move(raii::CommandBuffers(gpu.device, {*gpu.pool, {}, 1}).front());
    const MemoryBarrier2 before(Stage::eAllCommands, Access::eMemoryWrite, Stage::eCopy, Access::eTransferRead);
    const MemoryBarrier2 after(Stage::eCopy, Access::eTransferWrite, Stage::eHost, Access::eHostRead);
    commands.begin(CommandBufferBeginInfo());
    commands.pipelineBarrier2(DependencyInfo({}, before));
    commands.copyImageToBuffer(*picture.image, ImageLayout::eGeneral, *buffer,
                               BufferImageCopy(0, 0, 0, {ImageAspectFlagBits::eColor, 0, 0, 1}, {}, picture.extent));
    commands.pipelineBarrier2(DependencyInfo({}, after));
    commands.end();
    gpu.queue.submit(SubmitInfo({}, {}, *commands));
    gpu.queue.waitIdle();
    const auto* light = static_cast<const _Float16*>(memory.mapMemory(0, size));
    std::ofstream file(name, std::ios::binary);
    file << "P6 " << width << ' ' << height << " 255\n";
    for (size_t i = 0; i < size / 2; ++i)
        if (i % 4 != 3) file.put(char(std::lround(255.0f * std::pow(std::min(float(light[i]), 1.0f), 1 / 2.2f))));
    if (!file.flush()) throw std::runtime_error(std::string("cannot write ") + name);
}

constexpr auto onMessage = [](auto, auto, const VkDebugUtilsMessengerCallbackDataEXT* data, void* count) -> VkBool32 {
    std::cerr << data->pMessage << '\n';
    ++*static_cast<int*>(count);
    return VK_FALSE;
};
int main(int argc, char** argv) try {
    bool validate = false, two = false;
    for (int i = 1; i < argc; ++i) (argv[i] == std::string("--two") ? two : validate) = true;
    // The program's own Vulkan device. limpid::enableFeatures() adds the features that Limpid needs.
    const raii::Context context;
    const ApplicationInfo app("limpid-vulkan", 1, nullptr, 0, VK_API_VERSION_1_3);
    const std::vector<const char*> layer(validate, "VK_LAYER_KHRONOS_validation");
    const std::vector<const char*> extension(validate, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    const raii::Instance instance(context, InstanceCreateInfo({}, &app, layer, extension));
    int messages = 0;
    using Severity = DebugUtilsMessageSeverityFlagBitsEXT;
    DebugUtilsMessengerCreateInfoEXT messenger({}, Severity::eWarning | Severity::eError, {}, onMessage, &messages);
    messenger.messageType = DebugUtilsMessageTypeFlagBitsEXT::eValidation;
    const auto counter = validate ? raii::DebugUtilsMessengerEXT(instance, messenger) : nullptr;
    const raii::PhysicalDevice physical = std::move(raii::PhysicalDevices(instance).front());
    const float priority = 1.0f;
    const DeviceQueueCreateInfo queues({}, 0, 1, &priority);
    const char* const push = VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME;
    StructureChain<PhysicalDeviceFeatures2, PhysicalDeviceVulkan12Features, PhysicalDeviceVulkan13Features> features;
    features.get().features.shaderStorageImageWriteWithoutFormat = true;
    limpid::enableFeatures(features.get());
    const Gpu gpu{physical, {physical, {{}, queues, {}, push, nullptr, &features.get()}}};
    const auto pushed = DescriptorSetLayoutCreateFlagBits::ePushDescriptorKHR;
    const raii::DescriptorSetLayout images(gpu.device, {pushed, layerBinding});
    const raii::PipelineLayout layout(gpu.device, {{}, *images, frameNumber});
    const raii::ShaderModule code(gpu.device, {{}, sizeof traceCode, traceCode});
    const ComputePipelineCreateInfo pipeline({}, {{}, compute, *code, "main"}, *layout);
    const raii::Pipeline tracer(gpu.device, nullptr, pipeline);

    // Limpid uses this device.
    const auto limpidDevice = limpid::adopt(*instance, *physical, *gpu.device, 0, vkGetInstanceProcAddr);
    limpid::DenoiserDesc desc(640, 360, LIMPID_METHOD_SVGF);
    desc.normal_encoding = LIMPID_NORMAL_UNORM;
    desc.frames_in_flight = framesInFlight;
    std::vector<limpid::Denoiser> denoisers;
    denoisers.emplace_back(limpidDevice, desc);
    desc.method = LIMPID_METHOD_ATROUS;
    if (two) denoisers.emplace_back(limpidDevice, desc);
    std::vector<Picture> traced, clean;  // indexed by layer; by denoiser
    const raii::CommandBuffers buffers(gpu.device, {*gpu.pool, {}, framesInFlight});
    std::vector<raii::Fence> fences;
    for (uint32_t number = 0; number < frameCount; ++number) {
        if (number < framesInFlight) fences.emplace_back(gpu.device, FenceCreateInfo(FenceCreateFlagBits::eSignaled));
        // The frame three frames ago must be done: its command buffer and Limpid's resources for it are reused.
        const raii::CommandBuffer& commands = buffers[number % framesInFlight];
        const Fence fence = *fences[number % framesInFlight];
        if (gpu.device.waitForFences(fence, true, UINT64_MAX) != Result::eSuccess) return 1;
        gpu.device.resetFences(fence);
        const Extent2D size = number < frameCount / 2 ? Extent2D(640, 360) : Extent2D(500, 300);
        if (number % (frameCount / 2) == 0) {  // a new size: nothing may be in flight
            gpu.device.waitIdle();
            for (limpid::Denoiser& denoiser : denoisers) denoiser.resize(size.width, size.height);
            traced.clear(), clean.clear();
            for (const auto& [input, format] : layers) traced.emplace_back(gpu, format, size);
            while (clean.size() < denoisers.size()) clean.emplace_back(gpu, half4, size);
        }
        commands.begin(CommandBufferBeginInfo(CommandBufferUsageFlagBits::eOneTimeSubmit));
        trace(commands, traced, tracer, layout, number);
        limpid::VulkanFrame frame;
        for (size_t i = 0; i < traced.size(); ++i)
            frame.inputs[layers[i].first] = forLimpid(traced[i], VK_IMAGE_LAYOUT_GENERAL);
        look(number / 30.0f, size, frame.camera.view, frame.camera.projection);
        look((number - 1.0f) / 30.0f, size, frame.camera.previous_view, frame.camera.previous_projection);
        for (size_t i = 0; i < denoisers.size(); ++i) {
            frame.outputs[LIMPID_OUTPUT_COLOR] = forLimpid(clean[i], VK_IMAGE_LAYOUT_UNDEFINED);
            limpid::record(denoisers[i], *commands, frame);
        }
        commands.end();
        gpu.queue.submit(SubmitInfo({}, {}, *commands), fence);
    }
    gpu.device.waitIdle();
    save(gpu, traced.front(), "noisy.ppm");
    save(gpu, clean.front(), "clean.ppm");
    if (two) save(gpu, clean.back(), "clean2.ppm");
    return messages == 0 ? 0 : 1;
} catch (const std::exception& error) {  // limpid::Error or an exception of Vulkan-Hpp
    std::cerr << error.what() << '\n';
    return 1;
}

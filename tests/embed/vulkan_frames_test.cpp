// Tests the C interface in a Vulkan program (vulkan_program.h).
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/embed/vulkan_program.h"

namespace limpid::test {
namespace {

using testing::HasSubstr;

using VulkanFramesTest = VulkanProgramTest;

const SyntheticOptions movingObject{.objectMoves = true};

TEST_F(VulkanFramesTest, CleansFrames) {
    const SyntheticScene scene(movingObject);
    const std::vector<float> clean = denoiseSequence(create(), scene, 6);
    const std::vector<float> truth = scene.truth(5, width, height);
    const HostFrame noisy = scene.frame(5, width, height, 1);
    double before = 0, after = 0;
    for (size_t i = 0; i < clean.size(); ++i) {
        if (i % 4 == 3) continue;
        const double n = noisy.diffuse[i] + noisy.specular[i] + noisy.emission[i];
        before += (n - truth[i]) * (n - truth[i]);
        after += (clean[i] - truth[i]) * (clean[i] - truth[i]);
    }
    EXPECT_LT(after, 0.2 * before);
}

TEST_F(VulkanFramesTest, TwoDenoisersShareACommandBuffer) {
    const SyntheticScene first(movingObject), second({});
    const std::vector<float> alone = denoiseSequence(create(), first, 3),
                             alone2 = denoiseSequence(create(), second, 3);
    limpid_denoiser_desc named = {};
    named.name = "second/";
    limpid_denoiser *a = create(), *b = create(named);
    std::vector<float> together, together2;
    for (int number = 0; number < 3; ++number) {
        const auto f = upload(first, number), g = upload(second, number);
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_record(a, commands, &f->frame), LIMPID_OK) << limpid_last_error();
            EXPECT_EQ(limpid_record(b, commands, &g->frame), LIMPID_OK) << limpid_last_error();
        });
        together = pixels(*f);
        together2 = pixels(*g);
    }
    EXPECT_EQ(alone, together);
    EXPECT_EQ(alone2, together2);
}

/// Records several frames into one submission: a frame must not overwrite what an earlier one still uses.
TEST_F(VulkanFramesTest, ThreeFramesAreInFlight) {
    const SyntheticScene scene(movingObject);
    const std::vector<float> oneByOne = denoiseSequence(create(), scene, 6);
    limpid_denoiser_desc desc = {};
    desc.frames_in_flight = 3;
    limpid_denoiser* denoiser = create(desc);
    std::vector<float> last;
    for (int number = 0; number < 6; number += 3) {
        std::vector<std::unique_ptr<ProgramFrame>> frames;
        for (int i = 0; i < 3; ++i) frames.push_back(upload(scene, number + i));
        run([&](VkCommandBuffer commands) {
            for (const auto& f : frames)
                EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
        });
        last = pixels(*frames.back());
    }
    EXPECT_EQ(oneByOne, last);
}

TEST_F(VulkanFramesTest, MakesAllPipelinesBeforehand) {
    for (const limpid_method method :
         {LIMPID_METHOD_SVGF, LIMPID_METHOD_ATROUS, LIMPID_METHOD_TEMPORAL, LIMPID_METHOD_NANO}) {
        limpid_denoiser_desc desc = {};
        desc.method = method;
        limpid_denoiser* denoiser = create(desc);
        const size_t made = adopted_->device->pipelineCount();
        for (const gpu::Format format : {gpu::Format::RGBA32Float, gpu::Format::RGBA16Float}) {
            colorFormat_ = format;
            for (const bool orthographic : {false, true})
                denoiseSequence(denoiser, SyntheticScene({.orthographic = orthographic}), 2);
        }
        EXPECT_EQ(adopted_->device->pipelineCount(), made);
    }
}

/// The same with one signal, and the inputs that most programs have.
TEST_F(VulkanFramesTest, MakesThePipelinesOfFewInputsBeforehand) {
    for (const limpid_method method :
         {LIMPID_METHOD_SVGF, LIMPID_METHOD_ATROUS, LIMPID_METHOD_TEMPORAL, LIMPID_METHOD_BILATERAL,
          LIMPID_METHOD_VISIBILITY, LIMPID_METHOD_NANO}) {
        limpid_denoiser_desc desc = {};
        desc.method = method;
        desc.signals = 1;
        limpid_denoiser* denoiser = create(desc);
        const size_t made = adopted_->device->pipelineCount();
        const auto f = upload(SyntheticScene({}), 0);
        for (const limpid_input missing :
             {LIMPID_INPUT_SPECULAR, LIMPID_INPUT_EMISSION, LIMPID_INPUT_ALBEDO_SPECULAR,
              LIMPID_INPUT_PREVIOUS_NORMAL, LIMPID_INPUT_ID})
            f->frame.inputs[missing] = {};
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
        });
        EXPECT_EQ(adopted_->device->pipelineCount(), made) << method;
    }
}

/// The previous matrices are only read when there is a history.
TEST_F(VulkanFramesTest, NeedsPreviousMatricesOnlyForHistories) {
    const auto f = upload(SyntheticScene({}), 0);
    std::ranges::fill(f->frame.camera.previous_view, 0.0f);
    std::ranges::fill(f->frame.camera.previous_projection, 0.0f);
    for (const limpid_method method : {LIMPID_METHOD_SVGF, LIMPID_METHOD_BILATERAL}) {
        limpid_denoiser_desc desc = {};
        desc.method = method;
        limpid_denoiser* denoiser = create(desc);
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_warm_up(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
            EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
            const bool keeps = method == LIMPID_METHOD_SVGF;
            EXPECT_EQ(limpid_record(denoiser, commands, &f->frame),
                      keeps ? LIMPID_ERROR_INVALID_ARGUMENT : LIMPID_OK);
            if (keeps) {
                EXPECT_THAT(limpid_last_error(), HasSubstr("'previous_view' is singular"));
            }
        });
    }
}

TEST_F(VulkanFramesTest, PicturesInHalvesAreThoseInFloatsRounded) {
    for (const limpid_method method :
         {LIMPID_METHOD_SVGF, LIMPID_METHOD_ATROUS, LIMPID_METHOD_TEMPORAL, LIMPID_METHOD_BILATERAL,
          LIMPID_METHOD_VISIBILITY, LIMPID_METHOD_NANO}) {
        limpid_denoiser_desc desc = {};
        desc.method = method;
        desc.signals = method == LIMPID_METHOD_VISIBILITY ? 1 : 2;
        colorFormat_ = gpu::Format::RGBA32Float;
        const std::vector<float> floats = denoiseSequence(create(desc), SyntheticScene({}), 3);
        colorFormat_ = gpu::Format::RGBA16Float;
        const std::vector<float> halves = denoiseSequence(create(desc), SyntheticScene({}), 3);
        ASSERT_EQ(halves.size(), floats.size());
        for (size_t i = 0; i < floats.size(); ++i)
            ASSERT_NEAR(halves[i], floats[i], 0x1p-11f * std::abs(floats[i]) + 0x1p-24f)
                << method << ' ' << i;
    }
}

TEST_F(VulkanFramesTest, TellsTheTimesOfFramesThatAreDone) {
    limpid_denoiser_desc desc = {};
    desc.timings = 1;
    limpid_denoiser* denoiser = create(desc);
    uint32_t count = 0;
    denoiseSequence(denoiser, SyntheticScene({}), 1);
    ASSERT_EQ(limpid_denoiser_timings(denoiser, nullptr, &count), LIMPID_OK);
    EXPECT_EQ(count, 0u);  // Limpid does not know yet whether the first frame is done
    denoiseSequence(denoiser, SyntheticScene({}), 3);
    ASSERT_EQ(limpid_denoiser_timings(denoiser, nullptr, &count), LIMPID_OK);
    ASSERT_GT(count, 5u);
    std::vector<limpid_timing> times(count);
    ASSERT_EQ(limpid_denoiser_timings(denoiser, times.data(), &count), LIMPID_OK);
    EXPECT_STREQ(times[0].pass, "ingest");
    for (const limpid_timing& time : times) EXPECT_GT(time.milliseconds, 0.0) << time.pass;
}

TEST_F(VulkanFramesTest, WarmUpsChangeNothing) {
    limpid_denoiser* denoiser = create();
    size_t size = 0;
    ASSERT_EQ(limpid_device_pipeline_cache(adopted_, nullptr, &size), LIMPID_OK);
    std::vector<char> bytes(size);
    ASSERT_EQ(limpid_device_pipeline_cache(adopted_, bytes.data(), &size), LIMPID_OK);
    // A cache can only be loaded before pipelines exist.
    EXPECT_NE(limpid_device_load_pipeline_cache(adopted_, bytes.data(), size), LIMPID_OK);
    const SyntheticScene scene({});
    const auto f = upload(scene, 0);
    const auto warmUp = [&] {
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_warm_up(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
        });
    };
    warmUp();
    EXPECT_EQ(denoiseSequence(denoiser, scene, 1), denoiseSequence(create(), scene, 1));
    // Once more when the histories hold a frame, and before a cut.
    warmUp();
    ASSERT_EQ(limpid_denoiser_reset(denoiser), LIMPID_OK);
    EXPECT_EQ(denoiseSequence(denoiser, scene, 3), denoiseSequence(create(), scene, 3));
    limpid_denoiser_desc nano = {};
    nano.method = LIMPID_METHOD_NANO;
    denoiser = create(nano);
    warmUp();
    EXPECT_EQ(denoiseSequence(denoiser, scene, 2), denoiseSequence(create(nano), scene, 2));
}

TEST_F(VulkanFramesTest, PipelineCachesAreNotCutOff) {
    create();
    size_t size = 0;
    ASSERT_EQ(limpid_device_pipeline_cache(adopted_, nullptr, &size), LIMPID_OK);
    std::vector<char> bytes(size, 'x');
    size_t room = size - 1;
    EXPECT_EQ(limpid_device_pipeline_cache(adopted_, bytes.data(), &room), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(room, size);
    EXPECT_EQ(bytes, std::vector<char>(size, 'x'));
    EXPECT_EQ(limpid_device_pipeline_cache(adopted_, bytes.data(), &room), LIMPID_OK);
}

/// The program's loader, without some functions of Vulkan 1.1 or 1.3, as instances of older versions are.
PFN_vkVoidFunction instanceOfVersion10(VkInstance instance, const char* name) {
    return std::string_view(name) == "vkGetPhysicalDeviceFeatures2" ? nullptr
                                                                    : gpu::systemLoader()(instance, name);
}

PFN_vkVoidFunction deviceOfVersion12(VkDevice, const char* name) {
    if (std::string_view(name) == "vkCmdPipelineBarrier2") return nullptr;
    // Any function will do: none of the device is called.
    return reinterpret_cast<PFN_vkVoidFunction>(&deviceOfVersion12);
}

PFN_vkVoidFunction instanceOfVersion12(VkInstance instance, const char* name) {
    if (std::string_view(name) == "vkGetDeviceProcAddr")
        return reinterpret_cast<PFN_vkVoidFunction>(&deviceOfVersion12);
    return gpu::systemLoader()(instance, name);
}

TEST_F(VulkanFramesTest, RefusesWhatCannotRunIt) {
    limpid_vulkan_device_desc desc = {};
    desc.get_instance_proc_addr = &instanceOfVersion10;
    EXPECT_EQ(adopt(desc), LIMPID_ERROR_UNSUPPORTED);
    EXPECT_THAT(limpid_last_error(), HasSubstr("vkGetPhysicalDeviceFeatures2"));
    desc.get_instance_proc_addr = &instanceOfVersion12;
    EXPECT_EQ(adopt(desc), LIMPID_ERROR_UNSUPPORTED);
    EXPECT_THAT(limpid_last_error(), HasSubstr("vkCmdPipelineBarrier2"));
    desc.get_instance_proc_addr = nullptr;
    desc.queue_family = 99;
    EXPECT_EQ(adopt(desc), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(adopted_, nullptr);
}

TEST_F(VulkanFramesTest, RefusesSizesThatTheDeviceDoesNotHave) {
    limpid_denoiser* denoiser = create();
    limpid_denoiser_desc desc = {sizeof desc};
    desc.width = 32768;
    desc.height = 1;
    const limpid_result expected =
        device().impl().context->limits().maxImageDimension2D < 32768 ? LIMPID_ERROR_UNSUPPORTED : LIMPID_OK;
    limpid_denoiser* large = nullptr;
    EXPECT_EQ(limpid_denoiser_create(adopted_, &desc, &large), expected);
    EXPECT_EQ(limpid_denoiser_resize(denoiser, 1, 32768), expected);
    limpid_denoiser_destroy(large);
    // On GPUs, the buffers of the largest pictures exceed most limits.
    desc.width = desc.height = device().impl().context->limits().maxImageDimension2D;
    const bool tooLarge = gpu::filterChoice(device()).backing == gpu::Backing::Buffer &&
                          device().maxStorageBufferBytes() < uint64_t{8} * desc.width * desc.height;
    for (const limpid_method method : {LIMPID_METHOD_SVGF, LIMPID_METHOD_NANO}) {
        desc.method = method;
        // The network's channels are in buffers on all devices: it computes the picture in parts.
        ASSERT_EQ(limpid_denoiser_create(adopted_, &desc, &large),
                  tooLarge ? LIMPID_ERROR_UNSUPPORTED : LIMPID_OK)
            << limpid_last_error();
        if (tooLarge) {
            EXPECT_THAT(limpid_last_error(), HasSubstr("bytes in a buffer"));
        }
        limpid_denoiser_destroy(large);
    }
}

TEST_F(VulkanFramesTest, DamagedPipelineCachesAreIgnored) {
    ASSERT_EQ(adopt({}), LIMPID_OK);  // a device without pipelines
    const std::string garbage(1000, 'x');
    EXPECT_EQ(limpid_device_load_pipeline_cache(adopted_, garbage.data(), garbage.size()), LIMPID_OK)
        << limpid_last_error();
    create();
}

TEST_F(VulkanFramesTest, FollowsANewSize) {
    limpid_denoiser* denoiser = create();
    const SyntheticScene scene({});
    denoiseSequence(denoiser, scene, 2);
    constexpr gpu::Extent other{33, 17};
    ASSERT_EQ(limpid_denoiser_resize(denoiser, other.width, other.height), LIMPID_OK) << limpid_last_error();
    std::vector<float> resized;
    for (int number = 0; number < 2; ++number) {
        const auto f = upload(scene, number, other);
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
        });
        resized = pixels(*f);
    }
    for (const float value : resized) ASSERT_TRUE(std::isfinite(value));
    EXPECT_EQ(limpid_denoiser_resize(denoiser, 0, 5), LIMPID_ERROR_INVALID_ARGUMENT);
}

/// An allocator of the program's: a block of its own for each request.
struct Heap {
    const gpu::Context* context;
    bool maps = true;
    int blocks = 0, freed = 0;
    uint64_t used = 0, room = UINT64_MAX;  ///< bytes

    limpid_vulkan_device_desc described() {
        limpid_vulkan_device_desc desc = {};
        desc.memory_user = this;
        desc.allocate = [](void* user, const VkMemoryRequirements* requirements,
                           VkMemoryPropertyFlags properties, const char*, limpid_vulkan_memory* block) {
            return static_cast<Heap*>(user)->allocate(*requirements, properties, *block);
        };
        desc.free = [](void* user, const limpid_vulkan_memory* block) {
            auto& from = *static_cast<Heap*>(user);
            from.context->vk().FreeMemory(from.context->device(), block->memory, nullptr);
            from.used -= reinterpret_cast<uintptr_t>(block->handle);
            ++from.freed;
        };
        return desc;
    }

  private:
    VkResult allocate(const VkMemoryRequirements& requirements, VkMemoryPropertyFlags properties,
                      limpid_vulkan_memory& block) {
        if (used + requirements.size > room) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        info.allocationSize = requirements.size;
        const auto& types = context->memoryProperties();
        while (!(requirements.memoryTypeBits >> info.memoryTypeIndex & 1) ||
               (types.memoryTypes[info.memoryTypeIndex].propertyFlags & properties) != properties)
            ++info.memoryTypeIndex;
        const gpu::DeviceFunctions& vk = context->vk();
        const VkResult result = vk.AllocateMemory(vk.device, &info, nullptr, &block.memory);
        if (result == VK_SUCCESS && maps && (properties & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT))
            vk.MapMemory(vk.device, block.memory, 0, VK_WHOLE_SIZE, 0, &block.mapped);
        ++blocks;
        used += requirements.size;
        block.handle = reinterpret_cast<void*>(uintptr_t{requirements.size});
        return result;
    }
};

TEST_F(VulkanFramesTest, MemoryThatIsNotMappedIsGivenBack) {
    Heap heap{.context = &program(), .maps = false};
    ASSERT_EQ(adopt(heap.described()), LIMPID_OK) << limpid_last_error();
    limpid_denoiser* const denoiser = create();
    const auto f = upload(SyntheticScene({}), 0);
    run([&](VkCommandBuffer commands) {
        EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_ERROR_FAILED);
        EXPECT_THAT(limpid_last_error(), HasSubstr("memory that the host cannot see"));
    });
    limpid_denoiser_destroy(std::exchange(denoisers_.back(), nullptr));
    limpid_device_destroy(std::exchange(adopted_, nullptr));
    EXPECT_GT(heap.blocks, 0);
    EXPECT_EQ(heap.freed, heap.blocks);
}

TEST_F(VulkanFramesTest, TakesMemoryFromTheCaller) {
    Heap heap{.context = &program()};
    ASSERT_EQ(adopt(heap.described()), LIMPID_OK) << limpid_last_error();
    const SyntheticScene scene(movingObject);
    limpid_denoiser* const denoiser = create();
    const auto f = upload(scene, 0);
    run([&](VkCommandBuffer commands) {
        EXPECT_EQ(limpid_warm_up(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
    });
    const int warmed = heap.blocks;
    const std::vector<float> picture = denoiseSequence(denoiser, scene, 2);
    EXPECT_GT(warmed, 10);
    EXPECT_LE(heap.blocks, warmed + 4) << "a warm-up makes the images, so that frames only need parameters";
    limpid_denoiser_destroy(std::exchange(denoisers_.back(), nullptr));
    limpid_device_destroy(std::exchange(adopted_, nullptr));
    EXPECT_EQ(heap.freed, heap.blocks);
    ASSERT_EQ(adopt({}), LIMPID_OK);
    EXPECT_EQ(picture, denoiseSequence(create(), scene, 2));
}

/// As while a window is dragged: each frame has another size.
TEST_F(VulkanFramesTest, ImagesOfEarlierSizesAreFreedSoon) {
    Heap heap{.context = &program()};
    ASSERT_EQ(adopt(heap.described()), LIMPID_OK) << limpid_last_error();
    limpid_denoiser* const denoiser = create();
    denoiseSequence(denoiser, SyntheticScene({}), 3);
    const int ofOneSize = heap.blocks - heap.freed;
    for (uint32_t more = 1; more <= 6; ++more) {
        ASSERT_EQ(limpid_denoiser_resize(denoiser, width + more, height), LIMPID_OK) << limpid_last_error();
        const auto f = upload(SyntheticScene({}), 0, {width + more, height});
        run([&](VkCommandBuffer commands) {
            EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
        });
        EXPECT_LE(heap.blocks - heap.freed, 3 * ofOneSize) << "this size, and those of two earlier frames";
    }
    limpid_denoiser_destroy(std::exchange(denoisers_.back(), nullptr));
    limpid_device_destroy(std::exchange(adopted_, nullptr));
    EXPECT_EQ(heap.freed, heap.blocks);
    ASSERT_EQ(adopt({}), LIMPID_OK);
}

TEST_F(VulkanFramesTest, GoesOnAfterMemoryHasRunOut) {
    Heap heap{.context = &program()};
    ASSERT_EQ(adopt(heap.described()), LIMPID_OK) << limpid_last_error();
    limpid_denoiser* const denoiser = create();
    const auto record = [&](gpu::Extent extent) {
        EXPECT_EQ(limpid_denoiser_resize(denoiser, extent.width, extent.height), LIMPID_OK);
        const auto f = upload(SyntheticScene({}), 0, extent);
        limpid_result result = LIMPID_OK;
        run([&](VkCommandBuffer commands) { result = limpid_record(denoiser, commands, &f->frame); });
        return result;
    };
    constexpr gpu::Extent first{width, height}, large{128, 96};
    for (int number = 0; number < 3; ++number) ASSERT_EQ(record(first), LIMPID_OK) << limpid_last_error();
    heap.room = heap.used + 20000;  // less than one image of the large size takes
    for (int attempt = 0; attempt < 3; ++attempt) EXPECT_EQ(record(large), LIMPID_ERROR_OUT_OF_MEMORY);
    EXPECT_EQ(record(first), LIMPID_OK) << limpid_last_error();
    heap.room = UINT64_MAX;
    EXPECT_EQ(record(large), LIMPID_OK) << limpid_last_error();
    limpid_denoiser_destroy(std::exchange(denoisers_.back(), nullptr));
    limpid_device_destroy(std::exchange(adopted_, nullptr));
    EXPECT_EQ(heap.freed, heap.blocks);
    ASSERT_EQ(adopt({}), LIMPID_OK);
}

TEST_F(VulkanFramesTest, SaysWhatIsWrong) {
    limpid_denoiser* denoiser = create();
    const SyntheticScene scene({});
    const auto f = upload(scene, 0);
    run([&](VkCommandBuffer commands) {
        EXPECT_EQ(limpid_record(denoiser, nullptr, &f->frame), LIMPID_ERROR_INVALID_ARGUMENT);
        limpid_vulkan_frame bad = f->frame;
        bad.inputs[LIMPID_INPUT_DEPTH].image = VK_NULL_HANDLE;
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("'depth' is missing"));
        bad = f->frame;
        bad.outputs[LIMPID_OUTPUT_COLOR].format = VK_FORMAT_R8G8B8A8_UNORM;
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("'color' is of VkFormat"));
        bad = f->frame;
        bad.inputs[LIMPID_INPUT_NORMAL].view = VK_NULL_HANDLE;
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        bad = f->frame;
        bad.inputs[LIMPID_INPUT_NORMAL].format = VK_FORMAT_UNDEFINED;
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("format of the input 'normal' is not set"));
        bad = f->frame;
        std::swap(bad.inputs[LIMPID_INPUT_ID].format, bad.inputs[LIMPID_INPUT_DEPTH].format);
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        bad = f->frame;
        bad.outputs[LIMPID_OUTPUT_RADIANCE] = bad.outputs[LIMPID_OUTPUT_COLOR];
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("have the same image"));
        bad = f->frame;
        bad.inputs[LIMPID_INPUT_RADIANCE] = bad.outputs[LIMPID_OUTPUT_COLOR];
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("'radiance' and the output 'color' have the same image"));
        bad = f->frame;
        bad.inputs[LIMPID_INPUT_RADIANCE].format = VK_FORMAT_R32G32B32A32_SINT;
        EXPECT_EQ(limpid_record(denoiser, commands, &bad), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("'radiance' is of VkFormat"));
    });
    limpid_host_frame host = {sizeof host};
    EXPECT_EQ(limpid_denoise_host(denoiser, &host), LIMPID_ERROR_INVALID_ARGUMENT);
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    EXPECT_EQ(limpid_vulkan_enable_features(&features), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("synchronization2"));
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    features.pNext = &v12;
    v12.pNext = &v13;
    EXPECT_EQ(limpid_vulkan_enable_features(&features), LIMPID_OK) << limpid_last_error();
    EXPECT_TRUE(v12.scalarBlockLayout && v13.synchronization2 && v13.maintenance4);
}

}  // namespace
}  // namespace limpid::test

// Tests what happens when the Vulkan device is lost or its memory runs out: Limpid's calls report it, all
// objects can still be destroyed, and once there is memory again, the pictures are the same as ever. The
// failures are simulated: functions between Limpid and the real driver return them when the test asks for it.
#include <gmock/gmock.h>

#include <atomic>

#include "tests/embed/vulkan_program.h"

namespace limpid::test {
namespace {

using testing::HasSubstr;

/// The Vulkan functions that are wrapped: those that can fail, and those that destroy objects.
// clang-format off
#define FAILING_FUNCTIONS(X) \
    X(AllocateMemory) X(CreateBuffer) X(CreateComputePipelines) X(CreateDescriptorPool) \
    X(CreateDescriptorSetLayout) X(CreateImage) X(CreateImageView) X(CreatePipelineCache) \
    X(CreatePipelineLayout) X(CreateQueryPool) X(CreateShaderModule) X(AllocateDescriptorSets) \
    X(BindBufferMemory) X(BindImageMemory) X(GetPipelineCacheData) X(GetQueryPoolResults) X(MapMemory) \
    X(ResetDescriptorPool)
#define DESTROYING_FUNCTIONS(X) \
    X(FreeMemory) X(DestroyBuffer) X(DestroyPipeline) X(DestroyDescriptorPool) \
    X(DestroyDescriptorSetLayout) X(DestroyImage) X(DestroyImageView) X(DestroyPipelineCache) \
    X(DestroyPipelineLayout) X(DestroyQueryPool) X(DestroyShaderModule)
// clang-format on

// The wrappers' state is global, since Vulkan's functions have no argument for it. It is atomic because
// several threads create pipelines.
enum class Failing {
#define ENUMERATOR(name) name,
    FAILING_FUNCTIONS(ENUMERATOR) Count
#undef ENUMERATOR
};
constexpr int nothing = -1, everything = static_cast<int>(Failing::Count);
constexpr int lastThatMakes = static_cast<int>(Failing::CreateShaderModule);
std::atomic<int> lost = nothing;  ///< the function that reports the loss: a Failing, nothing or everything
std::atomic<int> spared = 0;      ///< so many of its calls still succeed
std::atomic<VkResult> failure = VK_ERROR_DEVICE_LOST;
std::atomic<int> alive = 0;  ///< number of objects that were created and not yet destroyed
std::atomic<bool> reported = false;

template <typename Function, Failing which>
struct Fails;
template <typename... Args, Failing which>
struct Fails<VkResult (*)(Args...), which> {
    inline static VkResult (*real)(Args...) = nullptr;
    static VkResult call(Args... args) {
        if ((lost == everything || lost == static_cast<int>(which)) && spared-- <= 0) {
            reported = true;
            return failure;
        }
        const VkResult result = real(args...);
        if (result == VK_SUCCESS && static_cast<int>(which) <= lastThatMakes) ++alive;
        return result;
    }
};

template <typename Handle>
struct Destroys {
    using Function = void (*)(VkDevice, Handle, const VkAllocationCallbacks*);
    inline static Function real = nullptr;
    static void call(VkDevice device, Handle handle, const VkAllocationCallbacks* allocator) {
        if (handle != VK_NULL_HANDLE) --alive;
        real(device, handle, allocator);
    }
};
template <typename Handle>
Destroys<Handle> destroyerOf(void (*)(VkDevice, Handle, const VkAllocationCallbacks*));

PFN_vkGetDeviceProcAddr realDeviceProcAddr = nullptr;

PFN_vkVoidFunction deviceProcAddr(VkDevice device, const char* name) {
    const PFN_vkVoidFunction real = realDeviceProcAddr(device, name);
    const std::string_view asked = name;
#define WRAP(function, Wrapper)                                      \
    if (asked == "vk" #function) {                                   \
        Wrapper::real = reinterpret_cast<PFN_vk##function>(real);    \
        return reinterpret_cast<PFN_vkVoidFunction>(&Wrapper::call); \
    }
#define WRAP_FAILING(name) WRAP(name, Fails<PFN_vk##name COMMA Failing::name>)
#define WRAP_DESTROYING(name) WRAP(name, decltype(destroyerOf(PFN_vk##name{})))
#define COMMA ,
    FAILING_FUNCTIONS(WRAP_FAILING)
    DESTROYING_FUNCTIONS(WRAP_DESTROYING)
    return real;
}

PFN_vkVoidFunction instanceProcAddr(VkInstance instance, const char* name) {
    const PFN_vkVoidFunction real = gpu::systemLoader()(instance, name);
    if (std::string_view(name) != "vkGetDeviceProcAddr") return real;
    realDeviceProcAddr = reinterpret_cast<PFN_vkGetDeviceProcAddr>(real);
    return reinterpret_cast<PFN_vkVoidFunction>(&deviceProcAddr);
}

class DeviceLostTest : public VulkanProgramTest {
  protected:
    void SetUp() override {
        VulkanProgramTest::SetUp();
        if (IsSkipped()) return;
        destroyAll();
        alive = 0;
        limpid_vulkan_device_desc desc = {};
        desc.get_instance_proc_addr = &instanceProcAddr;
        ASSERT_EQ(adopt(desc), LIMPID_OK) << limpid_last_error();
        reported = false;
    }
    void TearDown() override {
        lost = nothing;
        failure = VK_ERROR_DEVICE_LOST;
        destroyAll();
        VulkanProgramTest::TearDown();
    }

    limpid_denoiser* createTimed(limpid_method method = LIMPID_METHOD_SVGF) {
        limpid_denoiser_desc desc = {};
        desc.method = method;
        desc.timings = 1;
        desc.frames_in_flight = 1;
        return create(desc);
    }

    void destroyAll() {
        device().waitIdle();
        for (limpid_denoiser*& denoiser : denoisers_)
            limpid_denoiser_destroy(std::exchange(denoiser, nullptr));
        limpid_device_destroy(std::exchange(adopted_, nullptr));
    }

    void destroyLast() {
        device().waitIdle();
        limpid_denoiser_destroy(std::exchange(denoisers_.back(), nullptr));
    }

    /// Lets a function fail, after `calls` calls that succeed.
    void fail(int function, int calls = 0) {
        reported = false;
        spared = calls;
        lost = function;
    }

    /// Records a frame and returns the result. The command buffer is submitted even after an error.
    limpid_result record(limpid_denoiser* denoiser, int number, std::vector<float>* picture = nullptr) {
        const auto f = upload(SyntheticScene({}), number);
        limpid_result result = LIMPID_OK;
        run([&](VkCommandBuffer commands) { result = limpid_record(denoiser, commands, &f->frame); });
        if (picture) *picture = pixels(*f);
        return result;
    }
};

TEST_F(DeviceLostTest, EveryCallThatMeetsItSaysSo) {
    limpid_denoiser* denoiser = createTimed();
    ASSERT_EQ(record(denoiser, 0), LIMPID_OK) << limpid_last_error();
    const auto f = upload(SyntheticScene({}), 1);
    fail(everything);
    EXPECT_EQ(record(denoiser, 1), LIMPID_ERROR_DEVICE_LOST);
    EXPECT_THAT(limpid_last_error(), HasSubstr("the device was lost"));
    run([&](VkCommandBuffer commands) {
        EXPECT_EQ(limpid_warm_up(denoiser, commands, &f->frame), LIMPID_ERROR_DEVICE_LOST);
    });
    size_t size = 0;
    EXPECT_EQ(limpid_device_pipeline_cache(adopted_, nullptr, &size), LIMPID_ERROR_DEVICE_LOST);
    limpid_denoiser_desc desc = {sizeof desc};
    desc.width = width, desc.height = height;
    desc.method = LIMPID_METHOD_ATROUS;  // its pipelines do not exist yet
    limpid_denoiser* second = nullptr;
    EXPECT_EQ(limpid_denoiser_create(adopted_, &desc, &second), LIMPID_ERROR_DEVICE_LOST);
    EXPECT_EQ(second, nullptr);
    EXPECT_EQ(limpid_denoiser_resize(denoiser, width, height), LIMPID_OK) << "asks the device nothing";
    EXPECT_GT(alive, 10);
    destroyAll();
    EXPECT_EQ(alive, 0) << "objects are left";
}

/// Lets each function be the first to report the loss, at any point of a frame.
TEST_F(DeviceLostTest, WhereverAFrameStopsNothingIsLeft) {
    int met = 0;
    for (int function = 0; function < everything; ++function) {
        limpid_denoiser* denoiser = createTimed();
        fail(function);
        const limpid_result first = record(denoiser, 0);
        const limpid_result second = first == LIMPID_OK ? record(denoiser, 1) : first;
        EXPECT_EQ(second, reported ? LIMPID_ERROR_DEVICE_LOST : LIMPID_OK) << "function " << function;
        met += reported;
        lost = nothing;
        destroyLast();
    }
    EXPECT_GE(met, 10) << "a frame calls more of them";
    destroyAll();
    EXPECT_EQ(alive, 0) << "objects are left";
}

/// A frame that fails, in the middle of a sequence, leaves the histories as they are.
TEST_F(DeviceLostTest, AFrameWithoutMemoryCanBeRepeated) {
    const std::vector<float> expected = denoiseSequence(createTimed(), SyntheticScene({}), 3);
    failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    int met = 0;
    for (const int firstToFail : {0, 1}) {
        for (int function = 0; function < everything; ++function) {
            limpid_denoiser* denoiser = createTimed();
            std::vector<float> picture;
            for (int number = 0; number < 3; ++number) {
                if (number == firstToFail) {
                    fail(function);
                    const limpid_result result = record(denoiser, number);
                    EXPECT_EQ(result, reported ? LIMPID_ERROR_OUT_OF_MEMORY : LIMPID_OK);
                    lost = nothing;
                    met += reported;
                    if (!reported) continue;
                }
                ASSERT_EQ(record(denoiser, number, &picture), LIMPID_OK) << limpid_last_error();
            }
            EXPECT_EQ(picture, expected) << "function " << function << " in frame " << firstToFail;
            destroyLast();
        }
    }
    EXPECT_GE(met, 12) << "frames call more of them";
}

/// Whichever allocation fails: nano also has some for its uploads.
TEST_F(DeviceLostTest, AFirstFrameOfNanoWithoutMemoryCanBeRepeated) {
    const auto create = [&] { return createTimed(LIMPID_METHOD_NANO); };
    const std::vector<float> expected = denoiseSequence(create(), SyntheticScene({}), 2);
    failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    reported = true;
    int calls = 0;
    for (; reported; ++calls) {
        limpid_denoiser* denoiser = create();
        fail(static_cast<int>(Failing::AllocateMemory), calls);
        const limpid_result result = record(denoiser, 0);
        EXPECT_EQ(result, reported ? LIMPID_ERROR_OUT_OF_MEMORY : LIMPID_OK);
        lost = nothing;
        if (reported) {
            EXPECT_EQ(denoiseSequence(denoiser, SyntheticScene({}), 2), expected) << calls << " allocations";
        }
        destroyLast();
    }
    EXPECT_GE(calls, 30) << "frames allocate more often";
}

TEST_F(DeviceLostTest, AWarmUpWithoutMemoryChangesNothing) {
    const std::vector<float> expected = denoiseSequence(createTimed(), SyntheticScene({}), 2);
    failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    const auto f = upload(SyntheticScene({}), 0);
    reported = true;
    int calls = 0;
    for (; reported; calls += 3) {
        limpid_denoiser* denoiser = createTimed();
        fail(static_cast<int>(Failing::AllocateMemory), calls);
        run([&](VkCommandBuffer commands) {
            const limpid_result result = limpid_warm_up(denoiser, commands, &f->frame);
            EXPECT_EQ(result, reported ? LIMPID_ERROR_OUT_OF_MEMORY : LIMPID_OK);
        });
        lost = nothing;
        EXPECT_EQ(denoiseSequence(denoiser, SyntheticScene({}), 2), expected) << calls << " allocations";
        destroyLast();
    }
    EXPECT_GT(calls, 20) << "a warm-up makes more images";
}

TEST_F(DeviceLostTest, AdoptingALostDeviceFails) {
    destroyAll();
    fail(everything);
    limpid_vulkan_device_desc desc = {};
    desc.get_instance_proc_addr = &instanceProcAddr;
    EXPECT_EQ(adopt(desc), LIMPID_ERROR_DEVICE_LOST);
    EXPECT_EQ(adopted_, nullptr);
    lost = nothing;
    destroyAll();
    EXPECT_EQ(alive, 0) << "objects are left";
}

TEST_F(DeviceLostTest, ANewStartGivesTheSamePictures) {
    const SyntheticScene scene({});
    const std::vector<float> before = denoiseSequence(createTimed(), scene, 2);
    fail(everything);
    EXPECT_EQ(record(denoisers_.back(), 2), LIMPID_ERROR_DEVICE_LOST);
    destroyAll();
    lost = nothing;
    ASSERT_EQ(adopt({}), LIMPID_OK) << limpid_last_error();
    EXPECT_EQ(denoiseSequence(createTimed(), scene, 2), before);
}

}  // namespace
}  // namespace limpid::test

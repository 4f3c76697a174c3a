// Shared by tests that run shaders: a device with validation, and a function that runs one compute shader
// over buffers. LIMPID_TEST_DEVICE selects the device like --device; default: cpu (lavapipe).
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "gpu/graph/frame_graph.h"
#include "gpu/specialise/specialise.h"
#include "gpu/vulkan/device.h"
#include "scene/device/gpu_scene.h"

namespace limpid::test {

/// A compute job: `count` threads along x.
struct Job {
    const gpu::ShaderCode& shader;
    const scene::GpuScene* scene = nullptr;  ///< its buffers and constants are bound
    std::vector<gpu::Binding> buffers;       ///< besides the scene's and the results
    std::vector<gpu::ConstantValue> constants;
    std::span<const std::byte> params;
    uint32_t count = 0;
    const gpu::RayShaders* rays = nullptr;  ///< set if `shader` is a ray-generation shader
};

inline std::string wantedDevice() {
    const char* variable = std::getenv("LIMPID_TEST_DEVICE");
    return variable ? variable : "cpu";
}

/// The device of all tests of a program, with validation if its layer is installed. Tests share it so that
/// each shader is compiled once, and because NVIDIA's driver can only be unloaded and reloaded a limited
/// number of times. Null if this machine has no Vulkan device.
class TestDevice : public testing::Environment {
  public:
    static gpu::Device* get() {
        if (!device_ && !gpu::enumerateDevices().empty()) device_ = make();
        return device_.get();
    }
    void TearDown() override { device_.reset(); }

  private:
    static std::unique_ptr<gpu::Device> make() {
        gpu::DeviceOptions options{.select = wantedDevice(),
                                   .validation = true,
                                   .messages = log::write,
                                   .specialise = gpu::specialiser()};
        try {
            return std::make_unique<gpu::Device>(options);
        } catch (const Error& error) {
            if (std::string(error.what()).find("vulkan-validationlayers") == std::string::npos) throw;
            log::warn("NOT VALIDATED: {}", error.what());
            options.validation = false;
            return std::make_unique<gpu::Device>(options);
        }
    }

    inline static std::unique_ptr<gpu::Device> device_;
};
inline testing::Environment* const testDevice = testing::AddGlobalTestEnvironment(new TestDevice);

class GpuTest : public testing::Test {
  protected:
    void SetUp() override {
        device_ = TestDevice::get();
        if (!device_) {
            GTEST_SKIP()
                << "NOT TESTED: this machine has no Vulkan device. Install mesa-vulkan-drivers (lavapipe).";
        }
        messagesBefore_ = device_->validationMessages();
    }
    void TearDown() override {
        if (!device_) return;
        device_->waitIdle();
        EXPECT_EQ(device_->validationMessages(), messagesBefore_);
    }

    gpu::Device& device() { return *device_; }

    template <typename T>
    gpu::Buffer upload(const std::string& name, const std::vector<T>& values) {
        return device().createStorageBuffer(name, gpu::bytesOf(values));
    }

    /// Runs the job and returns the content of its buffer `results`, which has `resultCount` elements.
    template <typename Result>
    std::vector<Result> run(const Job& job, size_t resultCount) {
        const gpu::Buffer results = device().createStorageBuffer("results", resultCount * sizeof(Result));
        gpu::Dispatch dispatch{
            .pass = "test", .shader = job.shader, .bindings = job.buffers, .params = job.params};
        dispatch.constants = job.constants;
        if (job.scene) {
            for (const gpu::Binding& b : job.scene->bindings()) dispatch.bindings.push_back(b);
            for (const gpu::ConstantValue& c : job.scene->constants()) dispatch.constants.push_back(c);
        }
        dispatch.bindings.push_back({"results", &results});
        dispatch.extent = {job.count, 1};
        dispatch.rays = job.rays;
        graph_.beginFrame();
        graph_.dispatch(dispatch);
        graph_.execute(device());
        const std::vector<std::byte> bytes = device().download(results);
        std::vector<Result> values(resultCount);
        std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

  private:
    gpu::Device* device_ = nullptr;
    uint64_t messagesBefore_ = 0;
    gpu::FrameGraph graph_;
};

}  // namespace limpid::test

// The fixture of this folder's device tests. Enables validation and synchronisation validation if the layer
// is installed. LIMPID_TEST_DEVICE selects the device like --device; default: cpu (lavapipe).
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "base/error.h"
#include "base/log.h"
#include "gpu/graph/frame_graph.h"
#include "gpu/vulkan/device_impl.h"
#include "test_accumulate.comp.h"
#include "test_fill.comp.h"
#include "test_scale.comp.h"

namespace limpid::gpu {

constexpr Extent odd{21, 13};
constexpr Format rgba = Format::RGBA32Float;

inline std::string faultOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

inline std::string wantedDevice() {
    const char* variable = std::getenv("LIMPID_TEST_DEVICE");
    return variable ? variable : "cpu";
}

struct FillParams {
    float color[3] = {1, 2, 3};
    float step = 1;
    float tail[3] = {};
};

class GpuTest : public testing::Test {
  protected:
    /// All tests of the suite share one device: NVIDIA's driver can only be unloaded and reloaded a limited
    /// number of times.
    static void SetUpTestSuite() {
        if (!enumerateDevices().empty())
            driver_ = std::make_unique<Device>(DeviceOptions{.select = wantedDevice()});
    }
    static void TearDownTestSuite() { driver_.reset(); }

    void SetUp() override {
        if (enumerateDevices().empty()) {
            GTEST_SKIP()
                << "NOT TESTED: this machine has no Vulkan device. Install mesa-vulkan-drivers (lavapipe).";
        }
        try {
            device_ = std::make_unique<Device>(
                DeviceOptions{.select = wantedDevice(), .validation = true, .messages = log::write});
            validated_ = true;
        } catch (const Error& error) {
            if (std::string(error.what()).find("vulkan-validationlayers") == std::string::npos) throw;
            log::warn("NOT VALIDATED: {}", error.what());
            device_ = std::make_unique<Device>(DeviceOptions{.select = wantedDevice()});
        }
    }
    void TearDown() override {
        if (device_ && expectNoMessages_) {
            EXPECT_EQ(device().validationMessages(), 0u);
        }
    }

    Device& device() { return *device_; }
    static void fill(FrameGraph& graph, std::string_view pass, ImageHandle image,
                     const FillParams& params = {}) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_fill_comp,
                        .bindings = {{"result", image}},
                        .params = paramsOf(params),
                        .extent = graph.extent(image)});
    }
    static void scale(FrameGraph& graph, std::string_view pass, ImageHandle source, ImageHandle result,
                      std::vector<ConstantValue> constants = {}) {
        graph.dispatch({.pass = pass,
                        .shader = shaders::test_scale_comp,
                        .bindings = {{"source", source}, {"result", result}},
                        .constants = std::move(constants),
                        .extent = graph.extent(result)});
    }
    static History accumulate(FrameGraph& graph, Extent extent) {
        const History history = graph.history("count", Format::R32Float, extent);
        const uint32_t valid = history.valid;
        graph.dispatch({.pass = "accumulate",
                        .shader = shaders::test_accumulate_comp,
                        .bindings = {{"previous", history.previous}, {"current", history.current}},
                        .params = paramsOf(valid),
                        .extent = extent});
        return history;
    }

    inline static std::unique_ptr<Device> driver_;
    std::unique_ptr<Device> device_;
    bool validated_ = false;
    bool expectNoMessages_ = true;
};

}  // namespace limpid::gpu

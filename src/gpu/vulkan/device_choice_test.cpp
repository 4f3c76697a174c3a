// Tests the selection of a device, and the messages if there is none or a call fails. Needs no device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "gpu/tests/gpu_test_fixture.h"
#include "gpu/vulkan/check.h"

namespace limpid::gpu {
namespace {

using testing::AllOf;
using testing::HasSubstr;

DeviceInfo described(uint32_t index, const char* name, DeviceType type, bool usable = true) {
    DeviceInfo info;
    info.index = index;
    info.name = name;
    info.type = type;
    info.usable = usable;
    if (!usable) info.whyNot = "scalarBlockLayout";
    return info;
}
TEST(DeviceChoice, FollowsTheRules) {
    const std::vector<DeviceInfo> infos{described(0, "llvmpipe (LLVM 15)", DeviceType::Cpu),
                                        described(1, "Old GPU", DeviceType::Discrete, false),
                                        described(2, "Intel UHD", DeviceType::Integrated),
                                        described(3, "NVIDIA H200", DeviceType::Discrete),
                                        described(4, "NVIDIA H200", DeviceType::Discrete)};
    EXPECT_EQ(chooseIndex(infos, ""), 3u);
    EXPECT_EQ(chooseIndex(infos, "cpu"), 0u);
    EXPECT_EQ(chooseIndex(infos, "CPU"), 0u);
    EXPECT_EQ(chooseIndex(infos, "2"), 2u);
    EXPECT_EQ(chooseIndex(infos, "h200"), 3u);
    EXPECT_EQ(chooseIndex(infos, "LLVM"), 0u);
    EXPECT_THAT(faultOf([&] { chooseIndex(infos, "1"); }),
                AllOf(HasSubstr("no usable Vulkan device is '1'"),
                      HasSubstr("unusable: it lacks scalarBlockLayout")));
    EXPECT_THAT(
        faultOf([&] { chooseIndex(infos, "radeon"); }),
        AllOf(HasSubstr("no Vulkan device matches 'radeon'"), HasSubstr("3: NVIDIA H200 (discrete)")));
    EXPECT_THAT(faultOf([&] { chooseIndex(infos, "7"); }), HasSubstr("no Vulkan device matches '7'"));
    EXPECT_THAT(faultOf([&] { chooseIndex({infos[1]}, ""); }), HasSubstr("no Vulkan device here is usable"));
}

TEST(DeviceChoice, WithoutADriverThereAreNoDevicesAndTheErrorHelps) {
    // The loader reads these for each instance. Each test runs in its own process, or this one runs last.
    ::setenv("VK_ICD_FILENAMES", "/nonexistent/icd.json", 1);
    ::setenv("VK_DRIVER_FILES", "/nonexistent/icd.json", 1);
    EXPECT_TRUE(enumerateDevices().empty());
    EXPECT_THAT(faultOf([] { Device device; }), HasSubstr("mesa-vulkan-drivers"));
    ::unsetenv("VK_ICD_FILENAMES");
    ::unsetenv("VK_DRIVER_FILES");
}

TEST(Check, NamesTheCallThePlaceAndTheResult) {
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_DEVICE_LOST); }),
                AllOf(HasSubstr("the device was lost"), HasSubstr("VK_ERROR_DEVICE_LOST"),
                      HasSubstr("(src/gpu/vulkan/device_choice_test.cpp:")));
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_OUT_OF_DEVICE_MEMORY); }), HasSubstr("out of device memory"));
    EXPECT_THAT(faultOf([] { LIMPID_VK(VK_ERROR_OUT_OF_HOST_MEMORY); }), HasSubstr("out of host memory"));
    EXPECT_EQ(faultOf([] { LIMPID_VK(VK_SUCCESS); }), "no error");
}

}  // namespace
}  // namespace limpid::gpu

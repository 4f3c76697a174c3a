#include "cli/cluster/local_share.h"

#include <gtest/gtest.h>

namespace limpid::cli {
namespace {

using gpu::DeviceInfo;
using gpu::DeviceType;

const std::vector<DeviceInfo> machine{
    {.index = 0, .name = "Integrated X", .type = DeviceType::Integrated, .usable = true},
    {.index = 1, .name = "Big GPU", .type = DeviceType::Discrete, .usable = true},
    {.index = 2, .name = "Old GPU", .type = DeviceType::Discrete, .usable = false},
    {.index = 3, .name = "Big GPU", .type = DeviceType::Discrete, .usable = true},
    {.index = 4, .name = "llvmpipe", .type = DeviceType::Cpu, .usable = true}};

TEST(LocalShare, EachProcessHasADeviceOfTheBestKind) {
    EXPECT_EQ(deviceOfProcess(machine, "", 0), "1");
    EXPECT_EQ(deviceOfProcess(machine, "", 1), "3");
    EXPECT_EQ(deviceOfProcess(machine, "", 2), "1") << "more processes than devices";
    EXPECT_EQ(deviceOfProcess(machine, "big", 1), "3");
}

TEST(LocalShare, AChoiceOfOneDeviceHolds) {
    for (const char* select : {"cpu", "4", "integrated", "no such"})
        EXPECT_EQ(deviceOfProcess(machine, select, 1), select);
    EXPECT_EQ(deviceOfProcess({}, "", 1), "");
    EXPECT_EQ(deviceOfProcess(std::span(machine).last(1), "", 1), "");
}

TEST(LocalShare, ProcessesShareTheCores) {
    EXPECT_EQ(threadsOfProcess(2, 2, 1), 2);
    EXPECT_EQ(threadsOfProcess(2, 2, 2), 1);
    EXPECT_EQ(threadsOfProcess(2, 2, 4), 1);
    EXPECT_EQ(threadsOfProcess(64, 64, 8), 8);
    EXPECT_EQ(threadsOfProcess(8, 64, 8), 8) << "the launcher has shared them out";
    EXPECT_EQ(threadsOfProcess(32, 64, 8), 4) << "it bound them to a socket";
}

}  // namespace
}  // namespace limpid::cli

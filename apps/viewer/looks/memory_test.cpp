#include "viewer/looks/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace limpid::viewer {
namespace {

namespace fs = std::filesystem;

class MemoryTest : public testing::Test {
  protected:
    MemoryTest() : folder_(fs::temp_directory_path() / ("limpid_memory_test." + std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~MemoryTest() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(MemoryTest, IsReadAsItWasWritten) {
    Memory memory{.dark = false,
                  .hdr = true,
                  .paperWhite = 150.0f,
                  .peak = 600.0f,
                  .panelWidth = 512.0f,
                  .open = {{"camera", true}, {"look", false}},
                  .recent = {}};
    memory.addRecent("/scenes/room.glb");
    writeMemory(folder_ / "window.json", memory);
    EXPECT_EQ(readMemory(folder_ / "window.json"), memory);
}

TEST_F(MemoryTest, ADamagedFileIsNothing) {
    std::ofstream(folder_ / "window.json") << "{\"theme\": \"light\", \"panel_width\": \"wide\"}";
    const Memory memory = readMemory(folder_ / "window.json");
    EXPECT_FALSE(memory.dark);
    EXPECT_EQ(memory.panelWidth, 0.0f);
    EXPECT_EQ(readMemory(folder_ / "missing.json"), Memory{});
}

TEST(Memory, TheLastTenScenesAreRecent) {
    Memory memory;
    for (int i = 0; i < 12; ++i) memory.addRecent("/scenes/" + std::to_string(i) + ".glb");
    ASSERT_EQ(memory.recent.size(), 10u);
    EXPECT_EQ(memory.recent.front(), "/scenes/11.glb");
    memory.addRecent("/scenes/5.glb");
    EXPECT_EQ(memory.recent.size(), 10u);
    EXPECT_EQ(memory.recent.front(), "/scenes/5.glb");
    memory.addRecent("builtin:cornell");
    memory.addRecent("/skies/day.hdr");
    EXPECT_EQ(memory.recent.front(), "/scenes/5.glb");
    memory.addRecent("/scenes/ROOM.GLB");
    EXPECT_EQ(memory.recent.front(), "/scenes/ROOM.GLB");
}

TEST(Memory, LiesBesideTheKeptSettings) {
    EXPECT_EQ(memoryFile("/home/a/limpid/view.json"), fs::path("/home/a/limpid/window.json"));
    EXPECT_EQ(memoryFile(""), fs::path());
}

}  // namespace
}  // namespace limpid::viewer

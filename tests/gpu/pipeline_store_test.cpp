// Tests the file that stores the driver's compiled pipelines.
#include "renderer/frame/pipeline_store.h"

#include <fstream>

#include "image/io/temp_folder.h"
#include "tests/gpu/gpu_fixture.h"

namespace limpid::test {
namespace {

class PipelineStoreTest : public GpuTest {};

TEST_F(PipelineStoreTest, DamagedFilesAreIgnored) {
    const image::test::TempFolder folder;
    const std::filesystem::path file = folder / "pipelines.bin";
    for (const std::string& content : {std::string(), std::string("12345678"), std::string(1000, 'x')}) {
        std::ofstream(file, std::ios::binary) << content;
        gpu::Device fresh({.select = wantedDevice()});
        EXPECT_NO_THROW(loadPipelines(fresh, file));
    }
    gpu::Device fresh({.select = wantedDevice()});
    EXPECT_NO_THROW(loadPipelines(fresh, folder / "missing.bin"));
    EXPECT_NO_THROW(loadPipelines(fresh, folder / ""));
}

TEST_F(PipelineStoreTest, DevicesAndDriversHaveFilesOfTheirOwn) {
    const std::filesystem::path file = pipelineFile(device());
    EXPECT_TRUE(file.empty() || file.is_absolute());
    EXPECT_EQ(file, pipelineFile(device()));
}

TEST_F(PipelineStoreTest, FoldersThatCannotBeWrittenAreIgnored) {
    EXPECT_NO_THROW(storePipelines(device(), "/proc/limpid/pipelines.bin"));
}

}  // namespace
}  // namespace limpid::test

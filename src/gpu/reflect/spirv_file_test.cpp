#include "gpu/reflect/spirv_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"

namespace limpid::gpu {
namespace {

using testing::HasSubstr;

class SpirvFile : public testing::Test {
  protected:
    std::string faultOf(const std::string& bytes) {
        std::ofstream(file_, std::ios::binary) << bytes;
        return faultOfFile(file_);
    }
    static std::string faultOfFile(const std::filesystem::path& file) {
        try {
            readSpirv(file);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }
    void TearDown() override { std::filesystem::remove(file_); }

    const std::filesystem::path file_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("limpid_spirv_file_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(SpirvFile, IsReadAsWords) {
    std::ofstream(file_, std::ios::binary) << std::string("\x03\x02\x23\x07\x00\x00\x00\x00", 8);
    EXPECT_EQ(readSpirv(file_), (std::vector<uint32_t>{0x07230203, 0}));
}

TEST_F(SpirvFile, MustBeThereAndHoldWords) {
    EXPECT_THAT(faultOfFile("/no/such/file.spv"), HasSubstr("/no/such/file.spv: cannot be read"));
    EXPECT_THAT(faultOf(""), HasSubstr("is no SPIR-V: 0 bytes"));
    EXPECT_THAT(faultOf("abcde"), HasSubstr("is no SPIR-V: 5 bytes"));
}

}  // namespace
}  // namespace limpid::gpu

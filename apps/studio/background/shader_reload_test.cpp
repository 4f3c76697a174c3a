#include "studio/background/shader_reload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>

#include "accumulate.comp.h"
#include "base/error.h"
#include "surfaces.comp.h"
#include "surfaces_buffers.comp.h"

namespace limpid::studio {
namespace {

namespace fs = std::filesystem;

TEST(ShaderReload, FindsWhatIsIncludedHoweverFar) {
    const fs::path source = fs::path(LIMPID_SOURCE_DIR) / "src";
    const std::vector<fs::path> files = includedFiles(source, source / "passes/pathtrace/pathtrace.comp");
    for (const char* name :
         {"passes/pathtrace/pathtrace_pixel.glsl", "shaders/common/rng.glsl", "shaders/common/camera.h"})
        EXPECT_NE(std::ranges::find(files, source / name), files.end()) << name;
}

TEST(ShaderReload, WithoutAFolderNothingIsWatched) {
    ShaderReload reload({});
    EXPECT_FALSE(reload.watches());
    EXPECT_FALSE(reload.poll({}));
    EXPECT_THROW(ShaderReload("/no/such/folder"), InputError);
}

/// A copy of one shader's sources that tests can modify.
class ShaderReloadInAFolder : public testing::Test {
  protected:
    void SetUp() override {
        const fs::path source = fs::path(LIMPID_SOURCE_DIR) / "src/passes/accumulate";
        fs::create_directories(folder / "passes/accumulate");
        for (const char* name : {"accumulate.comp", "accumulate_params.h"})
            fs::copy_file(source / name, folder / "passes/accumulate" / name,
                          fs::copy_options::overwrite_existing);
    }
    void TearDown() override { fs::remove_all(folder); }

    /// Saves the shader with `from` replaced. Its time is set `hours` into the future, so that it is newer
    /// than the last one.
    void save(const std::string& from, const std::string& to, int hours) const {
        const fs::path file = folder / "passes/accumulate/accumulate.comp";
        std::ifstream in(file);
        std::string text{std::istreambuf_iterator<char>(in), {}};
        const size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        std::ofstream(file) << text.replace(at, from.size(), to);
        fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::hours(hours));
    }

    const fs::path folder =
        fs::path(testing::TempDir()) /
        (std::string("limpid_reload_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    const std::vector<gpu::ShaderCode> used{shaders::accumulate_comp};
};

TEST_F(ShaderReloadInAFolder, CompilesAndReflectsWhatIsSaved) {
    ShaderReload reload(folder);
    EXPECT_FALSE(reload.poll(used)) << "nothing is saved yet";
    save("imageStore(after, at, mean)", "imageStore(after, at, mean + 1.0)", 1);
    const auto result = reload.poll(used);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, "");
    EXPECT_EQ(result->compiled, 1);
    const auto made = reload.replacements().find(shaders::accumulate_comp.name);
    ASSERT_NE(made, reload.replacements().end());
    EXPECT_TRUE(sameInterface(made->second->reflection, shaders::accumulate_comp.reflection));
    EXPECT_NE(made->second->hash, shaders::accumulate_comp.hash);
    EXPECT_FALSE(reload.poll(used)) << "nothing is saved since";
}

/// Of two variants of one file, as CMake compiles them (limpid_shader_variants).
TEST_F(ShaderReloadInAFolder, CompilesVariantsOfAShader) {
    const fs::path source = fs::path(LIMPID_SOURCE_DIR) / "src",
                   file = "denoise/stages/surfaces/surfaces.comp";
    std::vector<fs::path> needed = includedFiles(source, source / file);
    needed.push_back(source / file);
    for (const fs::path& path : needed) {
        const fs::path copy = folder / fs::relative(path, source);
        fs::create_directories(copy.parent_path());
        fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    }
    ShaderReload reload(folder);
    fs::last_write_time(folder / file, fs::file_time_type::clock::now() + std::chrono::hours(1));
    const auto result = reload.poll({shaders::surfaces_comp, shaders::surfaces_buffers_comp});
    ASSERT_TRUE(result);
    EXPECT_EQ(result->fault, "");
    EXPECT_EQ(result->compiled, 2);
}

TEST_F(ShaderReloadInAFolder, RefusesAnotherInterface) {
    ShaderReload reload(folder);
    save("binding = 3, rgba32f", "binding = 4, rgba32f", 1);
    const auto result = reload.poll(used);
    ASSERT_TRUE(result);
    EXPECT_NE(result->fault.find("declares other bindings"), std::string::npos) << result->fault;
    EXPECT_TRUE(reload.replacements().empty());
}

TEST_F(ShaderReloadInAFolder, SaysWhatReflectionRefuses) {
    ShaderReload reload(folder);
    save("binding = 3, rgba32f", "binding = 3, rgba16", 1);
    const auto result = reload.poll(used);
    ASSERT_TRUE(result);
    EXPECT_NE(result->fault.find("'after' needs one of the formats"), std::string::npos) << result->fault;
    EXPECT_TRUE(reload.replacements().empty());
}

}  // namespace
}  // namespace limpid::studio

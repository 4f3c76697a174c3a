#include "shader_reload.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"

namespace limpid::viewer {
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

}  // namespace
}  // namespace limpid::viewer

// Runs every input of tests/fuzz/corpus through the fuzz targets, in any build. The name states the expected
// result: "ok-..." is read, "bad-..." is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "base/files/file.h"
#include "base/log.h"
#include "targets.h"

namespace limpid::fuzz {
namespace {

namespace fs = std::filesystem;

struct Target {
    const char* name;
    bool (*run)(Bytes);
};
std::ostream& operator<<(std::ostream& out, const Target& target) {
    return out << target.name;
}

std::vector<fs::path> inputsOf(const Target& target) {
    std::vector<fs::path> files;
    for (const auto& entry :
         fs::directory_iterator(fs::path(LIMPID_SOURCE_DIR) / "tests/fuzz/corpus" / target.name))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

class Corpus : public testing::TestWithParam<Target> {
  protected:
    Corpus() { log::setLevel(log::Level::Error); }
    ~Corpus() override { log::setLevel(log::Level::Info); }
};

TEST_P(Corpus, IsReadOrRefusedAsItsNamesSay) {
    const std::vector<fs::path> files = inputsOf(GetParam());
    ASSERT_FALSE(files.empty());
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.filename());
        const std::string name = file.filename().string();
        const bool shouldRead = name.starts_with("ok-");
        ASSERT_TRUE(shouldRead || name.starts_with("bad-")) << "a name begins with ok- or bad-";
        EXPECT_LT(fs::file_size(file), 8192u) << "the corpus is kept small";
        const auto begin = std::chrono::steady_clock::now();
        try {
            EXPECT_EQ(GetParam().run(readFile(file)), shouldRead);
        } catch (const std::exception& error) {
            ADD_FAILURE() << "threw what is no InputError: " << error.what();
        }
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Corpus,
                         testing::Values(Target{"gltf", gltf}, Target{"obj", obj}, Target{"hdr", hdr},
                                         Target{"exr", exr}, Target{"png", png},
                                         Target{"checkpoint", checkpoint}, Target{"serve", serve}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace limpid::fuzz

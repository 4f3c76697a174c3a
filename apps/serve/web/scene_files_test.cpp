#include "serve/web/scene_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "base/error.h"

namespace limpid::serve {
namespace {

namespace fs = std::filesystem;

class SceneFilesTest : public testing::Test {
  protected:
    SceneFilesTest()
        : root_(fs::temp_directory_path() / ("limpid_scene_files." + std::to_string(::getpid()))),
          folder_(root_ / "scenes") {
        fs::create_directories(folder_ / "below");
        for (const char* file :
             {"secret.obj", "scenes/a.obj", "scenes/C.GLTF", "scenes/below/b.glb", "scenes/notes.txt"})
            std::ofstream(root_ / file) << "v 0 0 0\n";
        fs::create_symlink(root_ / "secret.obj", folder_ / "link.obj");
        fs::create_directory_symlink(root_, folder_ / "up");
        fs::create_directory(folder_ / "folder.obj");
    }
    ~SceneFilesTest() override { fs::remove_all(root_); }

    fs::path root_, folder_;
};

TEST_F(SceneFilesTest, ListsAndFindsScenesBelowTheFolder) {
    const SceneFiles files(folder_);
    const auto names = files.names();
    for (const char* name : {"a.obj", "C.GLTF", "below/b.glb", "builtin:cornell"}) {
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
        EXPECT_NO_THROW(files.find(name)) << name;
    }
    EXPECT_EQ(files.find("below/b.glb"), fs::canonical(folder_ / "below/b.glb").string());
    EXPECT_EQ(files.find("builtin:cornell"), "builtin:cornell");
    EXPECT_EQ(std::ranges::find(names, "notes.txt"), names.end());
    EXPECT_EQ(std::ranges::find(names, "up/secret.obj"), names.end());
}

TEST_F(SceneFilesTest, RefusesWhatIsOutside) {
    const SceneFiles files(folder_);
    for (const std::string& name :
         {std::string("../secret.obj"), std::string("below/../../secret.obj"),
          (root_ / "secret.obj").string(), (folder_ / "a.obj").string(), std::string("link.obj"),
          std::string("up/secret.obj"), std::string("notes.txt"), std::string("folder.obj"),
          std::string("missing.obj"), std::string(), std::string("builtin:no-such-scene"),
          std::string("builtin:../secret.obj"), std::string("a.obj\0.obj", 10),
          std::string(70000, 'a') + ".obj"})
        EXPECT_THROW(files.find(name), UsageError) << name.substr(0, 100);
}

TEST_F(SceneFilesTest, WithoutAFolderHasOnlyBuiltinScenes) {
    const SceneFiles files{fs::path()};
    EXPECT_TRUE(std::ranges::all_of(files.names(), [](const auto& n) { return n.starts_with("builtin:"); }));
    EXPECT_THROW(files.find("a.obj"), UsageError);
    EXPECT_THROW(SceneFiles(root_ / "none"), InputError);
}

}  // namespace
}  // namespace limpid::serve

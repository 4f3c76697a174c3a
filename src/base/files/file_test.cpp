#include "base/files/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "base/error.h"

namespace limpid {
namespace fs = std::filesystem;
namespace {

class FileTest : public testing::Test {
  protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / fs::path("limpid_file_test." + std::to_string(::getpid()));
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    static void put(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }
    static std::string get(const fs::path& path) {
        std::ifstream stream(path);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    size_t files() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
    }
    fs::path folder;
};

TEST_F(FileTest, ReplacesAnOutputOnlyWhenTheWriterSucceeds) {
    const fs::path out = folder / "a.txt";
    put(out, "old");
    EXPECT_THROW(writeAtomically(out,
                                 [](const fs::path& temporary) {
                                     put(temporary, "half");
                                     throw Error("stopped");
                                 }),
                 Error);
    EXPECT_EQ(get(out), "old");
    EXPECT_EQ(files(), 1u) << "the temporary file must be gone";
    writeAtomically(out, [](const fs::path& temporary) { put(temporary, "new"); });
    EXPECT_EQ(get(out), "new");
    EXPECT_EQ(files(), 1u);
    writeTextAtomically(out, "text\n");
    EXPECT_EQ(get(out), "text\n");
    EXPECT_EQ(files(), 1u);
    for (const bool wanted : {false, true}) {
        EXPECT_EQ(writeAtomicallyIf(out,
                                    [&](const fs::path& temporary) {
                                        put(temporary, "wanted");
                                        return wanted;
                                    }),
                  wanted);
        EXPECT_EQ(get(out), wanted ? "wanted" : "text\n");
        EXPECT_EQ(files(), 1u);
    }
}

TEST_F(FileTest, AFailedRenameLeavesNoTemporary) {
    const fs::path out = folder / "a.txt";
    try {
        writeAtomically(out, [&](const fs::path& temporary) {
            put(temporary, "new");
            fs::create_directory(out);  // a file cannot replace it
        });
        FAIL() << "a folder was replaced";
    } catch (const OutputError& error) {
        EXPECT_NE(std::string(error.what()).find("cannot be renamed into place"), std::string::npos)
            << error.what();
    }
    EXPECT_EQ(files(), 1u) << "the temporary file must be gone";
}

TEST_F(FileTest, OutputsHaveThePermissionsThatTheUmaskAllows) {
    const mode_t before = ::umask(027);
    writeTextAtomically(folder / "a.txt", "x");
    EXPECT_EQ(::umask(before), mode_t{027}) << "the umask belongs to the whole process";
    EXPECT_EQ(fs::status(folder / "a.txt").permissions(), static_cast<fs::perms>(0640));
}

TEST_F(FileTest, RefusesADirectoryAndAMissingFolderBeforeTheWriterRuns) {
    const auto never = [](const fs::path&) { FAIL() << "the writer ran"; };
    EXPECT_THROW(writeAtomically(folder, never), OutputError);
    EXPECT_THROW(writeAtomically(folder / "none" / "a.png", never), OutputError);
}

TEST_F(FileTest, MakesAFolderAndThoseItIsIn) {
    const fs::path made = folder / "a" / "b";
    makeFolder(made);
    EXPECT_TRUE(fs::is_directory(made));
    EXPECT_NO_THROW(makeFolder(made)) << "it is there already";
    EXPECT_NO_THROW(makeFolder(made.string() + "/"));
    put(folder / "file", "");
    EXPECT_THROW(makeFolder(folder / "file"), OutputError);
    EXPECT_THROW(makeFolder(folder / "file" / "a"), OutputError);
}

TEST_F(FileTest, FullDiskIsAnErrorAndNotATruncatedFile) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
    // /dev/full cannot be the target of a rename, so test the writer's side: a stream to a full disk must
    // throw.
    EXPECT_THROW(writeAtomically(folder / "a.txt",
                                 [](const fs::path&) {
                                     std::ofstream full("/dev/full");
                                     full.exceptions(std::ios::badbit | std::ios::failbit);
                                     full << "data" << std::flush;
                                 }),
                 std::exception);
    EXPECT_EQ(files(), 0u);
}

TEST_F(FileTest, ReadsAndRefuses) {
    put(folder / "a", "four");
    EXPECT_EQ(readFile(folder / "a").size(), 4u);
    EXPECT_THROW(readFile(folder / "a", 3), InputError);
    EXPECT_THROW(readFile(folder), InputError);
    EXPECT_THROW(readFile(folder / "none"), InputError);
}

TEST_F(FileTest, FollowsSymbolicLinksOfOutputs) {
    fs::create_directories(folder / "real");
    put(folder / "real" / "a.txt", "old");
    fs::create_symlink(fs::path("real") / "a.txt", folder / "inner.txt");
    fs::create_symlink(folder / "inner.txt", folder / "outer.txt");
    writeTextAtomically(folder / "outer.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "outer.txt"));
    EXPECT_TRUE(fs::is_symlink(folder / "inner.txt"));
    EXPECT_FALSE(fs::is_symlink(folder / "real" / "a.txt"));
    EXPECT_EQ(get(folder / "real" / "a.txt"), "new");
    fs::create_symlink(fs::path("real") / "b.txt", folder / "dangling.txt");
    writeTextAtomically(folder / "dangling.txt", "made");
    EXPECT_EQ(get(folder / "real" / "b.txt"), "made");
    EXPECT_THROW(writeAtomically(folder / "outer.txt", [](const fs::path&) { throw Error("stopped"); }),
                 Error);
    EXPECT_EQ(get(folder / "real" / "a.txt"), "new");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "real"), fs::directory_iterator()), 2);
    put(folder / "real" / ".a.Ab12xY.txt", "stale");
    removeStaleTemporaries(folder / "outer.txt");
    EXPECT_FALSE(fs::exists(folder / "real" / ".a.Ab12xY.txt"));
}

TEST_F(FileTest, RefusesLinksThatLeadNowhere) {
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    try {
        writeTextAtomically(folder / "a", "x");
        FAIL() << "a cycle of links was accepted";
    } catch (const OutputError& error) {
        EXPECT_NE(std::string(error.what()).find("is part of a cycle of symbolic links"), std::string::npos)
            << error.what();
    }
    fs::create_symlink(fs::path("none") / "c", folder / "c");
    EXPECT_THROW(checkWritable(folder / "c"), OutputError);
    fs::create_symlink(".", folder / "d");
    EXPECT_THROW(checkWritable(folder / "d"), OutputError);
}

TEST_F(FileTest, PipesAndDevicesAreNoFiles) {
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_EQ(irregularity(folder / "pipe"), "is not a regular file");
    EXPECT_EQ(irregularity("/dev/zero"), "is not a regular file");
    EXPECT_THROW(readFile(folder / "pipe"), InputError);
    EXPECT_THROW(writeTextAtomically(folder / "pipe", "x"), OutputError);
    EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
    put(folder / "file", "x");
    EXPECT_EQ(irregularity(folder / "file"), std::nullopt);
}

TEST_F(FileTest, KnowsWhenTwoNamesAreOneFile) {
    EXPECT_TRUE(isSameFile(folder / "a", folder / "." / "a")) << "neither is there yet";
    EXPECT_FALSE(isSameFile(folder / "a", folder / "b"));
    put(folder / "a", "x");
    fs::create_symlink("a", folder / "link");
    fs::create_symlink("b", folder / "dangling");
    EXPECT_TRUE(isSameFile(folder / "a", folder / "link"));
    EXPECT_TRUE(isSameFile(folder / "b", folder / "dangling"));
    EXPECT_FALSE(isSameFile(folder / "a", folder / "b"));
    EXPECT_FALSE(isSameFile(folder / "none" / "a", folder / "a"));
}

TEST_F(FileTest, RemovesOnlyItsOwnStaleTemporaries) {
    for (const char* name : {".a.Ab12xY.txt", ".a.Ab12x.txt", ".a.Ab12xYz.txt", ".b.Ab12xY.txt",
                             ".a.Ab12xY.exr", "a.Ab12xY.txt", "a.txt", ".a.Ab1.xY.txt"})
        put(folder / name, "x");
    fs::create_directories(folder / ".a.folder.txt");
    removeStaleTemporaries(folder / "a.txt");
    EXPECT_FALSE(fs::exists(folder / ".a.Ab12xY.txt"));
    EXPECT_EQ(files(), 8u);
    removeStaleTemporaries(folder / "no" / "such.txt");  // does nothing
    EXPECT_NO_THROW(writeAtomically(folder / "a.txt", [&](const fs::path& temporary) {
        EXPECT_TRUE(fs::exists(temporary));
        removeStaleTemporaries(folder / "a.txt");
        EXPECT_FALSE(fs::exists(temporary)) << "temporaries have another name than was thought";
        put(temporary, "new");
    }));
}

}  // namespace
}  // namespace limpid

// Tests files that are no scene, files that a scene refers to, and environments: what is malformed is
// rejected with its name and fault, in bounded time and memory. gltf/gltf_bad_input_test.cpp,
// obj/obj_bad_input_test.cpp and random_damage_test.cpp go on. Run with sanitizers (LIMPID_SANITIZE) to
// detect out-of-bounds accesses.
#include "scene/load/bad_input_test.h"

#include "scene/lights/environment.h"
#include "scene/load/scene_files.h"

namespace limpid::scene::test {
namespace {

TEST_F(BadInput, WhatIsNoSceneFileAtAll) {
    for (const char* name : {"none.gltf", "none.glb", "none.obj"})
        expectRefused(folder / name, "does not exist");
    for (const char* name : {"empty.gltf", "empty.glb", "empty.obj"})
        expectRefused(write(name, ""), "is empty");
    for (const char* name : {"folder.gltf", "folder.obj"}) {
        fs::create_directory(folder / name);
        expectRefused(folder / name, "is a directory");
    }
    expectRefused(write("scene.fbx", "x"), "not a supported scene format");
    expectRefused(write("scene", "x"), "not a supported scene format");
    expectRefused(write("scene.gltf", "{"), "not valid JSON");
    expectRefused(write("scene.gltf", "[]"), "no object");
    expectRefused(write("scene.gltf", "{}"), "asset");
    expectRefused(write("scene.gltf", R"({"asset": {"version": "1.0"}})"), "version");
    expectRefused(write("scene.gltf", "\xff\xfe"), "begins with ff fe, as UTF-16 text does");
    expectRefused(write("scene.glb", "GLTF\x02"),
                  "is neither GLB nor a glTF document: it begins with 47 4c 54 46");
    expectRefused(write("scene.glb", "PK\x03\x04"), "as a ZIP archive does");
    expectRefused(write("scene.gltf", "version https://git-lfs.github.com/spec/v1\n"), "a Git LFS pointer");
    expectRefused(write("scene.gltf", R"({"asset": {"version": "2.0"}})"), "no triangles");
    expectRefused(write("scene.gltf", R"({"asset": {"version": 2}})"), "asset.version: is not a text");
}

TEST_F(BadInput, MissingOrShortBuffersAndImages) {
    GltfFile file = triangle();
    const fs::path path = file.save(folder);
    fs::remove(folder / "scene.bin");
    expectRefused(path, "'scene.bin', which does not exist");
    put(folder / "scene.bin", "short");
    expectRefused(path, "buffers[0]: has 5 bytes of the 36");
    fs::remove(folder / "scene.bin");
    fs::create_directory(folder / "scene.bin");
    expectRefused(path, "is a directory");
    fs::remove(folder / "scene.bin");

    GltfFile rich = richFile(folder);
    expectFault(rich, "images[0]: has neither",
                [](GltfFile& f) { f.document["images"][0] = json::object(); });
}

TEST_F(BadInput, ImagesThatCannotBeHadAreNamedAndPlain) {
    const auto expectPlain = [&](const std::string& fault, const std::function<void(GltfFile&)>& change) {
        GltfFile file = richFile(folder);
        change(file);
        const fs::path path = file.save(folder);
        const Scene scene = loadWarned(path, fault);
        EXPECT_TRUE(scene.textures.empty());
        EXPECT_FALSE(scene.materials.at(0).baseColorTexture || scene.materials[0].normalTexture);
    };
    const auto expectUri = [&](const std::string& uri, const std::string& fault) {
        expectPlain(fault, [&](GltfFile& f) { f.document["images"][0]["uri"] = uri; });
    };
    expectUri("none.png", "scene.gltf: refers to 'none.png', which does not exist");
    expectUri("../none.png", "'../none.png', which lies outside the scene's folder");
    expectUri("/etc/passwd", "absolute");
    expectUri("http://localhost/a.png", "relative");
    expectUri("data:image/png;base64,$$", "base64");
    expectUri("data:image/png,$$", "base64");
    expectPlain("has no image", [](GltfFile& f) { f.document["textures"][0].erase("source"); });
    const auto expectContent = [&](const std::string& content) {
        expectPlain("a.png", [&](GltfFile&) { put(folder / "a.png", content); });
    };
    richFile(folder);
    const std::string png = get(folder / "a.png");
    expectContent("");
    expectContent("this is no image");
    expectContent(png.substr(0, png.size() / 2));
    std::string huge = png;
    huge[16] = huge[20] = '\x7f';  // 2 billion pixels wide and high
    expectContent(huge);
    // glTF does not support TGA.
    expectContent(tgaOf(1, 1, {1, 2, 3}));
}

TEST_F(BadInput, AnEmissiveImageThatCannotBeHadSwitchesTheEmissionOff) {
    GltfFile file = richFile(folder);
    file.document["materials"][0]["emissiveTexture"] = {{"index", 0}};
    EXPECT_EQ(loadScene(file.save(folder)).materials.at(0).emission, vec3(1.0f));
    fs::remove(folder / "a.png");
    EXPECT_EQ(loadWarned(file.save(folder), "a.png").materials.at(0).emission, vec3(0.0f));
}

TEST_F(BadInput, BuffersThatLeaveTheFolder) {
    const fs::path inner = folder / "inner";
    fs::create_directory(inner);
    const std::string bytes(36, '\0');
    put(folder / "outside.bin", bytes);
    put(inner / "inside.bin", bytes);
    fs::create_symlink(folder / "outside.bin", inner / "link.bin");
    fs::create_directory_symlink(folder, inner / "up");
    const auto expectUri = [&](const std::string& uri, const std::string& fault) {
        GltfFile file = triangle();
        file.finishBuffer(uri.c_str());
        put(inner / "scene.gltf", file.document.dump());
        expectRefused(inner / "scene.gltf", fault);
    };
    const std::string absolute = (folder / "outside.bin").string();
    for (const char* uri : {"../outside.bin", "%2e%2e/outside.bin", "x/../../outside.bin", "..\\outside.bin",
                            "link.bin", "up/outside.bin"}) {
        expectUri(uri, "lies outside the scene's folder");
    }
    expectUri(absolute, "absolute");
    for (const std::string& uri :
         {"file://" + absolute, std::string("http://localhost/a.bin"), std::string("C:/a.bin")}) {
        expectUri(uri, "relative path");
    }
    expectUri("a%00.bin", "null character");
    expectUri("", "empty name");
    expectUri(".", "directory");
    expectUri(std::string(100'000, 'a'), "too long");

    const SceneFiles files(inner / "scene.gltf");
    EXPECT_NO_THROW(files.resolve("x/../inside.bin"));
    EXPECT_NO_THROW(files.resolve("./inside.bin"));
}

TEST_F(BadInput, TheAssetRootBoundsWhatMayBeRead) {
    const fs::path outer = folder / "outer", root = outer / "root", inner = root / "inner";
    fs::create_directories(inner);
    fs::create_directories(root / "textures");
    put(outer / "secret.bin", "x");
    put(root / "textures" / "wood.bin", "x");
    put(inner / "own.bin", "x");
    fs::create_directory_symlink("../textures", inner / "linked");
    fs::create_symlink(root / "textures" / "wood.bin", inner / "wood-link.bin");
    fs::create_symlink(outer / "secret.bin", inner / "secret-link.bin");
    fs::create_symlink("secret-link.bin", inner / "link-to-link.bin");
    const SceneFiles files(inner / "scene.obj", root);
    for (const char* name : {"own.bin", "../textures/wood.bin", "..\\textures\\wood.bin", "linked/wood.bin",
                             "wood-link.bin", "../inner/own.bin", "linked/../inner/own.bin"})
        EXPECT_TRUE(fs::is_regular_file(files.resolve(name))) << name;
    for (const char* name :
         {"../../secret.bin", "secret-link.bin", "link-to-link.bin", "linked/../../secret.bin",
          "../../root-beside/a.bin", "../..", "../../none/../secret.bin"}) {
        try {
            files.resolve(name);
            ADD_FAILURE() << name << " was accepted";
        } catch (const InputError& refusal) {
            EXPECT_NE(std::string(refusal.what()).find("outside the asset root"), std::string::npos)
                << refusal.what();
        }
    }
    // Files in the scene's own folder are allowed whatever the root is, and without a root only those.
    EXPECT_NO_THROW(SceneFiles(inner / "scene.obj", root / "textures").resolve("own.bin"));
    EXPECT_THROW(SceneFiles(inner / "scene.obj").resolve("linked/wood.bin"), InputError);
    EXPECT_THROW(SceneFiles(inner / "scene.obj", root / "none"), InputError);
    EXPECT_THROW(SceneFiles(inner / "scene.obj", inner / "own.bin"), InputError);
}

TEST_F(BadInput, TheDefaultAssetRootIsTheFolderAboveUnlessThatHoldsHomes) {
    const fs::path own = fs::canonical(folder);
    const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
    const auto rootWithHome = [&](const fs::path& value, const fs::path& scene) {
        ::setenv("HOME", value.c_str(), 1);
        return defaultAssetRoot(scene);
    };
    fs::create_directories(own / "homes" / "user" / "models");
    const fs::path scene = own / "homes" / "user" / "a.obj",
                   model = own / "homes" / "user" / "models" / "a.obj";
    EXPECT_EQ(rootWithHome("/elsewhere/user", scene), own / "homes");
    EXPECT_EQ(rootWithHome(own / "homes" / "user", scene), own / "homes" / "user") << "above are all homes";
    EXPECT_EQ(rootWithHome(own / "homes" / "user", model), own / "homes" / "user");
    EXPECT_EQ(rootWithHome(own / "homes" / "deep" / "user", scene), own / "homes" / "user");
    EXPECT_EQ(rootWithHome("", "/a.obj"), "/");
    EXPECT_EQ(rootWithHome("", "/folder/a.obj"), "/folder");
    EXPECT_EQ(rootWithHome("", "/home/user/a.obj"), "/home/user");
    EXPECT_EQ(rootWithHome("", "/home/user/models/a.obj"), "/home/user");
    ::setenv("HOME", home.c_str(), 1);
}

TEST_F(BadInput, RelativeSceneNamesWork) {
    const fs::path before = fs::current_path();
    triangle().save(folder);
    fs::current_path(folder);
    EXPECT_EQ(loadScene("scene.gltf").triangleCount(), 1u);
    fs::current_path(before);
}

TEST_F(BadInput, Environments) {
    EXPECT_THROW(loadEnvironment(folder / "none.hdr"), InputError);
    EXPECT_THROW(loadEnvironment(folder), InputError);
    EXPECT_THROW(loadEnvironment(write("a.jpg", "x")), InputError);
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    for (const std::string& content :
         {std::string(), std::string("#?RADIANCE\n"), header, header + "-Y 2 +X 2\n",
          header + "-Y 2 +X 2\n1234", header + "-Y -2 +X 2\n", header + "-Y 1000000 +X 1000000\n1234",
          header + "-Y 99999999999 +X 1\n"}) {
        EXPECT_THROW(loadEnvironment(write("a.hdr", content)), InputError) << content;
        EXPECT_THROW(loadEnvironment(write("a.exr", content)), InputError) << content;
    }
}

}  // namespace
}  // namespace limpid::scene::test

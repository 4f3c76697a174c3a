// Tests the command line as users and scripts use it: exit codes, messages, and outputs that survive
// failures.
#include <nlohmann/json.hpp>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

constexpr const char* tiny = " --width 32 --height 18 --spp 1 --device cpu ";

TEST_F(CliTest, WrongUsageIsExitCode2) {
    expect("", 2, "subcommand");
    expect("render builtin:cornell", 2, "--output");
    expect("render builtin:nothing -o " + path("a.png") + tiny, 2, "builtin:cornell");
    expect("render builtin:cornell -o " + path("a.bmp") + tiny, 2, ".exr or .png");
    expect("render builtin:cornell -o " + path("a.png") + " --width 0", 2, "--width");
    expect("render builtin:cornell -o " + path("a.png") + " --width 99999999999", 2, "--width");
    // Found before the scene is loaded, and the second one by the device.
    expect("render none.gltf -o " + path("a.png") + " --width 65535 --height 65535", 2, "at most 268435456");
    expect("render none.gltf -o " + path("a.png") + " --width 65535 --height 1 --device cpu", 2, " a side");
    expect("render none.gltf -o " + path("a.png") + " --width 16384 --height 16384 --device cpu", 2,
           " in an image");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--set pathtrace.max_depth=x", 2,
           "whole number");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--set pathtrace.max_depth=-1", 2,
           "outside its range");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--set no.such=1", 2, "no.such");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--camera 7", 2, "its cameras are");
    expect("render builtin:cornell -o " + path("a.exr") + tiny + "--aov nonsense", 2, "the layers are");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--exposure nan", 2,
           "neither 'auto' nor a number of stops from -60 to 60");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--dump none", 2, "its passes are");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--env a.hdr --background 1,1,1", 2,
           "give one of them");
    expect("render builtin:cornell -o " + path("a.png") + tiny + "--float", 2, "--float needs an .exr");
    for (const std::string option : {"--max-depth ", "--set pathtrace.max_depth="}) {
        const std::string deep = "render builtin:cornell -o " + path("a.png") + tiny + option + "2 ";
        for (const char* integrator : {"ao", "gbuffer", "preview"})
            expect(deep + "--integrator " + integrator, 2, " is for --integrator path and direct");
        expect(deep + "--integrator direct", 2, "--integrator direct has one bounce");
    }
    for (const char* camera : {"--camera 0", "--eye 0,1,3 --target 0,1,0", "--fov 40"})
        expect("render builtin:cornell -o " + path("a.png") + tiny + "--camera-path p.json " + camera, 2,
               "has its own cameras");
}

/// The background is only black if the user asks for it.
TEST_F(CliTest, DarkScenesGetASkyUnlessABackgroundIsChosen) {
    put("plate.obj", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 4 3 2 1\n");
    const std::string render = "render " + path("plate.obj") + " -o " + path("a.png") + tiny;
    const std::string message = "a soft sky was added";
    expect(render, 0, message);
    expect(render + "--light point,0,-2,0,5", 0, message);
    for (const char* light : {"--background 0,0,0", "--background 0.2,0.2,0.2", "--light point,0,2,0,5"}) {
        const Result result = run(render + light);
        EXPECT_EQ(result.code, 0) << result.output;
        EXPECT_EQ(result.output.find(message), std::string::npos) << light << result.output;
    }
}

TEST_F(CliTest, UnreadableInputIsExitCode3AndNamesFileAndFault) {
    expect("render " + path("none.gltf") + " -o " + path("a.png") + tiny, 3, "none.gltf");
    put("broken.gltf", "{\"asset\": ");
    expect("render " + path("broken.gltf") + " -o " + path("a.png") + tiny, 3, "broken.gltf");
    put("empty.glb", "");
    expect("render " + path("empty.glb") + " -o " + path("a.png") + tiny, 3, "empty.glb");
    put("no_triangles.gltf", "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[]}]}");
    expect("render " + path("no_triangles.gltf") + " -o " + path("a.png") + tiny, 3, "no_triangles.gltf");
    put("scene.fbx", "x");
    expect("render " + path("scene.fbx") + " -o " + path("a.png") + tiny, 3, "scene.fbx");
    put("bad.hdr", "#?RADIANCE\n");
    expect("render builtin:cornell --env " + path("bad.hdr") + " -o " + path("a.png") + tiny, 3, "bad.hdr");
    expect("compare " + path("x.exr") + " " + path("y.exr"), 3, "x.exr");
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

/// The faults are only found after the warnings.
TEST_F(CliTest, ALookThatTheOutputDoesNotHaveIsWarnedOf) {
    const auto outputOf = [&](const std::string& rest) {
        const Result result = run("render " + path("none.gltf") + tiny + "-o " + path(rest));
        EXPECT_EQ(result.code, 3) << result.output;
        EXPECT_NE(result.output.find("none.gltf"), std::string::npos) << result.output;
        return result.output;
    };
    const auto expectWarning = [&](const std::string& rest, const std::string& part) {
        const std::string output = outputOf(rest);
        EXPECT_NE(output.find(part), std::string::npos) << output;
    };
    expectWarning("a.exr --exposure 1", "--exposure has no effect: an .exr is linear");
    expectWarning("a.%d.exr --tone-curve agx", "--tone-curve has no effect: an .exr is linear");
    expectWarning("a.png --exposure 1 --integrator ao", "the values of --integrator ao are shown");
    expectWarning("a.exr --exposure 1 --tone-curve agx", "--exposure and --tone-curve have no effect");
    for (const std::string used :
         {"a.exr --exposure 1 --preview", "a.sums --shard 1/2 --exposure 1", "a.exr"})
        EXPECT_EQ(outputOf(used).find(" no effect"), std::string::npos) << used;
    // 'limpid merge' uses them.
    const std::string checkpoint = " --checkpoint " + path("a.ck");
    for (const std::string used : {"a.exr --exposure 1", "a.png --float"})
        EXPECT_EQ(outputOf(used + checkpoint).find(" no effect"), std::string::npos) << used;
}

TEST_F(CliTest, AnOutputThatCannotBeWrittenIsExitCode1) {
    fs::create_directories(folder_ / "folder.png");
    expect("render builtin:cornell -o " + path("folder.png") + tiny, 1, "is a directory");
    expect("render builtin:cornell -o " + path("no/such/a.png") + tiny, 1, "does not exist");
}

TEST_F(CliTest, AFailedRunLeavesTheOldOutputAlone) {
    put("a.png", "old");
    expect("render " + path("none.gltf") + " -o " + path("a.png") + tiny, 3, "none.gltf");
    EXPECT_EQ(get("a.png"), "old");
}

TEST_F(CliTest, AFileSizeLimitActsLikeAFullDisk) {
    put("a.exr", "old");
    // Ignores SIGXFSZ, so that the write fails as on a full disk.
    const std::string inner =
        std::string("trap \"\" XFSZ; ulimit -f 1; exec \"") + LIMPID_PROGRAM +
        "\" render builtin:cornell --width 256 --height 144 --spp 1 --device cpu --aov all -o " +
        path("a.exr");
    const int status = std::system(("bash -c '" + inner + "' >/dev/null 2>&1").c_str());
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_EQ(get("a.exr"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
        << "no temporary file stays";
}

TEST_F(CliTest, RendersComparesAndReports) {
    const std::string options = " --width 64 --height 36 --spp 4 --device cpu --json";
    const Result render = run("render builtin:cornell --float --aov all -o " + path("a.exr") + options);
    ASSERT_EQ(render.code, 0) << render.output;
    EXPECT_NE(render.output.find("\"rejected_samples\": 0"), std::string::npos) << render.output;
    ASSERT_EQ(run("render builtin:cornell --float --aov all -o " + path("b.exr") + options).code, 0);
    EXPECT_EQ(get("a.exr"), get("b.exr")) << "same seed, same device, same options: the same bits";
    const Result same = run("compare " + path("a.exr") + " " + path("b.exr") + " --json");
    EXPECT_EQ(same.code, 0);
    EXPECT_NE(same.output.find("\"flip\":0.0"), std::string::npos) << same.output;
    ASSERT_EQ(run("render builtin:cornell --seed 1 -o " + path("c.png") + options).code, 0);
    EXPECT_EQ(run("compare " + path("c.png") + " " + path("a.exr") + " --error-map " + path("e.png")).code,
              0);
    EXPECT_TRUE(fs::exists(folder_ / "e.png"));
}

/// A triangle, two cameras, and two clips that move it.
constexpr const char* sceneWithCameras = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}],
  "nodes": [{"mesh": 0}, {"camera": 0, "name": "front \u001b[2J", "translation": [0.3, 0.3, 2]},
            {"camera": 1, "name": "top", "translation": [0.1, 0.2, 1]}],
  "cameras": [{"type": "perspective", "name": "front \u001b[2J",
               "perspective": {"yfov": 0.7853982, "znear": 0.1}},
              {"type": "orthographic", "name": "top", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
  "buffers": [{"byteLength": 68, "uri": "scene.bin"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8},
                  {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                 "max": [1, 1, 0]},
                {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2]},
                {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
  "animations": [
    {"name": "move", "samplers": [{"input": 1, "output": 2}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]},
    {"name": "shrink", "samplers": [{"input": 1, "output": 2}],
     "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}]}]})";

TEST_F(CliTest, ALensNeedsADistanceAndRaysOfItsOwn) {
    const std::string render =
        "render builtin:cornell -o " + path("a.exr") + " --width 16 --height 8 --spp 2 ";
    put("scene.gltf", sceneWithCameras);
    const float floats[17] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0.5f};
    put("scene.bin", std::string(reinterpret_cast<const char*>(floats), sizeof floats));
    const std::string own =
        "render " + path("scene.gltf") + " -o " + path("a.exr") + " --width 16 --height 8 --spp 2 ";
    expect(own + "--f-stop 2.8", 2, "needs --focus-distance");
    expect(own + "--camera top --f-stop 2.8 --focus-distance 1", 2, "is orthographic");
    EXPECT_EQ(run(own + "--f-stop 2.8 --focus-distance 2").code, 0);
    expect(render + "--f-stop 2.8 --lens-diameter 0.1 --focus-distance 3", 2, "say the same");
    expect(render + "--focus-distance 3", 2, "goes with --f-stop");
    expect(render + "--sensor-height 30", 2, "goes with --f-stop");
    expect(render + "--eye 0,1,3 --target 0,1,0 --fov 40 --focal-length 35", 2, "say the same");
    for (const char* method :
         {"--integrator ao", "--integrator gbuffer", "--denoiser svgf", "--denoiser temporal"})
        expect(render + "--f-stop 2.8 --focus-distance 3 " + method, 2, "a lens is ");
    put("path.json",
        R"({"keys": [{"time": 0, "eye": [0, 1, 3], "target": [0, 1, 0], "lens_diameter": 0.1}]})");
    expect(render + "--denoiser svgf --camera-path " + path("path.json"), 2, "a lens is ");
    EXPECT_EQ(run(render + "--denoiser svgf --lens-diameter 0 --camera-path " + path("path.json")).code, 0);
    EXPECT_EQ(run(render + "--f-stop 2.8 --focus-distance 3").code, 0);
    EXPECT_EQ(run(render + "--f-stop 1.4 --focal-length 35 --eye 0,1,3 --target 0,1,0").code, 0);
}

TEST_F(CliTest, InfoListsWhatASceneHoldsAndWhatItListsCanBeChosen) {
    put("scene.gltf", sceneWithCameras);
    const float floats[17] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0.5f};
    put("scene.bin", std::string(reinterpret_cast<const char*>(floats), sizeof floats));
    const std::string scene = path("scene.gltf");

    const Result text = run("info " + scene);
    EXPECT_EQ(text.code, 0) << text.output;
    for (const char* part : {"'front \\x1b[2J'", "perspective, fov 45.0 degrees", "'top'",
                             "orthographic, 2 high", "'move'", "2.00 s", "1 triangles"})
        EXPECT_NE(text.output.find(part), std::string::npos) << part << "\n" << text.output;
    EXPECT_EQ(text.output.find('\x1b'), std::string::npos);

    const Result report = run("info " + scene + " --json 2>/dev/null");
    const auto json = nlohmann::json::parse(report.output.substr(report.output.find('{')));
    ASSERT_EQ(json["cameras"].size(), 2u);
    EXPECT_EQ(json["cameras"][0]["type"], "perspective");
    EXPECT_NEAR(json["cameras"][0]["fov"].get<double>(), 45.0, 1e-3);
    EXPECT_EQ(json["cameras"][1]["name"], "top");
    EXPECT_EQ(json["animations"].size(), 2u);
    EXPECT_EQ(json["triangles"], 1);

    const std::string render = "render " + scene + tiny + "-o ";
    for (const char* index : {"0", "1"}) {
        const std::string name = json["cameras"][index[0] - '0']["name"];
        ASSERT_EQ(run(render + path("index.exr") + " --camera " + index).code, 0);
        ASSERT_EQ(run(render + path("name.exr") + " --camera '" + name + "'").code, 0);
        EXPECT_EQ(get("index.exr"), get("name.exr")) << name;
        put(std::string(index) + ".exr", get("index.exr"));
    }
    EXPECT_NE(get("0.exr"), get("1.exr"));
    expect(render + path("a.exr") + " --camera 2", 2, "1 'top'");

    // Each clip alone, both together and no clip give different pictures.
    for (const char* clip : {"none", "0", "shrink", "all"})
        ASSERT_EQ(run(render + path(std::string(clip) + ".exr") + " --time 1 --animation " + clip).code, 0);
    EXPECT_NE(get("all.exr"), get("0.exr"));
    EXPECT_NE(get("all.exr"), get("shrink.exr"));
    EXPECT_NE(get("all.exr"), get("none.exr"));
}

TEST_F(CliTest, InfoListsWhatThereIs) {
    const Result info = run("info --json");
    EXPECT_EQ(info.code, 0);
    for (const char* part : {"pathtrace.max_depth", "builtin:heavy", "\"devices\"", "\"layers\""}) {
        EXPECT_NE(info.output.find(part), std::string::npos) << part;
    }
    EXPECT_EQ(run("--help").code, 0);
    for (const char* command : {"render", "compare", "bench", "info"}) {
        EXPECT_EQ(run(std::string(command) + " --help").code, 0) << command;
    }
}

}  // namespace
}  // namespace limpid

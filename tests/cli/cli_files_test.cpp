// Tests unusual numbers, names and kinds of files on the command line.
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

constexpr const char* tiny = " --width 32 --height 18 --spp 1 --device cpu ";
constexpr const char* triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class CliFilesTest : public CliTest {
  protected:
    std::string pipe(const std::string& name) const {
        ::mkfifo((folder_ / name).c_str(), 0600);
        return path(name);
    }
    /// A program that waits for a pipe is stopped, and the test fails.
    static void expectSoon(const std::string& arguments, int code, const std::string& part) {
        const Result result = runProgram(std::string("timeout 20 '") + LIMPID_PROGRAM + "' " + arguments);
        EXPECT_EQ(result.code, code) << arguments << "\n" << result.output;
        EXPECT_NE(result.output.find(part), std::string::npos) << arguments << "\n" << result.output;
    }
};

TEST_F(CliFilesTest, NumbersThatAreNotFiniteAreWrongUsage) {
    const std::string render = "render builtin:cornell -o " + path("a.png") + tiny;
    for (const char* value : {"nan", "-nan", "inf", "-inf", "1e999"}) {
        for (const char* option : {"--fov", "--time", "--fps", "--time-limit", "--exposure"})
            expect(render + option + " " + value, 2, option);
        expect(render + "--eye 0," + value + ",0 --target 0,0,0", 2, "--eye");
        expect(render + "--eye 0,0,1 --target " + value + ",0,0", 2, "--target");
        expect(render + "--set ao.radius=" + value, 2, "ao.radius");
        expect(render + "--light point,0,0,0," + value, 2, "light");
        expect(render + "--background 0,0," + value, 2, "background");
        expect("view builtin:cornell --eye 0,0," + std::string(value) + " --target 0,0,0", 2, "--eye");
    }
    expect(render + "--eye 0,0,1e39 --target 0,0,0", 2, "--eye");
    expect("compare a.exr b.exr --exposure nan", 2, "--exposure");
    EXPECT_FALSE(fs::exists(folder_ / "a.png"));
}

TEST_F(CliFilesTest, ANameThatIsNotUtf8DoesNotBreakJson) {
    const std::string scene = "sc\xff.obj";
    put(scene, triangle);
    const Result result = run("render '" + path(scene) + "' --json -o '" + path("\xe4.exr") + "'" + tiny);
    ASSERT_EQ(result.code, 0) << result.output;
    const auto report = nlohmann::json::parse(result.output.substr(result.output.find('{')));
    EXPECT_NE(report["output"].get<std::string>().find("\xEF\xBF\xBD.exr"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder_ / "\xe4.exr"));
}

TEST_F(CliFilesTest, ControlCharactersOfANameDoNotReachTheTerminal) {
    const std::string name = "a\x1b[2J\nerror: b\r.obj";
    const auto expectEscaped = [](const std::string& arguments, int code) {
        const Result result = run(arguments);
        EXPECT_EQ(result.code, code) << result.output;
        EXPECT_EQ(result.output.find_first_of("\x1b\r"), std::string::npos) << result.output;
        EXPECT_NE(result.output.find("\\x1b[2J"), std::string::npos) << result.output;
    };
    expectEscaped("render '" + path(name) + "' -o " + path("a.png") + tiny, 3);
    expectEscaped("render builtin:cornell -o '" + path(name) + "'" + tiny, 2);
    expectEscaped("render builtin:cornell -o " + path("a.png") + " --width '" + name + "'", 2);
    put(name, "v 0 0 0\n");
    expectEscaped("render '" + path(name) + "' -o " + path("a.png") + tiny, 3);
}

TEST_F(CliFilesTest, PipesAndDevicesAreNoInputsAndNoOutputs) {
    const std::string out = " -o " + path("a.png") + tiny;
    const std::string fault = "is not a regular file";
    expectSoon("render " + pipe("p.obj") + out, 3, fault);
    expectSoon("render builtin:cornell --env " + pipe("p.hdr") + out, 3, fault);
    expectSoon("render builtin:cornell --env " + pipe("p.exr") + out, 3, fault);
    expectSoon("render builtin:cornell --camera-path " + pipe("p.json") + out, 3, fault);
    expectSoon("render builtin:cornell --denoiser kpcn --weights " + pipe("p.safetensors") + out, 3, fault);
    expectSoon("render builtin:cornell --resume --checkpoint " + pipe("p.ck") + out, 3, fault);
    expectSoon("compare " + path("p.exr") + " " + path("p.exr"), 3, fault);
    expectSoon("compare /dev/zero /dev/zero", 3, fault);
    expectSoon("merge " + pipe("p.sums") + " -o " + path("a.png"), 3, fault);
    expectSoon("serve builtin:cornell --certificate " + pipe("p.pem") + " --key " + path("p.pem"), 3, fault);
    pipe("f.0000.exr");
    expectSoon("denoise " + path("f.%04d.exr") + " --denoiser svgf --device cpu -o " + path("g.%04d.exr"), 3,
               fault);
    expectSoon("render builtin:cornell -o " + path("p.exr") + tiny, 1, fault);
    EXPECT_TRUE(fs::is_fifo(folder_ / "p.exr"));
}

TEST_F(CliFilesTest, ACheckpointIsNoOutput) {
    const std::string render = std::string("render builtin:cornell") + tiny;
    expect(render + "-o " + path("a.exr") + " --checkpoint " + path("./a.exr"), 2, "must be two files");
    expect(render + "--frames 2 -o " + path("a.%02d.exr") + " --checkpoint " + path("a.01.exr"), 2,
           "a.01.exr");
    fs::create_symlink("a.exr", folder_ / "link.ck");
    expect(render + "-o " + path("a.exr") + " --checkpoint " + path("link.ck"), 2, "must be two files");
    EXPECT_EQ(run(render + "-o " + path("a.exr") + " --checkpoint " + path("a.ck")).code, 0);
}

TEST_F(CliFilesTest, AnEnvironmentMapIsNoOutput) {
    const std::string render = std::string("render builtin:cornell") + tiny;
    ASSERT_EQ(run(render + "-o " + path("sky1.exr")).code, 0);
    const std::string sky = get("sky1.exr"), with = render + "--env " + path("sky1.exr") + " -o ";
    expect(with + path("./sky1.exr"), 2, "which would replace it");
    expect(with + path("sky%d.exr") + " --frames 3", 2, "which would replace it");
    EXPECT_EQ(get("sky1.exr"), sky);
    EXPECT_EQ(run(with + path("a.exr")).code, 0);
}

TEST_F(CliFilesTest, AFileOfTheSceneIsNoOutput) {
    put("a.obj", std::string("mtllib a.mtl\nusemtl m\n") + triangle);
    const std::string render = "render " + path("a.obj") + tiny + "-o ";
    // The texture's own picture, and one that is a link to it.
    put("a.mtl", "newmtl m\nmap_Kd wood1.png\n");
    ASSERT_EQ(run(std::string("render builtin:cornell") + tiny + "-o " + path("wood1.png")).code, 0);
    fs::create_symlink("wood1.png", folder_ / "link.png");
    fs::copy_file(folder_ / "wood1.png", folder_ / "b.preview.png");
    const std::string wood = get("wood1.png"), fault = "is a file of the scene";
    for (const char* output : {"wood1.png", "./wood1.png", "link.png"})
        expect(render + path(output), 2, fault);
    expect(render + path("wood%d.png") + " --frames 3", 2, fault);
    EXPECT_EQ(run(render + path("wood%d.png") + " --frames 1").code, 0) << "which is frame 0";
    EXPECT_EQ(get("wood1.png"), wood);
    put("a.mtl", "newmtl m\nmap_Kd b.preview.png\n");
    expect(render + path("b.exr") + " --preview", 2, fault);
    EXPECT_EQ(run(render + path("b.exr")).code, 0);
    EXPECT_EQ(run(render + path("wood1.png")).code, 0) << "it is no texture any more";
    // Whatever its name is.
    put("a.mtl.exr", "newmtl m\n");
    put("a.obj", std::string("mtllib a.mtl.exr\n") + triangle);
    expect(render + path("a.mtl.exr"), 2, fault);
}

TEST_F(CliFilesTest, AnOutputThatIsASymbolicLinkIsFollowed) {
    fs::create_directories(folder_ / "there");
    put("there/real.png", "old");
    fs::create_symlink("there/real.png", folder_ / "link.png");
    ASSERT_EQ(run("render builtin:cornell -o " + path("link.png") + tiny).code, 0);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
    EXPECT_EQ(get("there/real.png").substr(1, 3), "PNG");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "there"), fs::directory_iterator()), 1);
}

TEST_F(CliFilesTest, ACameraPathThatLastsTooLongIsNamed) {
    put("long.json", R"({"keys": [{"time": 0, "eye": [0,0,1], "target": [0,0,0]},
                                   {"time": 1e9, "eye": [0,0,2], "target": [0,0,0]}]})");
    const std::string render = "render builtin:cornell --camera-path " + path("long.json") + tiny;
    expect(render + "-o " + path("a.%04d.exr"), 2, "last 1e+09 s");
    expect(render + "-o " + path("a.%04d.exr") + " --fps 0.0001", 2, "--fps");
    EXPECT_EQ(run(render + "-o " + path("a.%04d.exr") + " --frames 1").code, 0);
    expect(std::string("render builtin:cornell --camera-path orbit --fps 0.001 --frames 1000000") + tiny +
               "-o " + path("a.%04d.exr"),
           2, "a built-in path");
    put("list.json", "[]");
    expect("render builtin:cornell --camera-path " + path("list.json") + tiny + "-o " + path("a.exr"), 3,
           "is not a camera path: its JSON is array, no object");
}

}  // namespace
}  // namespace limpid

// Tests the window's tools: comparisons, lights, recompiled shaders, and recovery from errors.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "image/io/exr/exr.h"
#include "image/io/picture.h"
#include "image/metrics/metrics.h"
#include "tests/viewer/view_fixture.h"
#include "tests/viewer/window_pixels.h"

namespace limpid {
namespace {

using testing::HasSubstr;

class ViewToolsTest : public ViewTest {
  protected:
    /// Copies Limpid's shaders, so that tests can modify them.
    fs::path copiedShaders() const {
        const fs::path from = fs::path(LIMPID_SOURCE_DIR) / "src", to = folder_ / "src";
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".comp" && extension != ".glsl" && extension != ".h") continue;
            const fs::path target = to / fs::relative(entry.path(), from);
            fs::create_directories(target.parent_path());
            fs::copy_file(entry.path(), target);
        }
        return to;
    }
    /// In world space, from the integrator gbuffer.
    static std::vector<double> positionUnderMouse(const DrivenViewer& viewer) {
        viewer.xdotool("key p");
        viewer.waitFor("values", [&] { return !viewer.fact("values").empty(); });
        const std::string values = viewer.fact("values"), name = "gbuffer/position: ";
        if (values.find(name) == std::string::npos) throw std::runtime_error("no position in " + values);
        viewer.xdotool("key p");
        viewer.waitFor("no values", [&] { return viewer.fact("values").empty(); });
        std::vector<double> position(3);
        std::istringstream numbers(values.substr(values.find(name) + name.size()));
        for (double& p : position) numbers >> p;
        return position;
    }
    /// A quadrangle and several cameras, one of them without a name.
    static constexpr const char* camerasFile = R"({"asset": {"version": "2.0"}, "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4], "name": "front"},
                  {"camera": 0, "translation": [-1, 0, 4], "name": "left"},
                  {"camera": 0, "translation": [0, 1, 6]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [-1, -1, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36,
                     "uri": "data:application/octet-stream;base64,AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAA"}]})";
    static void openTree(const DrivenViewer& viewer, const std::string& light) {
        viewer.press(light + ".tree", 0.1);
        viewer.waitFor(light + " to open", [&] { return viewer.value(light + ".tree") == "open"; });
    }
    static std::string copiedCommand(const DrivenViewer& viewer) {
        viewer.click("copy command line");
        viewer.waitFor("the command", [&] { return viewer.fact("message").starts_with("limpid render"); });
        return viewer.fact("message");
    }
    /// Runs a copied command, which makes frame.exr.
    void renderAgain(const std::string& command) const {
        const Result result = runProgram("cd '" + folder_.string() + "' && '" + LIMPID_PROGRAM + "' " +
                                         command.substr(7) + " --float");
        ASSERT_EQ(result.code, 0) << result.output;
    }
    static void save(const fs::path& file, const std::string& text) {
        std::ofstream(file) << text;
        fs::last_write_time(file, fs::file_time_type::clock::now());
    }
};

TEST_F(ViewToolsTest, ComparesWithAReference) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 6 --denoiser svgf");
    viewer.choose("compare with", "reference");
    viewer.waitFor("the reference", [&] { return viewer.controls().contains("reference samples"); });
    viewer.press("reference samples", 0.3);
    viewer.waitFor("the reference to converge", [&] {
        const std::string made = viewer.fact("compared");
        return made.starts_with("reference, ") &&
               std::stoi(made.substr(11)) >= std::stoi(viewer.value("reference samples"));
    });
    // Scores of a reference with fewer samples (14 dB) may stand there for a moment.
    viewer.waitFor("the scores of the converged reference", [&] {
        const std::string scores = viewer.value("scores");
        return scores.starts_with("PSNR ") && std::stod(scores.substr(5)) > 20.0;
    });
    const std::string one = viewer.settledPicture();  // the screenshot shows only the picture

    const Control divider = viewer.at("divider");
    const auto from = std::to_string(static_cast<int>(0.5f * (divider.left + divider.right)));
    viewer.xdotool("mousemove " + from +
                   " 1600 sleep 0.2 mousedown 1 sleep 0.2 mousemove 440 1600 sleep 0.2 mouseup 1");
    viewer.waitFor("the divider", [&] { return viewer.value("divider") > divider.value; });
    viewer.xdotool("key Tab");
    viewer.waitFor("the panel to go", [&] { return !viewer.controls().contains("integrator"); });
    viewer.xdotool("key Tab");
    viewer.waitFor("the panel", [&] { return viewer.controls().contains("integrator"); });
    EXPECT_EQ(viewer.settledPicture(), one) << "the divider must not move the camera";

    viewer.choose("compare with", "atrous");
    viewer.waitFor("another", [&] { return viewer.fact("compared") == "atrous"; });
    viewer.choose("compare with", "nano");
    viewer.waitFor("the network", [&] { return viewer.fact("compared") == "nano"; });
    viewer.choose("compare with", "nothing");
    EXPECT_FALSE(viewer.controls().contains("scores"));
    EXPECT_EQ(viewer.settledPicture(), one);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

/// Two renderers share a scene with moving parts.
TEST_F(ViewToolsTest, FindsNoDifferenceToItself) {
    const std::string identical = "the pictures are identical";
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 3 --denoiser svgf");
    viewer.choose("compare with", "svgf");
    viewer.click("playing");
    viewer.click("reset");
    viewer.waitFor("scores of moving pictures",
                   [&] { return viewer.number("frames") > 30 && viewer.value("scores") == identical; });
    viewer.click("playing");
    viewer.settledPicture();
    viewer.waitFor("scores at rest", [&] { return viewer.value("scores") == identical; });
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

#ifdef LIMPID_WINDOW_PIXELS
TEST_F(ViewToolsTest, TheWindowShowsThePicture) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 1", 0);
    viewer.settledPicture();
    const image::Image picture = image::displayEncode(image::readPicture(path("limpid.png")).linear, 0.0f);
    const auto worst = [&](uint32_t left, uint32_t right) {
        const WindowPixels shown(viewer, folder_ / "shown.ppm");
        EXPECT_EQ(shown.width(), picture.width + 400) << "the panel is beside it";
        EXPECT_EQ(shown.height(), picture.height);
        int most = 0;
        for (uint32_t y = 1100; y < 1600; ++y)
            for (uint32_t x = left; x < right; ++x)
                most = std::max(most, shown.difference(x, y, picture, x, y));
        return most;
    };
    const auto point = [&] {
        viewer.xdotool("mousemove 200 800");
        std::this_thread::sleep_for(std::chrono::seconds(1));
    };
    point();
    EXPECT_LE(worst(0, 460), 1);
    viewer.choose("compare with", "ao");
    viewer.waitFor("the other side", [&] { return viewer.fact("compared") == "ao, 1 sample"; });
    viewer.click("magnifier");
    viewer.waitFor("the magnifier", [&] { return viewer.value("magnifier") == "on"; });
    point();
    EXPECT_LE(worst(0, 290), 1) << "left of the divider";  // the divider is at 299
    EXPECT_GT(worst(310, 460), 30) << "right of it";
    // Two squares of 210 pixels, magnified ten times, are below the mouse and end at the window's edge.
    const WindowPixels shown(viewer, folder_ / "shown.ppm");
    EXPECT_LE(shown.difference(105, 929, picture, 200, 800), 1);
    EXPECT_LE(shown.difference(55, 879, picture, 195, 795), 1);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}
#else
TEST_F(ViewToolsTest, TheWindowShowsThePicture) {
    GTEST_SKIP() << "NOT TESTED: built without libx11-dev, which the test reads the window with.";
}
#endif

TEST_F(ViewToolsTest, EverySliderCanBeMoved) {
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 2");
    viewer.choose("jitter", "off");
    for (const char* name : {"samples at most", "seed", "exposure", "time", "field of view"})
        change(viewer, name);
    open(viewer, "section light");
    viewer.click("light.background of its own");
    viewer.waitFor("a background", [&] { return viewer.controls().contains("light.red"); });
    for (const char* name : {"red", "green", "blue"}) {
        // This loads the scene again, and controls move in the panel's first frames after that.
        viewer.settledPicture();
        change(viewer, std::string("light.") + name);
        EXPECT_EQ(viewer.fact("fault"), "") << name;
    }
    change(viewer, "samples a frame");
    viewer.choose("resolution", "1/4");
    viewer.settledPicture();
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

/// Editing the scene's own lights loads nothing, and undoing an edit restores the picture bit for bit.
TEST_F(ViewToolsTest, LightsChangeWithoutLoadingTheScene) {
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 4");
    const std::string start = viewer.settledPicture();
    open(viewer, "section light");
    viewer.click("light.light.##on");
    viewer.waitFor("the switch", [&] { return viewer.value("light.light.##on") == "off"; });
    EXPECT_NE(viewer.settledPicture(), start);
    viewer.click("light.light.##on");
    EXPECT_EQ(viewer.settledPicture(), start);

    openTree(viewer, "light.light");
    change(viewer, "light.light.brightness");
    EXPECT_NE(viewer.settledPicture(), start);
    viewer.type("light.light.brightness", "200000");  // beyond the slider
    viewer.waitFor("the number", [&] { return viewer.value("light.light.brightness") == "200000"; });
    const std::string colour = viewer.value("light.light.color");
    viewer.type("light.light.color", "60", 0.03);  // the red component
    viewer.waitFor("a colour", [&] { return viewer.value("light.light.color") != colour; });
    viewer.click("light.as loaded");
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.fact("scenes"), "1");

    // While the clip plays, histories continue. Frames are counted anew with the method, and at rest there
    // are four of them.
    viewer.choose("denoiser", "svgf");
    viewer.waitFor("the method", [&] { return viewer.number("frames") < 10; });
    viewer.click("playing");
    viewer.waitFor("frames", [&] { return viewer.number("frames") > 10; });
    for (const char* state : {"off", "on"}) {
        const double frames = viewer.number("frames");
        viewer.click("light.light.##on");
        viewer.waitFor("the switch", [&] { return viewer.value("light.light.##on") == state; });
        EXPECT_GE(viewer.number("frames"), frames);
    }
    EXPECT_EQ(viewer.fact("fault"), "");
    EXPECT_EQ(viewer.fact("scenes"), "1");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, LightsComeAndGo) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 4");
    const std::string start = viewer.settledPicture();
    open(viewer, "section light");
    viewer.click("light.add a point");
    const std::string lamp = "light.own light";
    viewer.waitFor("the lamp", [&] { return viewer.controls().contains(lamp + ".tree"); });
    const std::string lit = viewer.settledPicture();
    EXPECT_NE(lit, start);
    openTree(viewer, lamp);
    viewer.type(lamp + ".position x", "0.25");
    const std::string moved = viewer.settledPicture();
    EXPECT_NE(moved, lit);
    viewer.type(lamp + ".brightness", "0.125");
    EXPECT_NE(viewer.settledPicture(), moved);
    EXPECT_EQ(viewer.fact("scenes"), "2") << "for the lamp that came, and no more";

    viewer.click("EXR");
    viewer.waitFor("a file", [&] { return viewer.fact("message") == "wrote limpid.exr"; });
    const std::string command = copiedCommand(viewer);
    EXPECT_THAT(command, HasSubstr(" --light point,"));
    EXPECT_THAT(command, HasSubstr(" --lights lights.json"));
    ASSERT_NO_FATAL_FAILURE(renderAgain(command));
    EXPECT_EQ(image::readPicture(path("frame.exr")).linear.pixels,
              image::readPicture(path("limpid.exr")).linear.pixels);

    viewer.click(lamp + ".remove");
    viewer.waitFor("the lamp to go", [&] { return !viewer.controls().contains(lamp + ".tree"); });
    EXPECT_EQ(viewer.settledPicture(), start);
    viewer.click("light.background of its own");
    viewer.waitFor("a background", [&] { return viewer.controls().contains("light.red"); });
    EXPECT_NE(viewer.settledPicture(), start);
    viewer.click("light.background of its own");
    viewer.waitFor("no background", [&] { return !viewer.controls().contains("light.red"); });
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

/// Tests the camera as numbers and by name, the preview, and numbers typed into sliders.
TEST_F(ViewToolsTest, CamerasNumbersAndThePreview) {
    put("cameras.gltf", camerasFile);
    DrivenViewer viewer(folder_, "cameras.gltf --max-spp 3 --background 1,1,1");
    const std::string start = viewer.settledPicture();
    viewer.choose("camera", "left");
    const std::string left = viewer.settledPicture();
    EXPECT_NE(left, start);
    viewer.choose("camera", "camera 2");
    EXPECT_NE(viewer.settledPicture(), left);
    viewer.choose("camera", "left");
    EXPECT_EQ(viewer.settledPicture(), left);

    viewer.type("eye x", "1.5");
    viewer.waitFor("the camera to be free", [&] { return viewer.value("camera") == "free"; });
    viewer.type("up x", "1");
    const std::string rolled = viewer.settledPicture();
    EXPECT_NE(rolled, left);
    viewer.click("EXR");
    viewer.waitFor("a file", [&] { return viewer.fact("message") == "wrote limpid.exr"; });
    const std::string command = copiedCommand(viewer);
    EXPECT_THAT(command, HasSubstr("--eye 1.5,"));
    EXPECT_THAT(command, HasSubstr(" --up 0.7"));
    ASSERT_NO_FATAL_FAILURE(renderAgain(command));
    EXPECT_EQ(image::readPicture(path("frame.exr")).linear.pixels,
              image::readPicture(path("limpid.exr")).linear.pixels);

    viewer.click("preview");
    viewer.waitFor("the preview", [&] { return viewer.value("integrator") == "preview"; });
    EXPECT_NE(viewer.settledPicture(), rolled);
    viewer.xdotool("mousemove 440 1690 key v");
    viewer.waitFor("the picture", [&] { return viewer.value("integrator") == "path"; });
    EXPECT_EQ(viewer.settledPicture(), rolled);

    open(viewer, "ao");
    viewer.type("ao.radius", "500");  // the slider ends at 10, the range at 1000
    viewer.waitFor("the number", [&] { return viewer.value("ao.radius") == "500"; });
    viewer.type("ao.radius", "5000");
    viewer.waitFor("the end of the range", [&] { return viewer.value("ao.radius") == "1000"; });
    viewer.type("field of view", "0");  // its range begins at 0.01, which is less as a float
    viewer.waitFor("the start of the range", [&] { return viewer.value("field of view") == "0.01"; });
    viewer.type("field of view", "1", 0.03, "Escape");
    EXPECT_EQ(viewer.ended(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, LayersGoIntoTheFile) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3 --light point,0.5,1,0.5,0.2");
    viewer.settledPicture();
    viewer.click("EXR");
    viewer.waitFor("a file", [&] { return viewer.fact("message") == "wrote limpid.exr"; });
    viewer.click("layers in EXR files");
    viewer.waitFor("layers in EXR files", [&] { return viewer.value("layers in EXR files") == "on"; });
    viewer.settledPicture();
    viewer.click("EXR");
    viewer.waitFor("another file", [&] { return viewer.fact("message") == "wrote limpid-2.exr"; });
    const image::LayeredImage plain = image::readExr(path("limpid.exr")),
                              layered = image::readExr(path("limpid-2.exr"));
    EXPECT_EQ(plain.channels.size(), 4u);
    EXPECT_GT(layered.channels.size(), 20u);
    const std::string command = copiedCommand(viewer);
    ASSERT_NO_FATAL_FAILURE(renderAgain(command));
    const image::LayeredImage again = image::readExr(path("frame.exr"));
    for (const char* channel : {"R", "diffuse.G", "normal.Z"})
        EXPECT_EQ(again.find(channel)->values, layered.find(channel)->values) << channel;
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, MotionBlurIsOnTheCommandLine) {
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 6");
    const std::string sharp = viewer.settledPicture();
    viewer.type("shutter", "4.1");
    viewer.waitFor("the number", [&] { return viewer.value("shutter") == "4.1"; });
    EXPECT_NE(viewer.settledPicture(), sharp);
    viewer.click("EXR");
    viewer.waitFor("a file", [&] { return viewer.fact("message") == "wrote limpid.exr"; });
    const std::string command = copiedCommand(viewer);
    EXPECT_THAT(command, HasSubstr(" --shutter 4.1 "));
    ASSERT_NO_FATAL_FAILURE(renderAgain(command));
    // The window has a running mean, and the program one of sums.
    const image::Image shown = image::readPicture(path("limpid.exr")).linear,
                       rendered = image::readPicture(path("frame.exr")).linear;
    ASSERT_EQ(shown.pixels.size(), rendered.pixels.size());
    for (size_t i = 0; i < shown.pixels.size(); ++i)
        ASSERT_NEAR(shown.pixels[i], rendered.pixels[i], 1e-4f * rendered.pixels[i] + 1e-6f) << i;
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, SeesEverything) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3");
    const std::string start = viewer.settledPicture();
    viewer.xdotool("mousemove 420 1000 click 4 click 4 sleep 0.3");
    EXPECT_NE(viewer.settledPicture(), start);
    viewer.click("see everything");
    const std::string all = viewer.settledPicture();
    viewer.xdotool("mousemove 420 1000 click 5 sleep 0.3");
    EXPECT_NE(viewer.settledPicture(), all);
    viewer.click("see everything");
    EXPECT_EQ(viewer.settledPicture(), all);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, TheMagnifierTheArrowsAndTheProbe) {
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 3 --denoiser svgf");
    viewer.click("magnifier");
    viewer.click("motion arrows");
    viewer.choose("compare with", "path");
    viewer.click("playing");
    viewer.waitFor("frames", [&] { return viewer.number("frames") > 20; });
    for (const std::string place : {"5 5", "455 1695", "430 850"})
        viewer.xdotool("mousemove " + place + " sleep 0.3");
    viewer.xdotool("key p");
    viewer.waitFor("values", [&] { return !viewer.fact("values").empty(); });
    EXPECT_THAT(viewer.fact("values"), HasSubstr("pixel (53, 106)"));
    EXPECT_THAT(viewer.fact("values"), HasSubstr("pathtrace/normal: "));
    EXPECT_THAT(viewer.fact("values"), HasSubstr("history "));
    viewer.xdotool("key p");
    viewer.waitFor("no values", [&] { return viewer.fact("values").empty(); });
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, LooksAtWhatIsClickedTwice) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2 --integrator gbuffer");
    viewer.settledPicture();
    viewer.xdotool("mousemove 420 1000 sleep 0.3");
    const std::vector<double> clicked = positionUnderMouse(viewer);
    viewer.xdotool("click 1 sleep 0.05 click 1 sleep 0.3");
    viewer.settledPicture();
    viewer.xdotool("mousemove 230 850 sleep 0.3");  // middle of the window
    const std::vector<double> middle = positionUnderMouse(viewer);
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(middle[i], clicked[i], 0.02) << i;
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewToolsTest, ShadersAreCompiledWhenTheyAreSaved) {
    const fs::path file = copiedShaders() / "passes/pathtrace/pathtrace_pixel.glsl";
    std::ifstream stream(file);
    const std::string source{std::istreambuf_iterator<char>(stream), {}};
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3 --shaders src");
    const std::string start = viewer.settledPicture();

    save(file, source + "\nthis is no GLSL\n");
    viewer.waitFor("a fault", [&] { return !viewer.fact("fault").empty(); });
    EXPECT_THAT(viewer.fact("fault"), HasSubstr("pathtrace_pixel.glsl"));
    viewer.click("reset");
    EXPECT_EQ(viewer.settledPicture(), start) << "the old shader goes on";

    const std::string place = "sum.rgb += radiance;";
    ASSERT_NE(source.find(place), std::string::npos);
    std::string darker = source;
    darker.replace(darker.find(place), place.size(), "sum.rgb += 0.25 * radiance;");
    save(file, darker);
    viewer.waitFor("compilation", [&] { return viewer.fact("message").starts_with("compiled"); });
    EXPECT_EQ(viewer.fact("fault"), "");
    EXPECT_NE(viewer.settledPicture(), start);

    save(file, source);
    viewer.waitFor("compilation", [&] { return viewer.fact("message").starts_with("compiled"); });
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

#ifdef LIMPID_DROP_FILES
void dropOn(const DrivenViewer& viewer, const std::string& file) {
    viewer.run(std::string("'") + LIMPID_DROP_FILES + "' " + viewer.window() + " " + file);
}
#endif

/// A scene named on the command line may read from the parent of its folder; a dropped one may not.
TEST_F(ViewToolsTest, WhatIsDroppedSeesItsOwnFolderOnly) {
#ifdef LIMPID_DROP_FILES
    constexpr std::array<float, 9> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
    put("corners.bin", std::string(reinterpret_cast<const char*>(corners.data()), sizeof corners));
    fs::create_directories(folder_ / "inner");
    put("inner/triangle.gltf",
        R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 0]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"uri": "../corners.bin", "byteLength": 36}]})");
    EXPECT_EQ(run("info " + path("inner/triangle.gltf")).code, 0);
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    dropOn(viewer, path("inner/triangle.gltf"));
    viewer.waitFor("a fault", [&] { return !viewer.fact("fault").empty(); });
    EXPECT_THAT(viewer.fact("fault"), HasSubstr("../corners.bin"));
    EXPECT_THAT(viewer.fact("fault"), HasSubstr("lies outside"));
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
#else
    GTEST_SKIP() << "NOT TESTED: built without libx11-dev, which the test drops files with.";
#endif
}

TEST_F(ViewToolsTest, FilesAreDroppedOnIt) {
#ifdef LIMPID_DROP_FILES
    put("broken.gltf", "{\"asset\": {");
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    dropOn(viewer, path("broken.gltf"));
    viewer.waitFor("a fault", [&] { return !viewer.fact("fault").empty(); });
    EXPECT_THAT(viewer.fact("fault"), HasSubstr("broken.gltf"));
    EXPECT_EQ(viewer.settledPicture(), start);
    put("lone.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    dropOn(viewer, path("lone.obj"));
    viewer.waitFor("the scene", [&] { return viewer.fact("message").find("lone.obj") != std::string::npos; });
    EXPECT_EQ(viewer.fact("fault"), "");
    EXPECT_NE(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
#else
    GTEST_SKIP() << "NOT TESTED: built without libx11-dev, which the test drops files with.";
#endif
}

TEST_F(ViewToolsTest, GoesOnWhenTheDeviceIsLost) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 4000 --lose-device 100 --denoiser atrous");
    viewer.waitFor("the loss",
                   [&] { return viewer.get("log").find("setting everything up anew") != std::string::npos; });
    viewer.waitFor("a new window", [&] { return viewer.fact("fault").find("lost") != std::string::npos; });
    EXPECT_EQ(viewer.value("denoiser"), "atrous");
    viewer.findWindow();
    viewer.click("running");
    viewer.settledPicture();
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

}  // namespace
}  // namespace limpid

// Tests the window with real input events.
#include <gmock/gmock.h>

#include <algorithm>

#include "image/io/picture.h"
#include "renderer/method/parameters.h"
#include "tests/viewer/view_fixture.h"

namespace limpid {
namespace {

using testing::HasSubstr;

class ViewEventsTest : public ViewTest {};

/// A mean that was left for a denoiser starts again.
TEST_F(ViewEventsTest, AMeanOfBeforeIsNotTakenUp) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 5");
    const std::string start = viewer.settledPicture();
    viewer.choose("denoiser", "svgf");
    viewer.settledPicture();
    viewer.choose("denoiser", "none");
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.fact("samples"), "5");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

/// Tests all parameters of paramGroups(), which `limpid info` lists.
TEST_F(ViewEventsTest, EveryParameterChangesAndGoesBack) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    for (const ParamGroup& group : paramGroups()) {
        open(viewer, group.name);
        std::map<std::string, std::string> defaults;
        for (const ParamInfo& info : group.infos)
            defaults[group.name + "." + info.name] = viewer.value(group.name + "." + info.name);
        for (const auto& [name, value] : defaults) change(viewer, name);
        if (group.name == "pathtrace") {
            EXPECT_NE(viewer.settledPicture(), start);
        }
        viewer.click(group.name + ".defaults");
        for (const auto& [name, value] : defaults)
            viewer.waitFor(name + " to be " + value,
                           [&, n = name, v = value] { return viewer.value(n) == v; });
        close(viewer, group.name);
    }
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, PicturesChangeAndComeBack) {
    DrivenViewer viewer(folder_, "builtin:cornell-moving --max-spp 4");
    const std::string start = viewer.settledPicture();
    for (const std::string integrator : {"gbuffer", "direct", "ao"}) {
        viewer.choose("integrator", integrator);
        EXPECT_NE(viewer.settledPicture(), start) << integrator;
    }
    const std::string occlusion = viewer.settledPicture();
    for (const std::string denoiser : {"atrous", "svgf"}) {
        viewer.choose("denoiser", denoiser);
        EXPECT_NE(viewer.settledPicture(), occlusion) << denoiser;
    }
    viewer.choose("integrator", "gbuffer");
    viewer.waitFor("no denoiser", [&] { return viewer.value("denoiser") == "none"; });
    viewer.choose("denoiser", "svgf");
    viewer.waitFor("paths", [&] { return viewer.value("integrator") == "path"; });
    EXPECT_NE(viewer.settledPicture(), start);
    viewer.choose("denoiser", "none");
    EXPECT_EQ(viewer.settledPicture(), start);
    for (const std::string name : {"seed", "time", "field of view"}) {
        change(viewer, name);
        EXPECT_NE(viewer.settledPicture(), start) << name;
    }
    viewer.xdotool("mousemove 420 1000 mousedown 1 mousemove 440 1010 sleep 0.2 mouseup 1");
    const std::string orbited = viewer.settledPicture();
    viewer.xdotool("mousemove 420 1000 click 4 sleep 0.1");
    const std::string nearer = viewer.settledPicture();
    EXPECT_NE(nearer, orbited) << "the wheel";
    change(viewer, "exposure");
    EXPECT_NE(viewer.settledPicture(), nearer) << "exposure";
    viewer.xdotool("mousemove 420 1000 mousedown 3 keydown w sleep 0.3 keyup w mouseup 3");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, PassesShowTheirImages) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3 --denoiser svgf");
    viewer.settledPicture();
    open(viewer, "section passes");
    const std::string pass = "pass svgf/reproject diffuse";
    viewer.waitFor("passes", [&] { return viewer.controls().contains(pass); });
    viewer.click(pass);
    viewer.waitFor("images", [&] { return viewer.controls().contains("image"); });
    viewer.choose("channels", "green");
    change(viewer, "brightness");
    change(viewer, "false color");
    viewer.waitFor("the legend", [&] { return viewer.controls().contains("colormap"); });
    viewer.xdotool("mousemove 430 850");
    viewer.waitFor("the probe", [&] { return viewer.fact("probe").starts_with("(53, 106)"); });
    viewer.waitFor("the history", [&] { return viewer.fact("reasons").starts_with("history kept: "); });
    viewer.choose("denoiser", "none");  // this one has no such pass
    viewer.settledPicture();
    EXPECT_FALSE(viewer.controls().contains("image"));
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, ThePassUnderThePointerIsShown) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3 --denoiser svgf");
    viewer.settledPicture();
    open(viewer, "section passes");
    const std::string first = "svgf/reproject diffuse", second = "svgf/reproject specular";
    const auto shows = [&](const std::string& pass) {
        viewer.waitFor("'" + pass + "' to be shown", [&] { return viewer.value("pass shown") == pass; });
    };
    const auto restOn = [&](const std::string& pass) {
        viewer.waitFor("the pointer on '" + pass + "'", [&] {
            viewer.hover("pass " + pass);  // again where the list has moved in the meantime
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
            return viewer.value("pass shown") == pass;
        });
    };
    viewer.waitFor("passes", [&] { return viewer.controls().contains("pass " + second); });
    restOn(first);
    EXPECT_FALSE(viewer.controls().contains("image"));  // the list does not move
    restOn(second);
    viewer.xdotool("mousemove 430 850");
    shows("");
    viewer.click("pass " + first);
    viewer.waitFor("images", [&] { return viewer.controls().contains("image"); });
    restOn(second);
    viewer.xdotool("mousemove 430 850");
    shows(first);
    viewer.click("pass " + first);  // the pointer stays, and the picture is shown
    shows("");
    viewer.click("pass " + second);
    shows(second);
    viewer.click("pass none");
    shows("");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, SettingsAreKept) {
    {
        DrivenViewer viewer(folder_, "builtin:cornell --max-spp 3");
        viewer.choose("denoiser", "atrous");
        open(viewer, "atrous");
        change(viewer, "atrous.levels");
        EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
    }
    const std::string kept = get("kept.json");
    EXPECT_THAT(kept, HasSubstr("atrous.levels="));
    DrivenViewer viewer(folder_, "builtin:cornell");
    EXPECT_EQ(viewer.value("denoiser"), "atrous");
    EXPECT_EQ(viewer.value("samples at most"), "3");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
    EXPECT_EQ(get("kept.json"), kept);
}

TEST_F(ViewEventsTest, AnySizeOfWindow) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    for (const std::string size : {"900 300", "1 1", "64 1700", "860 1700"}) {
        viewer.xdotool("windowsize " + viewer.window() + " " + size + " sleep 0.5");
    }
    viewer.xdotool("windowunmap " + viewer.window() + " sleep 0.5 windowmap " + viewer.window() +
                   " sleep 0.5");
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, WhatCannotBeOpenedLeavesTheOldScene) {
    put("broken.gltf", "{\"asset\": {");
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    viewer.click("open");
    viewer.xdotool("sleep 0.3 type broken.gltf");
    viewer.xdotool("sleep 0.2 key Return");
    viewer.waitFor("a message", [&] { return !viewer.fact("fault").empty(); });
    EXPECT_THAT(viewer.fact("fault"), HasSubstr("broken.gltf"));
    EXPECT_EQ(viewer.settledPicture(), start);
    viewer.click("open");
    viewer.xdotool("sleep 0.3 key ctrl+a type builtin:heavy");
    viewer.xdotool("sleep 0.2 key Return");
    viewer.waitFor("the scene", [&] { return viewer.fact("message") == "opened builtin:heavy"; });
    EXPECT_NE(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewEventsTest, TheCommandLineMakesTheSameFrame) {
    for (const std::string denoiser : {"none", "svgf"}) {
        std::string command;
        {
            DrivenViewer viewer(folder_, "builtin:cornell --max-spp 12 --seed 5 --denoiser " + denoiser +
                                             " --screenshot shown.exr");
            viewer.xdotool("mousemove 420 1000 sleep 0.1 mousedown 1");
            for (const char* place : {"430 1004", "437 1011"}) {  // each is seen by frames of its own
                viewer.waitFor("rest", [&] { return viewer.fact("rendering") == "no"; });
                const double frames = viewer.number("frames");
                viewer.xdotool(std::string("mousemove ") + place + " sleep 0.1");
                viewer.waitFor("a frame", [&] { return viewer.number("frames") != frames; });
            }
            viewer.xdotool("mouseup 1");
            viewer.settledPicture();
            viewer.click("copy command line");
            viewer.waitFor("the command",
                           [&] { return viewer.fact("message").starts_with("limpid render"); });
            command = viewer.fact("message").substr(7);
            EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
        }
        const Result result =
            runProgram("cd '" + folder_.string() + "' && '" + LIMPID_PROGRAM + "' " + command + " --float");
        ASSERT_EQ(result.code, 0) << command << "\n" << result.output;
        fs::path last = folder_ / "frame.exr";
        for (int i = 0; fs::exists(folder_ / ("frame." + std::string(4 - std::to_string(i).size(), '0') +
                                              std::to_string(i) + ".exr"));
             ++i)
            last = folder_ /
                   ("frame." + std::string(4 - std::to_string(i).size(), '0') + std::to_string(i) + ".exr");
        EXPECT_EQ(image::readPicture(folder_ / "shown.exr").linear.pixels,
                  image::readPicture(last).linear.pixels)
            << command;
        EXPECT_EQ(command.find("--camera-path") != std::string::npos, denoiser == "svgf");
    }
}

TEST_F(ViewEventsTest, RestsWhereNothingChangesAndKeepsNothing) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 420");
    // An allocator grows in steps of its own; what is kept of every frame grows in all spans of frames.
    double least = 1e12, before = 0.0;
    for (const double frames : {100.0, 200.0, 300.0, 400.0}) {
        viewer.waitFor("frames", [&] { return viewer.number("frames") >= frames; });
        const double bytes = viewer.residentBytes();
        if (frames > 100.0) least = std::min(least, bytes - before);
        before = bytes;
    }
    EXPECT_LT(least, 0.4e6);  // 4 KB a frame
    viewer.settledPicture();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    const double seconds = viewer.processorSeconds();
    std::this_thread::sleep_for(std::chrono::seconds(5));
    EXPECT_LT((viewer.processorSeconds() - seconds) / 5.0, 0.02);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

}  // namespace
}  // namespace limpid

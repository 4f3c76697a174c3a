// Tests the window's layout: the panel beside the picture, search, marks of changed values, undo, the list of
// keys, the start page, the theme; and how soon it reacts.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/viewer/view_fixture.h"
#include "tests/viewer/window_pixels.h"

namespace limpid {
namespace {

using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

class ViewLayoutTest : public ViewTest {
  protected:
    static void waitForValue(const DrivenViewer& viewer, const std::string& name, const std::string& value) {
        viewer.waitFor(name + " to be " + value, [&] {
            const auto all = viewer.controls();
            return all.contains(name) && all.at(name).value == value;
        });
    }
    /// Types into the search field in place of what it says.
    static void search(const DrivenViewer& viewer, const std::string& words) {
        viewer.click("search");
        viewer.xdotool("sleep 0.2 key ctrl+a sleep 0.1 type --delay 30 -- '" + words + "'");
        waitForValue(viewer, "search", words);
    }
    nlohmann::json memory() const { return nlohmann::json::parse(get("window.json")); }
};

/// The picture has what the panel leaves of the window, wherever its edge is dragged.
TEST_F(ViewLayoutTest, ThePanelIsBesideThePicture) {
    {
        DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
        const Control window = viewer.at("window"), edge = viewer.at("panel edge");
        EXPECT_EQ(window.right, 860.0f);
        EXPECT_EQ(viewer.at("picture").right, edge.left);
        EXPECT_EQ(viewer.at("picture").bottom, window.bottom);
        EXPECT_EQ(viewer.value("picture"), "460x1700");

        viewer.xdotool(
            "mousemove 463 900 sleep 0.2 mousedown 1 sleep 0.2 mousemove 420 900 sleep 0.1 "
            "mousemove 363 900 sleep 0.2 mouseup 1");
        waitForValue(viewer, "picture", "363x1700");
        EXPECT_EQ(viewer.at("panel edge").left, 363.0f);
        viewer.settledPicture();
        viewer.xdotool("mousemove 200 900 sleep 0.1 key Tab");
        waitForValue(viewer, "picture", "860x1700");
        EXPECT_FALSE(viewer.controls().contains("integrator"));
        viewer.xdotool("key Tab");
        waitForValue(viewer, "picture", "363x1700");
        for (const char* inPanel : {"integrator", "search", "status", "running"})
            EXPECT_GT(viewer.at(inPanel).left, 363.0f) << inPanel;
        EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
    }
    EXPECT_EQ(memory().at("panel_width"), 497.0f);
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    EXPECT_EQ(viewer.at("window").right, 460.0f + 497.0f);
    EXPECT_EQ(viewer.value("picture"), "460x1700");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewLayoutTest, FindsMarksAndUndoes) {
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    const std::string start = viewer.settledPicture();
    search(viewer, "levels");
    viewer.waitFor("parameters", [&] { return viewer.controls().contains("search.svgf.levels"); });
    EXPECT_TRUE(viewer.controls().contains("search.atrous.levels"));
    EXPECT_FALSE(viewer.controls().contains("seed"));
    EXPECT_FALSE(viewer.controls().contains("search.method.seed"));
    search(viewer, "other noise");  // the help of the seed
    viewer.waitFor("the seed", [&] { return viewer.controls().contains("search.method.seed"); });
    viewer.type("search.method.seed", "7");
    waitForValue(viewer, "search.method.seed", "7");
    search(viewer, "limpid.png");  // the help of a button
    viewer.waitFor("a button", [&] { return viewer.controls().contains("search.output.screenshot"); });
    search(viewer, "firefly passes cornell-moving");
    viewer.waitFor("nothing", [&] { return !viewer.controls().contains("search.output.screenshot"); });
    search(viewer, "firefly");
    viewer.waitFor("the plural", [&] { return viewer.controls().contains("search.svgf.fireflies"); });
    search(viewer, "passes");
    viewer.waitFor("the passes", [&] { return viewer.controls().contains("search.passes.pass pathtrace"); });
    search(viewer, "swinging light");  // of a scene's help
    viewer.waitFor("a scene",
                   [&] { return viewer.controls().contains("search.scene.builtin:cornell-moving"); });
    viewer.xdotool("sleep 0.1 key ctrl+a sleep 0.1 key BackSpace");
    viewer.waitFor("the sections", [&] { return viewer.controls().contains("seed"); });
    EXPECT_NE(viewer.settledPicture(), start);

    EXPECT_EQ(viewer.value("seed"), "7");
    viewer.press("default of seed", 0.0);
    waitForValue(viewer, "seed", "0");
    viewer.waitFor("the dot to go", [&] { return !viewer.controls().contains("default of seed"); });
    EXPECT_EQ(viewer.settledPicture(), start);

    viewer.xdotool("mousemove 200 900 key ctrl+z");
    waitForValue(viewer, "seed", "7");
    viewer.xdotool("key ctrl+z");
    waitForValue(viewer, "seed", "0");
    viewer.xdotool("key ctrl+shift+z");
    waitForValue(viewer, "seed", "7");
    viewer.click("undo");
    waitForValue(viewer, "seed", "0");
    viewer.xdotool("mousemove 200 900 key ctrl+y");
    waitForValue(viewer, "seed", "7");
    viewer.xdotool("key ctrl+z");
    waitForValue(viewer, "seed", "0");

    viewer.click("keep these settings");
    waitForValue(viewer, "compare with", "kept settings");
    viewer.xdotool("mousemove 200 900 key ctrl+z");
    waitForValue(viewer, "compare with", "nothing");

    // A drag over several pictures of the window is one step.
    const std::string before = viewer.value("field of view");
    const Control slider = viewer.reveal("field of view");
    const auto at = [&](float share) {
        return " mousemove " +
               std::to_string(static_cast<int>(slider.left + share * (slider.right - slider.left))) + " " +
               std::to_string(static_cast<int>(0.5f * (slider.top + slider.bottom))) + " sleep 0.15";
    };
    viewer.xdotool(at(0.3f) + " mousedown 1 sleep 0.15" + at(0.4f) + at(0.5f) + at(0.6f) + " mouseup 1");
    viewer.waitFor("the slider", [&] { return viewer.value("field of view") != before; });
    viewer.settledPicture();
    viewer.xdotool("mousemove 200 900 key ctrl+z");
    waitForValue(viewer, "field of view", before);
    EXPECT_EQ(viewer.settledPicture(), start);
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewLayoutTest, KeysAndTheme) {
    {
        DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2 --hdr on");
        const auto lists = [&] { return viewer.controls().contains("key map"); };
        viewer.xdotool("mousemove 200 900 key question");
        viewer.waitFor("the list of keys", lists);
        viewer.xdotool("key question");
        viewer.waitFor("the list to close", [&] { return !lists(); });
        viewer.click("keys");
        viewer.waitFor("the list of keys", lists);
        viewer.xdotool("key Escape");
        viewer.waitFor("the list to close", [&] { return !lists(); });
        viewer.click("denoiser");
        viewer.waitFor("the choices", [&] { return viewer.controls().contains("denoiser=svgf"); });
        viewer.xdotool("key Escape");
        viewer.waitFor("the choices to close", [&] { return !viewer.controls().contains("denoiser=svgf"); });
        EXPECT_EQ(viewer.get("code"), "") << "Escape closes what is open before it quits";

        // No driver offers HDR on Xvfb. The switch tells why, and cannot be moved.
        EXPECT_THAT(viewer.value("hdr fault"), HasSubstr("HDR"));
        EXPECT_THAT(viewer.get("log"), HasSubstr("--hdr on: "));
        viewer.click("hdr");
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        EXPECT_EQ(viewer.value("hdr"), "off");

        open(viewer, "section window");
#ifdef LIMPID_WINDOW_PIXELS
        const auto panelBrightness = [&] {
            const Control edge = viewer.at("panel edge");
            std::this_thread::sleep_for(std::chrono::milliseconds(500));
            return WindowPixels(viewer, folder_ / "shown.ppm")
                .brightness(static_cast<uint32_t>(edge.left) + 4, 3);
        };
        EXPECT_LT(panelBrightness(), 64.0);
#endif
        EXPECT_EQ(viewer.value("light theme"), "off");
        viewer.click("light theme");
        waitForValue(viewer, "light theme", "on");
#ifdef LIMPID_WINDOW_PIXELS
        EXPECT_GT(panelBrightness(), 192.0);
#endif
        EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
    }
    DrivenViewer viewer(folder_, "builtin:cornell --max-spp 2");
    EXPECT_EQ(viewer.value("section window"), "open");
    EXPECT_EQ(viewer.value("light theme"), "on");
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

TEST_F(ViewLayoutTest, StartsWithoutAScene) {
    put("lone.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto openByName = [](const DrivenViewer& viewer, const std::string& name) {
        viewer.click("open");
        viewer.xdotool("sleep 0.3 key ctrl+a type --delay 30 -- " + name);
        viewer.xdotool("sleep 0.2 key Return");
    };
    {
        DrivenViewer viewer(folder_, "--max-spp 2");
        EXPECT_EQ(viewer.fact("scenes"), "0");
        EXPECT_TRUE(viewer.controls().contains("start.lab-mirror"));
        openByName(viewer, "none.gltf");
        viewer.waitFor("an error", [&] { return viewer.controls().contains("error"); });
        EXPECT_THAT(viewer.value("error"), HasSubstr("none.gltf"));
        EXPECT_GT(viewer.at("error").left, viewer.at("picture").right);
        viewer.press("start.cornell", 0.4);
        viewer.waitFor("the scene", [&] { return viewer.fact("scenes") == "1"; });
        viewer.settledPicture();
        EXPECT_EQ(viewer.fact("fault"), "") << "the old error goes";
        EXPECT_FALSE(viewer.controls().contains("start.cornell"));
        openByName(viewer, "lone.obj");
        viewer.waitFor("the file", [&] { return viewer.fact("scenes") == "2"; });
        viewer.settledPicture();
        EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
    }
    EXPECT_THAT(memory().at("recent").dump(), HasSubstr("lone.obj"));
    DrivenViewer viewer(folder_, "--max-spp 2");
    viewer.press("recent.lone.obj", 0.1);
    viewer.waitFor("the file", [&] { return viewer.fact("scenes") == "1"; });
    EXPECT_THAT(viewer.fact("message"), HasSubstr("lone.obj"));
    EXPECT_EQ(viewer.leave(), 0) << viewer.get("log");
}

/// Frames of seconds must not hold up the interface.
TEST_F(ViewLayoutTest, ReactsWhileFramesTakeSeconds) {
    DrivenViewer viewer(folder_, "builtin:heavy --spp 3", 0);
    std::vector<double> seconds;
    for (const char* name : {"magnifier", "motion arrows"}) {
        const Control control = viewer.reveal(name);
        viewer.xdotool("mousemove " + std::to_string(static_cast<int>(control.left + 8)) + " " +
                       std::to_string(static_cast<int>(0.5f * (control.top + control.bottom))) +
                       " sleep 0.5");
        for (int i = 0; i < 8; ++i) {
            const std::string before = viewer.value(name);
            const auto begin = Clock::now();
            viewer.xdotool("click 1");
            while (viewer.value(name) == before) {
                ASSERT_LT(Clock::now() - begin, std::chrono::seconds(20)) << name;
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            seconds.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
            std::this_thread::sleep_for(std::chrono::milliseconds(300 + 37 * i));
        }
    }
    const double worst = *std::ranges::max_element(seconds);
    std::ranges::sort(seconds);
    std::printf("from a click to the control's new value: median %.0f ms, worst %.0f ms\n",
                1e3 * seconds[seconds.size() / 2], 1e3 * worst);
    RecordProperty("worst_reaction_ms", static_cast<int>(1e3 * worst));
    EXPECT_LT(worst, 1.0);
}

}  // namespace
}  // namespace limpid

// Shared by the tests that control the window.
#pragma once

#include "tests/viewer/driven_viewer.h"

namespace limpid {

class ViewTest : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        if (run("view builtin:none").output.find("was built without") != std::string::npos)
            GTEST_SKIP() << "NOT TESTED: Limpid was built without libglfw3-dev and libimgui-dev.";
        if (const std::string missing = DrivenViewer::missing(); !missing.empty())
            GTEST_SKIP() << "NOT TESTED: " << missing;
    }
    static void open(const DrivenViewer& viewer, const std::string& group) {
        viewer.click(group);
        viewer.waitFor(group + " to open", [&] { return viewer.value(group) == "open"; });
    }
    static void close(const DrivenViewer& viewer, const std::string& group) {
        viewer.click(group);
        viewer.waitFor(group + " to close", [&] { return viewer.value(group) == "closed"; });
    }
    /// Changes a drop-down control to any value other than its current one.
    static void change(const DrivenViewer& viewer, const std::string& name) {
        const std::string before = viewer.value(name);
        for (const double share : {0.1, 0.35, 0.5}) {
            if (before == "on" || before == "off")
                viewer.click(name);
            else
                viewer.press(name, share);
            for (int i = 0; i < 60 && viewer.value(name) == before; ++i)
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
            if (viewer.value(name) != before) return;
        }
        ADD_FAILURE() << name << " stays " << before;
    }
};

}  // namespace limpid

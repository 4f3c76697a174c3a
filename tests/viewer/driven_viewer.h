// Runs `limpid view` on its own display, controls it with a real mouse and keyboard (xdotool), and reads its
// output files.
#pragma once

#include <fmt/format.h>
#include <signal.h>

#include <chrono>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tests/cli/cli_fixture.h"

namespace limpid {

struct Control {
    float left = 0.0f, top = 0.0f, right = 0.0f, bottom = 0.0f;
    std::string value;
};

class DrivenViewer {
  public:
    /// Returns which requirement is missing, or an empty text.
    static std::string missing() {
        for (const char* program : {"Xvfb", "xdotool"}) {
            if (::system((std::string("command -v ") + program + " > /dev/null").c_str()) != 0)
                return std::string(program) + " is missing (Debian packages xvfb and xdotool)";
        }
        return {};
    }

    /// Where the panel's sections are open.
    static constexpr const char* opened =
        R"({"open": {"scene": true, "camera": true, "method": true, "look": true, "compare": true,
                     "output": true, "other parameters": true}})";

    /// Files go to `folder`. The picture has 460x1700 pixels of the window, and the panel is right of it; one
    /// pixel of the picture covers 2^shrink of them along each axis. `memory`: the text of window.json,
    /// unless there is one.
    DrivenViewer(const fs::path& folder, const std::string& arguments, int shrink = 3,
                 const std::string& memory = opened)
        : folder_(folder) {
        if (!fs::exists(folder / "window.json")) std::ofstream(folder / "window.json") << memory;
        const std::string in = "cd '" + folder_.string() + "' && ";
        // The display ends with its last client, so the viewer must stay connected all the time.
        shell(
            in +
            "rm -f display controls code log; Xvfb -terminate -displayfd 3 -screen 0 1000x1800x24 3>display "
            ">/dev/null 2>&1 & "
            "echo $! > '" +
            (folder_ / "xvfb.pid").string() + "'");
        waitFor("a display", [&] { return !get("display").empty() && get("display").back() == '\n'; });
        display_ = ":" + get("display").substr(0, get("display").find('\n'));
        shell(in + "DISPLAY=" + display_ + " LIMPID_VALIDATION=1 '" + LIMPID_PROGRAM + "' view " + arguments +
                  " --settings kept.json --device cpu --width 460 --height 1700 --shrink " +
                  std::to_string(shrink) +
                  " --controls "
                  "controls >log 2>&1 & echo "
                  "$! > '" +
                  (folder_ / "view.pid").string() + "'; wait $!; echo $? > '" + (folder_ / "code").string() +
                  "'",
              true);
        // The start page is for those who name no scene, not to be seen while the renderer starts.
        const bool named = !arguments.starts_with("--");
        // Without a scene, there are no frames. Before the first one of the method, there is a preview.
        waitFor("the panel", [&] {
            const auto drawn = controls();
            const auto status = drawn.find("status");
            const bool startPage = drawn.contains("start.cornell");
            if (named && startPage) throw std::runtime_error("the start page appears");
            return startPage || (number("frames") > 0 && status != drawn.end() &&
                                 status->second.value != "compiling shaders");
        });
        findWindow();
    }
    void findWindow() {
        window_ = output("xdotool search --name Limpid | tail -1");
        xdotool("windowfocus " + window_ + " sleep 0.5");
    }
    ~DrivenViewer() {
        kill("view.pid");
        kill("xvfb.pid");
        // The shell around the program writes its exit code: not while the next viewer starts in this folder.
        for (int i = 0; i < 200 && get("code").empty(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    DrivenViewer(const DrivenViewer&) = delete;
    DrivenViewer& operator=(const DrivenViewer&) = delete;

    /// Quits with the keyboard; returns the exit code.
    int leave() {
        xdotool("mousemove 450 1690 key Escape");
        return ended();
    }
    /// Waits for the program's end; returns the exit code.
    int ended() const {
        waitFor("the end", [&] { return !get("code").empty(); });
        return std::stoi(get("code"));
    }

    std::map<std::string, Control> controls() const {
        std::map<std::string, Control> result;
        std::istringstream lines(get("controls"));
        for (std::string line; std::getline(lines, line);) {
            std::istringstream parts(line);
            Control c;
            std::string name;
            if (parts >> c.left >> c.top >> c.right >> c.bottom && parts.get() == '\t' &&
                std::getline(parts, name, '\t')) {
                std::getline(parts, c.value);
                result[name] = c;
            }
        }
        return result;
    }
    std::string fact(const std::string& name) const {
        std::istringstream lines(get("controls"));
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with(name + "\t")) return line.substr(name.size() + 1);
        }
        return {};
    }
    double number(const std::string& name) const {
        const std::string text = fact(name);
        return text.empty() ? 0.0 : std::stod(text);
    }
    std::string value(const std::string& name) const { return at(name).value; }
    Control at(const std::string& name) const {
        const auto all = controls();
        const auto found = all.find(name);
        if (found == all.end())
            throw std::runtime_error("there is no control '" + name + "' in\n" + get("controls"));
        return found->second;
    }

    /// Scrolls the panel until the control lies in it.
    Control reveal(const std::string& name) const {
        for (int i = 0; i < 40; ++i) {
            const Control c = at(name), panel = at("panel");
            const bool isInPanel = c.left >= panel.left && name.find('=') == std::string::npos;
            const bool isAbove = c.top<panel.top, isBelow = c.bottom> panel.bottom;
            if (!isInPanel || !(isAbove || isBelow) || !scrolls(name)) return c;
            xdotool("mousemove " + std::to_string(static_cast<int>(panel.left + 14)) + " " +
                    std::to_string(static_cast<int>(0.5f * (panel.top + panel.bottom))) +
                    " sleep 0.1 click " + (isAbove ? "4" : "5") + " sleep 0.2");
        }
        throw std::runtime_error("cannot scroll to '" + name + "'");
    }
    void click(const std::string& name) const { press(name, 0.03); }
    void hover(const std::string& name) const {
        const Control c = reveal(name);
        xdotool(fmt::format("mousemove {} {}", static_cast<int>(c.left) + 10,
                            static_cast<int>(0.5f * (c.top + c.bottom))));
    }
    /// Clicks at a fraction of the control's width.
    void press(const std::string& name, double share) const {
        const Control c = reveal(name);
        const double before = number("clicks");
        xdotool(fmt::format("mousemove {} {} click 1",
                            static_cast<int>(c.left + share * (c.right - c.left) + 3),
                            static_cast<int>(0.5f * (c.top + c.bottom))));
        waitFor("the window to see a click on " + name, [&] { return number("clicks") > before; });
    }
    /// Types a number into a slider or drag control, at a fraction of its width. `keys` follow at once.
    void type(const std::string& name, const std::string& text, double share = 0.03,
              const std::string& keys = "") const {
        const Control c = reveal(name);
        xdotool(
            "mousemove " + std::to_string(static_cast<int>(c.left + share * (c.right - c.left) + 3)) + " " +
            std::to_string(static_cast<int>(0.5f * (c.top + c.bottom))) +
            " sleep 0.15 keydown ctrl sleep 0.1 mousedown 1 sleep 0.15 mouseup 1 sleep 0.1 keyup ctrl sleep "
            "0.15 key ctrl+a sleep 0.1 type --delay 30 -- " +
            text);
        xdotool("sleep 0.2 key Return " + keys + " sleep 0.1");
    }
    void choose(const std::string& name, const std::string& choice) const {
        click(name);
        waitFor("the list of " + name, [&] { return controls().contains(name + "=" + choice); });
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        press(name + "=" + choice, 0.1);
        waitFor(name + " to be " + choice, [&] { return value(name) == choice; });
    }
    void xdotool(const std::string& arguments) const {
        shell("DISPLAY=" + display_ + " xdotool " + arguments);
    }
    /// Runs a program on the viewer's display.
    void run(const std::string& command) const { shell("DISPLAY=" + display_ + " " + command); }
    const std::string& window() const { return window_; }

    /// Returns the bytes of limpid.png once the picture has `samples` and rendering has stopped.
    std::string settledPicture() const {
        std::string last;
        waitFor("the picture to settle", [&] {
            const std::string now = fact("frames") + " " + fact("samples");
            const bool same = now == last && fact("rendering") == "no";
            last = now;
            std::this_thread::sleep_for(std::chrono::milliseconds(150));
            return same;
        });
        fs::remove(folder_ / "limpid.png");
        click("screenshot");
        waitFor("a screenshot", [&] { return fs::exists(folder_ / "limpid.png"); });
        // The renderer writes the file before the window hears of it.
        waitFor("its message", [&] { return fact("message").starts_with("wrote"); });
        return get("limpid.png");
    }

    /// Processor time so far in seconds; memory in bytes.
    double processorSeconds() const {
        std::istringstream stat(slurp("/proc/" + pid() + "/stat"));
        std::string skipped;
        for (int i = 0; i < 13; ++i) stat >> skipped;
        double user = 0.0, system = 0.0;
        stat >> user >> system;
        return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
    }
    double residentBytes() const {
        std::istringstream statm(slurp("/proc/" + pid() + "/statm"));
        double all = 0.0, resident = 0.0;
        statm >> all >> resident;
        return resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
    }

    void waitFor(const std::string& what, const std::function<bool()>& done) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(240);
        while (!done()) {
            const bool ended = !get("code").empty();
            if (ended && done()) break;  // with its last file
            if (ended || std::chrono::steady_clock::now() > end)
                throw std::runtime_error((ended ? "the program ended before " : "waited in vain for ") +
                                         what + "; log:\n" + get("log") + get("controls"));
            std::this_thread::sleep_for(std::chrono::milliseconds(15));
        }
    }
    std::string get(const std::string& name) const { return slurp(folder_ / name); }

  private:
    /// The panel's bar and status stay where they are.
    static bool scrolls(const std::string& name) {
        for (const char* fixed :
             {"running", "step", "reset", "undo", "redo", "keys", "search", "cancel", "panel edge"})
            if (name == fixed) return false;
        return true;
    }
    static std::string slurp(const fs::path& file) {
        std::ifstream stream(file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static void shell(const std::string& command, bool background = false) {
        if (::system((background ? "(" + command + ") &" : command).c_str()) != 0)
            throw std::runtime_error("failed: " + command);
    }
    std::string output(const std::string& command) const {
        shell("DISPLAY=" + display_ + " " + command + " > '" + (folder_ / "output").string() + "'");
        std::string text = get("output");
        return text.substr(0, text.find('\n'));
    }
    /// The process id of the program, not of a shell around it.
    std::string pid() const { return get("view.pid").substr(0, get("view.pid").find('\n')); }
    void kill(const char* file) const {
        const std::string text = get(file);
        if (!text.empty()) ::kill(static_cast<pid_t>(std::stol(text)), SIGTERM);
    }

    fs::path folder_;
    std::string display_, window_;
};

}  // namespace limpid

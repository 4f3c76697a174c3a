#include "viewer/viewer_window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "studio/state_json.h"
#include "viewer/camera/steering.h"

namespace limpid::viewer {
namespace {

using studio::Clock;
using studio::Request;

constexpr double idleSeconds = 1.0;            ///< longest wait for an event
constexpr double shortestFrame = 1.0 / 120.0;  ///< seconds between two pictures of the window
constexpr double longestStep = 0.1;  ///< maximum seconds that a held key moves the camera per picture
constexpr int restlessPictures = 4;  ///< drawn after the last event, until the panel has settled

gpu::DeviceOptions presenting(gpu::DeviceOptions options) {
    options.surfaceExtensions = Window::surfaceExtensions();
    return options;
}

}  // namespace

ViewerWindow::Screen::Screen(Window& window, const gpu::DeviceOptions& options)
    : device(presenting(options)), display(window, device) {}

ViewerWindow::ViewerWindow(const gpu::DeviceOptions& options, const ViewSettings& settings)
    : options_(options),
      settings_(settings),
      window_("Limpid", settings.studio.render.extent),
      screen_(std::make_unique<Screen>(window_, options)),
      shown_(std::make_shared<studio::Shown>()) {}

void ViewerWindow::run(studio::Studio& studio) {
    const uint64_t listener = studio.addListener([&] { window_.wake(); });
    auto last = Clock::now();
    int restless = restlessPictures;
    while (!window_.closed() && !studio.hasEnded()) {
        const double due = shortestFrame - studio::secondsSince(last);
        if (window_.poll(restless > 0 ? std::max(due, 0.0) : idleSeconds)) restless = restlessPictures;
        if (!window_.input().empty() || hasNews(studio)) restless = restlessPictures;
        if (restless == 0 || studio::secondsSince(last) < shortestFrame) continue;
        const double seconds = std::min(studio::secondsSince(std::exchange(last, Clock::now())), longestStep);
        try {
            draw(studio, seconds);
        } catch (const gpu::DeviceLost& lost) {
            log::error("{}; the window is set up anew", lost.what());
            screen_.reset();
            screen_ = std::make_unique<Screen>(window_, options_);
        }
        --restless;
    }
    studio.removeListener(listener);
    shown_ = studio.shown();
    takeState();
}

void ViewerWindow::finish() {
    screen_->device.waitIdle();
    if (const uint64_t messages = screen_->device.validationMessages(); messages > 0)
        throw Error(fmt::format("the validation layer reported {} messages about the window", messages));
}

bool ViewerWindow::hasNews(const studio::Session& session) {
    return session.shown()->number != shown_->number;
}

/// One picture of the window.
void ViewerWindow::draw(studio::Session& session, double seconds) {
    shown_ = session.shown();
    takeState();
    const nlohmann::json before = studio::toJson(panel_.state);
    screen_->display.begin();
    controls_.begin();
    panel_.state.viewport = window_.pixels();
    handleInput(session, seconds);
    drawPanel(panel_, shown_->facts, controls_);
    sendChanges(session, before);
    noteCommand();
    screen_->display.present(panel_, *shown_);
    writeControls();
}

/// Takes the state over from the snapshot, with the edits that it does not include yet.
void ViewerWindow::takeState() {
    const studio::CameraPose held = panel_.state.pose;
    panel_.state = shown_->state;
    std::erase_if(pending_, [&](const Pending& edit) { return edit.number <= shown_->messages; });
    for (const Pending& edit : pending_) {
        try {
            studio::apply(panel_.state, edit.changes);
        } catch (const Error&) {  // it no longer fits: another scene has other lights
        }
    }
    // The camera normalises `up`. Showing that at once would disturb the user's typing.
    if (panel_.holdsPose) panel_.state.pose = held;
}

void ViewerWindow::sendChanges(studio::Session& session, const nlohmann::json& before) {
    nlohmann::json changes = studio::changesOf(before, studio::toJson(panel_.state));
    if (!changes.empty()) {
        const uint64_t number = session.edit(changes);
        pending_.push_back({number, std::move(changes)});
    }
    for (Request& request : panel_.asked) session.ask(std::move(request));
    panel_.asked.clear();
    for (const std::string& file : window_.takeDropped())
        session.ask({.kind = Request::Kind::OpenDropped, .file = file});
}

void ViewerWindow::handleInput(studio::Session& session, double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    studio::State& state = panel_.state;
    Display& display = screen_->display;
    const auto pressed = [&](int key) { return !io.WantTextInput && ImGui::IsKeyPressed(key, false); };
    const auto ask = [&](Request::Kind kind) {
        panel_.asked.push_back({.kind = kind, .position = display.mousePosition()});
    };
    if (pressed(GLFW_KEY_ESCAPE)) window_.close();
    if (pressed(GLFW_KEY_TAB)) panel_.shown = !panel_.shown;
    if (pressed(GLFW_KEY_SPACE)) state.running = !state.running;
    if (pressed(GLFW_KEY_P)) ask(Request::Kind::Probe);
    if (pressed(GLFW_KEY_V)) state.setPreview(!state.isPreview());
    const bool divides = display.dragsDivider(panel_, controls_);
    if (io.WantCaptureMouse || divides) return;
    if (display.clickedTwice()) ask(Request::Kind::Focus);
    if (const studio::Gesture gesture = gestureNow(static_cast<float>(seconds)); gesture.moves())
        session.steer(gesture);
}

/// Copies the command line that was asked for, and names the window after the scene.
void ViewerWindow::noteCommand() {
    const studio::Facts& facts = shown_->facts;
    if (std::exchange(commands_, facts.commands) != facts.commands) window_.setClipboard(facts.command);
    if (std::exchange(title_, facts.scene) != facts.scene) window_.setTitle("Limpid: " + facts.scene);
}

/// Writes the controls' positions to the file for tests, if any has changed.
void ViewerWindow::writeControls() {
    if (settings_.controls.empty()) return;
    const studio::Facts& facts = shown_->facts;
    std::string values = facts.allValues;
    std::ranges::replace(values, '\n', ';');
    const std::string text =
        fmt::format(
            "frames\t{}\nsamples\t{}\nfault\t{}\nmessage\t{}\nprobe\t{}\nvalues\t{}\ncompared\t{}\n"
            "scenes\t{}\nactivity\t{}\nrendering\t{}\n",
            facts.frames, facts.samplesInMean, facts.fault, facts.message, panel_.probe, values,
            facts.comparedWith, facts.scenesShown, facts.activity,
            facts.computing || !pending_.empty() ? "yes" : "no") +
        controls_.text();
    if (text == controlsText_) return;
    controlsText_ = text;
    writeTextAtomically(settings_.controls, text);
}

}  // namespace limpid::viewer

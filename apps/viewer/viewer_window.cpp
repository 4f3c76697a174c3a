#include "viewer/viewer_window.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>  // closes popups

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.h"
#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "studio/state/state_json.h"
#include "viewer/camera/steering.h"
#include "viewer/panel/key_map.h"
#include "viewer/start/start_page.h"

namespace limpid::viewer {
namespace {

using studio::Request;

constexpr double idleSeconds = 1.0;            ///< longest wait for an event
constexpr double shortestFrame = 1.0 / 120.0;  ///< seconds between two pictures of the window
constexpr double handSeconds = 0.5;            ///< after an event, pictures follow as fast as they can
constexpr double cpuPeriod = 2.0;              ///< on CPUs, as a multiple of the time that drawing takes
constexpr double longestPeriod = 0.25;
constexpr double longestStep = 0.1;  ///< maximum seconds that a held key moves the camera per picture
constexpr int restlessPictures = 4;  ///< drawn after the last event, until the panel has settled

gpu::DeviceOptions presenting(gpu::DeviceOptions options) {
    options.surfaceExtensions = Window::surfaceExtensions();
    return options;
}

/// The size of a window whose picture has the extent that was asked for.
gpu::Extent withPanel(const ViewSettings& settings, const Memory& memory) {
    gpu::Extent size = settings.studio.render.extent;
    const float usual = panelWidthBeside(static_cast<float>(size.width));
    size.width += static_cast<uint32_t>(memory.panelWidth > 0.0f ? memory.panelWidth : usual);
    return size;
}

uint32_t pixelsOf(float length, float scale) {
    return static_cast<uint32_t>(std::lround(length * scale));
}

}  // namespace

ViewerWindow::Screen::Screen(Window& window, const gpu::DeviceOptions& options)
    : device(presenting(options)), display(window, device) {}

ViewerWindow::ViewerWindow(const gpu::DeviceOptions& options, const ViewSettings& settings)
    : options_(options),
      settings_(settings),
      window_("Limpid", withPanel(settings, readMemory(memoryFile(settings.kept)))),
      screen_(std::make_unique<Screen>(window_, options)),
      shown_(std::make_shared<studio::Shown>()),
      awaitsScene_(!settings.studio.source.scene.empty()) {
    panel_.memory = readMemory(memoryFile(settings.kept));
    chooseRange();
    const float scale = screen_->display.interface().scale();
    if (panel_.memory.panelWidth == 0.0f && scale > 1.0f) {
        const uint32_t picture = settings.studio.render.extent.width;
        const float panel = scale * panelWidthBeside(static_cast<float>(picture) / scale);
        window_.resize({picture + static_cast<uint32_t>(panel), window_.size().height});
    }
}

/// What the command line says of HDR, over what the window remembers.
void ViewerWindow::chooseRange() {
    Memory& memory = panel_.memory;
    memory.hdr = settings_.hdr.value_or(memory.hdr);
    memory.paperWhite = settings_.paperWhite.value_or(memory.paperWhite);
    memory.peak = settings_.peak.value_or(memory.peak);
    const std::string fault = screen_->display.highRangeFault();
    if (settings_.hdr.value_or(false) && !fault.empty())
        log::warn("--hdr on: {}; the window has the range of sRGB", fault);
}

/// Tells the studio which range its pictures are for.
void ViewerWindow::noteRange() {
    panel_.hdrFault = screen_->display.highRangeFault();
    const bool extended = panel_.memory.hdr && panel_.hdrFault.empty();
    if (std::exchange(extended_, extended) != extended)
        panel_.asked.push_back({.kind = Request::Kind::Extended, .index = extended ? 1 : 0});
}

void ViewerWindow::run(studio::Studio& studio) {
    const uint64_t listener = studio.addListener([&] { window_.wake(); });
    auto last = Clock::now(), touched = last;
    double period = shortestFrame;
    int restless = restlessPictures;
    while (!window_.closed() && !studio.hasEnded()) {
        const double due = period - secondsSince(last);
        const bool hasEvents = window_.poll(restless > 0 ? std::max(due, 0.0) : idleSeconds);
        if (hasEvents || !window_.input().empty()) touched = Clock::now();
        if (touched >= last || hasNews(studio)) restless = restlessPictures;
        if (shown_->facts.computing && secondsSince(last) >= idleSeconds) restless = std::max(restless, 1);
        if (secondsSince(touched) < handSeconds) period = shortestFrame;
        if (restless == 0 || secondsSince(last) < period) continue;
        const double seconds = std::min(secondsSince(std::exchange(last, Clock::now())), longestStep);
        try {
            draw(studio, seconds);
        } catch (const gpu::DeviceLost& lost) {
            log::error("{}; the window is set up anew", lost.what());
            screen_.reset();
            screen_ = std::make_unique<Screen>(window_, options_);
        }
        period = periodAfter(secondsSince(last));
        --restless;
        if (panel_.passPreview.isAboutToShow()) restless = std::max(restless, 1);
    }
    studio.removeListener(listener);
    shown_ = studio.shown();
    takeState();
    try {
        writeMemory(memoryFile(settings_.kept), panel_.memory);
    } catch (const Error& fault) {
        log::warn("{}", fault.what());
    }
}

void ViewerWindow::finish() {
    screen_->device.waitIdle();
    if (const uint64_t messages = screen_->device.validationMessages(); messages > 0)
        throw Error(fmt::format("the validation layer reported {} messages about the window", messages));
}

/// From the start of one picture to that of the next. On CPUs, the window takes time from the renderer: while
/// no hand waits for it, it leaves half of it.
double ViewerWindow::periodAfter(double drawSeconds) const {
    if (!screen_->device.isCpu()) return shortestFrame;
    return std::clamp(cpuPeriod * drawSeconds, shortestFrame, longestPeriod);
}

bool ViewerWindow::hasNews(const studio::Session& session) {
    return session.shown()->number != shown_->number;
}

/// One picture of the window.
void ViewerWindow::draw(studio::Session& session, double seconds) {
    shown_ = session.shown();
    takeState();
    panel_.values = studio::toJson(panel_.state);
    Display& display = screen_->display;
    display.begin(panel_.memory.dark);
    controls_.begin();
    controls_.setGroup("");
    const ImGuiIO& io = ImGui::GetIO();
    const float scale = display.interface().scale();
    panel_.area = pictureArea(panel_, io.DisplaySize.x, io.DisplaySize.y, scale);
    noteRange();
    panel_.state.viewport = window_.pixels();
    if (panel_.state.viewport.width > 0)
        panel_.state.viewport = {pixelsOf(panel_.area.width, io.DisplayFramebufferScale.x),
                                 pixelsOf(panel_.area.height, io.DisplayFramebufferScale.y)};
    handleInput(session, seconds);
    const Drawing with{panel_, shown_->facts, controls_};
    if (shown_->facts.scenesShown == 0 && !awaitsScene())
        drawStartPage(with, display.interface().thumbnails());
    drawPanel(with, scale);
    if (panel_.showsKeys) drawKeyMap(controls_);
    sendChanges(session);
    noteOpened();
    noteCommand();
    noteLayout();
    display.present(panel_, *shown_);
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

void ViewerWindow::sendChanges(studio::Session& session) {
    nlohmann::json changes = studio::changesOf(panel_.values, studio::toJson(panel_.state));
    if (!changes.empty()) {
        noteStep(changes);
        const uint64_t number = session.edit(changes);
        pending_.push_back({number, std::move(changes)});
    }
    if (!ImGui::IsAnyItemActive() && !ImGui::IsAnyMouseDown()) panel_.history.endStep();
    for (const std::string& file : window_.takeDropped())
        panel_.asked.push_back({.kind = Request::Kind::OpenDropped, .file = file});
    panel_.steps = false;
    for (Request& request : panel_.asked) session.ask(std::move(request));
    panel_.asked.clear();
}

/// Keeps an edit for undo, unless it is one of undo itself. The window's size and the pass that is looked at
/// (which follows the pointer) are none.
void ViewerWindow::noteStep(nlohmann::json changes) {
    changes.erase("viewport");
    changes.erase("pass");
    // A hand may move on from the camera that is chosen: undo puts the free one back to where it was.
    if (changes.contains("camera") && panel_.values.at("camera") == 0) {
        for (const char* const key : {"eye", "target", "up", "fov", "half_height"})
            changes[key] = panel_.values.at(key);
    }
    if (!panel_.steps) panel_.history.note(changes, panel_.values);
}

void ViewerWindow::handleInput(studio::Session& session, double seconds) {
    handleKeys();
    const ImGuiIO& io = ImGui::GetIO();
    Display& display = screen_->display;
    const bool divides = display.dragsDivider(panel_, controls_);
    if (io.WantCaptureMouse || divides || panel_.showsKeys) return;
    if (display.interface().clickedTwice())
        panel_.asked.push_back(
            {.kind = Request::Kind::Focus, .position = Display::mousePosition(panel_.area)});
    if (const studio::Gesture gesture = gestureNow(static_cast<float>(seconds)); gesture.moves())
        session.steer(gesture);
}

void ViewerWindow::handleKeys() {
    const ImGuiIO& io = ImGui::GetIO();
    studio::State& state = panel_.state;
    const auto pressed = [&](int key) { return !Interface::typesText() && ImGui::IsKeyPressed(key, false); };
    if (screen_->display.interface().askedForKeys()) panel_.showsKeys = !panel_.showsKeys;
    if (pressed(GLFW_KEY_ESCAPE)) handleEscape();
    if (io.KeyCtrl) {
        if (pressed(window_.keyOf('z'))) io.KeyShift ? redo(panel_) : undo(panel_);
        if (pressed(window_.keyOf('y')) && !io.KeyShift) redo(panel_);
        if (pressed(window_.keyOf('f'))) panel_.shown = panel_.focusesSearch = true;
        return;
    }
    if (pressed(GLFW_KEY_TAB)) panel_.shown = !panel_.shown;
    if (pressed(GLFW_KEY_SPACE)) state.running = !state.running;
    if (pressed(window_.keyOf('p')))
        panel_.asked.push_back(
            {.kind = Request::Kind::Probe, .position = Display::mousePosition(panel_.area)});
    if (pressed(window_.keyOf('v'))) state.setPreview(!state.isPreview());
}

/// Closes what is open, one thing at a time, and then the window.
void ViewerWindow::handleEscape() {
    if (std::exchange(panel_.showsKeys, false)) return;
    if (ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup)) return ImGui::ClosePopupToLevel(0, true);
    if (!std::exchange(panel_.search, "").empty()) return;
    window_.close();
}

/// Whether a scene was asked for and the studio has said nothing yet. The start page would flash up
/// otherwise.
bool ViewerWindow::awaitsScene() {
    const studio::Facts& facts = shown_->facts;
    awaitsScene_ = awaitsScene_ && facts.activity.empty() && facts.fault.empty();
    return awaitsScene_;
}

/// Remembers scenes that were opened. The steps of another scene cannot be undone.
void ViewerWindow::noteOpened() {
    const studio::Facts& facts = shown_->facts;
    if (std::exchange(scenesShown_, facts.scenesShown) == facts.scenesShown) return;
    const std::string opened = "opened ";
    if (scenesShown_ == 1 && !settings_.studio.source.scene.empty())
        panel_.memory.addRecent(settings_.studio.source.scene);
    else if (facts.message.starts_with(opened) && !facts.messageIsOld) {
        panel_.memory.addRecent(facts.message.substr(opened.size()));
    }
    if (facts.scene != title_) panel_.history.clear();
}

/// An error, or values that were asked for, bring the panel back.
void ViewerWindow::noteLayout() {
    const studio::Facts& facts = shown_->facts;
    const bool fault = std::exchange(fault_, facts.fault) != facts.fault && !fault_.empty(),
               values = std::exchange(values_, facts.allValues) != facts.allValues && !values_.empty();
    if (fault || values) panel_.shown = true;
    const Area& area = panel_.area;
    controls_.note("picture",
                   fmt::format("{}x{}", shown_->state.viewport.width, shown_->state.viewport.height),
                   area.left, area.top, area.left + area.width, area.top + area.height);
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    controls_.note("window", "", 0.0f, 0.0f, size.x, size.y);
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
    std::string reasons = panel_.reasons;
    std::ranges::replace(reasons, '\n', ';');
    const std::string text =
        fmt::format(
            "frames\t{}\nsamples\t{}\nfault\t{}\nmessage\t{}\nprobe\t{}\nreasons\t{}"
            "\nvalues\t{}\ncompared\t{}\n"
            "scenes\t{}\nactivity\t{}\nrendering\t{}\nclicks\t{}\n",
            facts.frames, facts.samplesInMean, facts.fault, facts.message, panel_.probe, reasons, values,
            facts.comparedWith, facts.scenesShown, facts.activityText(),
            facts.computing || !pending_.empty() || !window_.input().empty() ? "yes" : "no",
            window_.input().clicks()) +
        controls_.lines();
    if (text == controlsText_) return;
    controlsText_ = text;
    writeTextAtomically(settings_.controls, text);
}

}  // namespace limpid::viewer

// The window and the loop that draws it. It never waits for the renderer: it shows the newest snapshot of a
// session, and sends what the user does.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "studio/session.h"
#include "studio/studio.h"
#include "viewer/camera/controls.h"
#include "viewer/compare/display.h"
#include "viewer/panel/panel.h"
#include "viewer/viewer.h"
#include "viewer/window.h"

namespace limpid::viewer {

class ViewerWindow {
  public:
    ViewerWindow(const gpu::DeviceOptions& options, const ViewSettings& settings);
    /// Until it is closed, or the studio ends.
    void run(studio::Studio& studio);
    /// As the user left it.
    const studio::State& state() const { return panel_.state; }
    /// Throws Error if the validation layer has reported anything about the window's device.
    void finish();

  private:
    /// The device of the window: on the studio's, frames of the renderer would delay the interface's.
    struct Screen {
        Screen(Window& window, const gpu::DeviceOptions& options);
        gpu::Device device;
        Display display;
    };

    double periodAfter(double drawSeconds) const;
    bool hasNews(const studio::Session& session);
    void draw(studio::Session& session, double seconds);
    void takeState();
    void sendChanges(studio::Session& session);
    void noteStep(nlohmann::json changes);
    void handleInput(studio::Session& session, double seconds);
    void handleKeys();
    void handleEscape();
    bool awaitsScene();
    void noteOpened();
    void noteCommand();
    void chooseRange();
    void noteRange();
    void noteLayout();
    void writeControls();

    gpu::DeviceOptions options_;
    ViewSettings settings_;
    Window window_;
    std::unique_ptr<Screen> screen_;
    PanelState panel_;
    Controls controls_;
    std::string controlsText_;  ///< as last written
    std::shared_ptr<const studio::Shown> shown_;
    /// Edits that the snapshot does not include yet: they are applied to it again, so that controls do not
    /// jump back.
    struct Pending {
        uint64_t number;
        nlohmann::json changes;
    };
    std::deque<Pending> pending_;
    uint64_t commands_ = 0;
    std::string title_;
    int scenesShown_ = 0;
    bool awaitsScene_ = false;    ///< the studio has not yet begun to load the scene that was asked for
    bool extended_ = false;       ///< what the studio was told of its pictures' range
    std::string fault_, values_;  ///< those of the snapshot before
};

}  // namespace limpid::viewer

// Dear ImGui: its context, its input from the window, and its triangles for the presenter.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "gpu/present/presenter.h"
#include "viewer/start/thumbnails.h"
#include "viewer/window.h"

namespace limpid::viewer {

class Interface {
  public:
    Interface(Window& window, gpu::Presenter& presenter);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    /// Between the two, ImGui's calls. `dark`: the theme.
    void begin(bool dark);
    /// The left button has gone down for the second time.
    bool clickedTwice() const { return clickedTwice_; }
    /// A question mark was typed, and not into a text.
    bool askedForKeys() const { return askedForKeys_; }
    const Thumbnails& thumbnails() const { return thumbnails_; }
    /// Whether keys are for a text that is being typed.
    static bool typesText();
    /// How much larger than nominal everything is drawn.
    float scale() const { return scale_; }
    /// Valid until the next begin().
    gpu::Overlay end();

  private:
    void apply(const InputEvent& event);

    Window& window_;
    float scale_;
    std::optional<bool> dark_;
    Thumbnails thumbnails_;
    InputEvent mouse_{.x = -std::numeric_limits<float>::max(), .y = -std::numeric_limits<float>::max()};
    std::array<bool, 5> buttons_{};
    bool clickedTwice_ = false, askedForKeys_ = false;
    std::vector<gpu::OverlayVertex> vertices_;
    std::vector<uint16_t> indices_;
    std::vector<gpu::OverlayDraw> draws_;
};

}  // namespace limpid::viewer

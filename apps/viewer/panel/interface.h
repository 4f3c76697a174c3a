// Dear ImGui: its context, its input from the window, and its triangles for the presenter.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "gpu/present/presenter.h"
#include "viewer/window.h"

namespace limpid::viewer {

class Interface {
  public:
    Interface(Window& window, gpu::Presenter& presenter);
    ~Interface();
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;

    /// Between the two, ImGui's calls.
    void begin();
    /// The left button has gone down for the second time.
    bool clickedTwice() const { return clickedTwice_; }
    /// Valid until the next begin().
    gpu::Overlay end();

  private:
    void apply(const InputEvent& event);

    Window& window_;
    InputEvent mouse_{.x = -std::numeric_limits<float>::max(), .y = -std::numeric_limits<float>::max()};
    std::array<bool, 5> buttons_{};
    bool clickedTwice_ = false;
    std::vector<gpu::OverlayVertex> vertices_;
    std::vector<uint16_t> indices_;
    std::vector<gpu::OverlayDraw> draws_;
};

}  // namespace limpid::viewer

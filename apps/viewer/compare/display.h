// What is seen in the window: the picture, what it is compared with beside it, images of passes, a magnifier,
// arrows; and the panel over them.
#pragma once

#include <tuple>

#include "viewer/compare/inspector.h"
#include "viewer/compare/texels.h"
#include "viewer/live_render.h"
#include "viewer/panel/interface.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// `left` up to the divider (0 to 1), `right` beyond it: each shows its own part of the window. The divider
/// falls between two pixels of the picture.
std::array<gpu::Pane, 2> splitPanes(const gpu::Pane& left, const gpu::Pane& right, gpu::Extent picture,
                                    float divider);

/// A square of the window beside the mouse that enlarges the pixels under it. `mouse` in pixels of the
/// window, `number` counts squares side by side.
gpu::Pane magnified(const gpu::Pane& pane, gpu::Extent picture, gpu::Extent window,
                    const std::array<float, 2>& mouse, int number);

class Display {
  public:
    Display(Window& window, gpu::Device& device);

    /// ImGui's frame begins.
    void begin() { interface_.begin(); }
    bool clickedTwice() const { return interface_.clickedTwice(); }
    /// Whether the mouse moves the divider, and so not the camera.
    bool dragsDivider(PanelState& panel, Controls& controls);
    /// The frame ends and is shown. `other`: what the picture is compared with, or null.
    void present(PanelState& panel, PanelFacts& facts, LiveRender& main, LiveRender* other);
    /// Of all images of all passes, the values under the mouse, one a line.
    std::string probeAll(LiveRender& main) const;
    /// The pixel of the picture under the mouse.
    std::array<uint32_t, 2> pixelUnderMouse(gpu::Extent picture) const;

  private:
    bool inspect(PanelState& panel, PanelFacts& facts, LiveRender& main);
    std::string probeOf(const image::Image& picture) const;
    static std::string valuesAt(const image::Image& picture, uint32_t x, uint32_t y);
    void drawMagnifier(std::vector<gpu::Pane>& panes, gpu::Extent picture) const;
    /// `left` and the comparison's name stand beside it.
    void drawDivider(const std::string& left, const PanelState& panel, const PanelFacts& facts) const;
    void drawArrows(LiveRender& main);

    Window& window_;
    gpu::Device& device_;
    gpu::Presenter presenter_;
    Interface interface_;
    Texels inspector_;
    std::vector<std::pair<std::string, image::Image>> images_;  ///< of the pass that is inspected
    std::tuple<uint64_t, std::string, int, InspectorView> inspected_;
    image::Image motion_;
    uint64_t motionOf_ = 0;
    bool dragging_ = false;
};

}  // namespace limpid::viewer

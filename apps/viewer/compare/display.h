// What is seen in the window: the picture, what it is compared with beside it, images of passes, a magnifier,
// arrows; and the panel over them.
#pragma once

#include <array>
#include <memory>

#include "studio/compare/inspector.h"
#include "studio/live_render.h"
#include "viewer/compare/texels.h"
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
    /// The frame ends and is shown.
    void present(PanelState& panel, const studio::Shown& shown);
    /// The mouse's position in the picture, 0 to 1.
    std::array<float, 2> mousePosition() const;

  private:
    void inspect(PanelState& panel, const studio::Shown& shown);
    std::string probeOf(const image::Image& picture) const;
    void drawMagnifier(std::vector<gpu::Pane>& panes, gpu::Extent picture) const;
    /// `left` and the comparison's name stand beside it.
    void drawDivider(const std::string& left, const PanelState& panel, const studio::Facts& facts) const;
    std::array<uint32_t, 2> pixelUnderMouse(gpu::Extent picture) const;

    /// A picture on the device of this window.
    struct Uploaded {
        std::shared_ptr<const studio::Picture> picture;
        Texels texels;
        void show(gpu::Device& device, const std::shared_ptr<const studio::Picture>& now);
    };

    Window& window_;
    gpu::Device& device_;
    gpu::Presenter presenter_;
    Interface interface_;
    Uploaded main_, compared_;
    Texels inspector_;
    std::shared_ptr<const image::Image> inspected_;
    studio::InspectorView inspectedBy_;
    bool dragging_ = false;
};

}  // namespace limpid::viewer

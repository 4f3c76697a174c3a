// What is seen in the window: the picture, what it is compared with beside it, images of passes, a magnifier,
// arrows; and the panel on their right.
#pragma once

#include <array>
#include <memory>

#include "studio/compare/inspector.h"
#include "studio/live/live_render.h"
#include "viewer/compare/texels.h"
#include "viewer/panel/interface.h"
#include "viewer/panel/panel.h"

namespace limpid::viewer {

/// `left` up to the divider (0 to 1), `right` beyond it: each shows its own part of the area. The divider
/// falls between two pixels of the picture.
std::array<gpu::Pane, 2> splitPanes(const gpu::Pane& left, const gpu::Pane& right, gpu::Extent picture,
                                    float divider);

/// A square beside the mouse that enlarges the pixels under it. `area`: what the picture is shown in, and
/// `mouse` in it, in pixels; `number` counts squares side by side.
gpu::Pane magnified(const gpu::Pane& pane, gpu::Extent picture, gpu::Extent area,
                    const std::array<float, 2>& mouse, int number);

/// A part of the area, 0 to 1, as a part of a window of this size.
gpu::Rectangle placed(const gpu::Rectangle& inArea, const Area& area, float width, float height);

class Display {
  public:
    Display(Window& window, gpu::Device& device);

    /// ImGui's frame begins.
    void begin(bool dark) { interface_.begin(dark); }
    const Interface& interface() const { return interface_; }
    /// Whether the mouse moves the divider, and so not the camera.
    bool dragsDivider(PanelState& panel, Controls& controls);
    /// The frame ends and is shown.
    void present(PanelState& panel, const studio::Shown& shown);
    /// Why the window cannot show a high dynamic range; empty: it can.
    std::string highRangeFault() const { return presenter_.highRangeFault(); }
    /// The mouse's position in the picture, 0 to 1.
    static std::array<float, 2> mousePosition(const Area& area);

  private:
    void inspect(PanelState& panel, const studio::Shown& shown);
    static std::string probeOf(const image::Image& picture, const Area& area);
    /// `left` and the comparison's name stand beside it.
    static void drawDivider(const std::string& left, const PanelState& panel, const studio::Facts& facts);

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

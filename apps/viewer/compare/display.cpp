#include "viewer/compare/display.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "studio/compare/history_text.h"
#include "viewer/compare/motion_arrows.h"
#include "viewer/looks/theme.h"

namespace limpid::viewer {
namespace {

constexpr float dividerReach = 6.0f;        ///< pixels of the window on either side
constexpr uint32_t magnifiedPixels = 21;    ///< of the picture, per side: odd, so that one is in the middle
constexpr float magnifierSide = 210.0f;     ///< pixels of the window
constexpr float magnifierDistance = 24.0f;  ///< from the mouse
constexpr float crossGap = 4.0f, crossReach = 12.0f;  ///< from the middle, pixels of the window
constexpr ImU32 lineColor = IM_COL32(255, 255, 255, 200), shadowColor = IM_COL32(0, 0, 0, 160);

float length(uint32_t pixels) {
    return static_cast<float>(std::max(pixels, 1u));
}

gpu::Extent extentOf(const gpu::Pane& pane) {
    return pane.graph->extent(pane.picture);
}

void drawArrows(const image::Image& motion, const Area& area) {
    ImDrawList& marks = *ImGui::GetBackgroundDrawList();
    for (const Arrow& arrow : motionArrows(motion, area.width, area.height)) {
        const ImVec2 from{area.left + arrow.from.x, area.top + arrow.from.y},
            to{area.left + arrow.to.x, area.top + arrow.to.y};
        marks.AddLine(from, to, shadowColor, 3.0f);
        marks.AddLine(from, to, lineColor, 1.0f);
        const auto head = arrowHead(arrow);
        const auto corner = [&](size_t i) { return ImVec2{area.left + head[i].x, area.top + head[i].y}; };
        marks.AddTriangleFilled(corner(0), corner(1), corner(2), lineColor);
    }
}

/// Where there is no picture yet.
void drawStage(const PanelState& panel) {
    const Area& area = panel.area;
    ImGui::GetBackgroundDrawList()->AddRectFilled({area.left, area.top},
                                                  {area.left + area.width, area.top + area.height},
                                                  accentsOf(panel.memory.dark).stage);
}

void drawLabel(ImDrawList& marks, ImVec2 at, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    marks.AddRectFilled({at.x - 4, at.y - 2}, {at.x + size.x + 4, at.y + size.y + 2}, shadowColor);
    marks.AddText(at, IM_COL32_WHITE, text.c_str());
}

/// A cross where the values were read that the panel shows.
void drawProbe(const studio::Facts& facts, const Area& area) {
    if (facts.allValues.empty()) return;
    const float x = area.left + facts.probedAt[0] * area.width,
                y = area.top + facts.probedAt[1] * area.height;
    ImDrawList& marks = *ImGui::GetBackgroundDrawList();
    for (const auto& [color, width] : {std::pair(shadowColor, 3.0f), std::pair(lineColor, 1.0f)}) {
        for (const float side : {-1.0f, 1.0f}) {
            marks.AddLine({x + side * crossGap, y}, {x + side * crossReach, y}, color, width);
            marks.AddLine({x, y + side * crossGap}, {x, y + side * crossReach}, color, width);
        }
    }
}

/// What is shown instead of the picture.
std::string nameOfInspected(const studio::Shown& shown) {
    const std::string& pass = shown.state.pass;
    const auto number = static_cast<size_t>(shown.state.image);
    if (number >= shown.facts.images.size() || shown.facts.images[number] == pass) return pass;
    return pass + ": " + shown.facts.images[number];
}

std::array<uint32_t, 2> pixelUnderMouse(gpu::Extent picture, const Area& area) {
    const auto [x, y] = Display::mousePosition(area);
    return {static_cast<uint32_t>(x * length(picture.width)),
            static_cast<uint32_t>(y * length(picture.height))};
}

/// Adds an enlarged part of each pane, and marks it.
void drawMagnifier(std::vector<gpu::Pane>& panes, gpu::Extent picture, const Area& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 scale = io.DisplayFramebufferScale;
    if (io.WantCaptureMouse || !ImGui::IsMousePosValid()) return;
    const std::array<float, 2> mouse{(io.MousePos.x - area.left) * scale.x,
                                     (io.MousePos.y - area.top) * scale.y};
    const gpu::Extent pixels{static_cast<uint32_t>(area.width * scale.x),
                             static_cast<uint32_t>(area.height * scale.y)};
    ImDrawList& marks = *ImGui::GetBackgroundDrawList();
    const size_t shown = panes.size();
    for (size_t i = 0; i < shown; ++i) {
        const gpu::Pane glass = magnified(panes[i], picture, pixels, mouse, static_cast<int>(i));
        panes.push_back(glass);
        const ImVec2 upper{area.left + glass.target.left * area.width,
                           area.top + glass.target.top * area.height},
            lower{area.left + glass.target.right * area.width, area.top + glass.target.bottom * area.height};
        marks.AddRect(upper, lower, lineColor);
        // Outline the pixel under the mouse.
        const auto [x, y] = pixelUnderMouse(picture, area);
        const auto place = [](float from, float to, float first, float last, uint32_t pixel, uint32_t all) {
            const float share = (static_cast<float>(pixel) / length(all) - first) / (last - first);
            return from + share * (to - from);
        };
        const float left = place(upper.x, lower.x, glass.source.left, glass.source.right, x, picture.width),
                    top = place(upper.y, lower.y, glass.source.top, glass.source.bottom, y, picture.height);
        const float side = (lower.x - upper.x) / magnifiedPixels;
        marks.AddRect({left, top}, {left + side, top + side}, lineColor);
    }
}

}  // namespace

std::array<gpu::Pane, 2> splitPanes(const gpu::Pane& left, const gpu::Pane& right, gpu::Extent picture,
                                    float divider) {
    const float width = length(picture.width);
    const float at = std::round(std::clamp(divider, 0.0f, 1.0f) * width) / width;
    std::array<gpu::Pane, 2> panes{left, right};
    panes[0].source.right = panes[0].target.right = at;
    panes[1].source.left = panes[1].target.left = at;
    return panes;
}

gpu::Pane magnified(const gpu::Pane& pane, gpu::Extent picture, gpu::Extent area,
                    const std::array<float, 2>& mouse, int number) {
    const std::array<float, 2> pixels{length(picture.width), length(picture.height)},
        size{length(area.width), length(area.height)};
    std::array<float, 2> from{}, to{};
    for (size_t i = 0; i < 2; ++i) {
        const float middle = std::floor(mouse[i] / size[i] * pixels[i]);
        from[i] = std::clamp(middle - std::floor(magnifiedPixels / 2.0f), 0.0f,
                             std::max(pixels[i] - magnifiedPixels, 0.0f));
        // All squares go on the same side of the mouse, where there is room.
        const float whole = i == 0 ? 2.0f * magnifierSide : magnifierSide;
        const bool room = mouse[i] + magnifierDistance + whole <= size[i];
        to[i] = room ? mouse[i] + magnifierDistance : mouse[i] - magnifierDistance - whole;
        to[i] = std::clamp(to[i], 0.0f, std::max(size[i] - whole, 0.0f));
    }
    to[0] += static_cast<float>(number) * magnifierSide;
    gpu::Pane result = pane;
    result.enlarge = true;
    result.source = {from[0] / pixels[0], from[1] / pixels[1], (from[0] + magnifiedPixels) / pixels[0],
                     (from[1] + magnifiedPixels) / pixels[1]};
    result.target = {to[0] / size[0], to[1] / size[1], (to[0] + magnifierSide) / size[0],
                     (to[1] + magnifierSide) / size[1]};
    return result;
}

gpu::Rectangle placed(const gpu::Rectangle& inArea, const Area& area, float width, float height) {
    const auto across = [&](float share) { return (area.left + share * area.width) / std::max(width, 1.0f); };
    const auto down = [&](float share) { return (area.top + share * area.height) / std::max(height, 1.0f); };
    return {across(inArea.left), down(inArea.top), across(inArea.right), down(inArea.bottom)};
}

Display::Display(Window& window, gpu::Device& device)
    : window_(window),
      device_(device),
      presenter_(device, [&](void* instance) { return window.makeSurface(instance); }),
      interface_(window, presenter_) {}

bool Display::dragsDivider(PanelState& panel, Controls& controls) {
    const ImGuiIO& io = ImGui::GetIO();
    const Area& area = panel.area;
    if (!panel.state.comparison.isOn() || area.width <= 0.0f) {
        dragging_ = false;
        return false;
    }
    const float at = area.left + panel.divider * area.width;
    controls.note("divider", fmt::format("{:.3f}", panel.divider), at - dividerReach, area.top,
                  at + dividerReach, area.top + area.height);
    const bool near = !io.WantCaptureMouse && std::abs(io.MousePos.x - at) <= dividerReach;
    if (near && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) dragging_ = true;
    if (!ImGui::IsMouseDown(ImGuiMouseButton_Left)) dragging_ = false;
    if (near || dragging_) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (dragging_) panel.divider = std::clamp((io.MousePos.x - area.left) / area.width, 0.0f, 1.0f);
    return dragging_;
}

std::array<float, 2> Display::mousePosition(const Area& area) {
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto along = [](float at, float whole) {
        return std::clamp(at / std::max(whole, 1.0f), 0.0f, 0.9999f);
    };
    return {along(mouse.x - area.left, area.width), along(mouse.y - area.top, area.height)};
}

std::string Display::probeOf(const image::Image& picture, const Area& area) {
    const auto [x, y] = pixelUnderMouse({picture.width, picture.height}, area);
    std::string text = fmt::format("({}, {}):", x, y);
    for (uint32_t c = 0; c < picture.components; ++c) text += fmt::format(" {:.5g}", picture.at(x, y, c));
    return text;
}

/// Uploads the image of a pass, if one is shown instead of the picture.
void Display::inspect(PanelState& panel, const studio::Shown& shown) {
    const bool same = shown.inspected == inspected_ && panel.state.view == inspectedBy_;
    inspected_ = shown.inspected;
    inspectedBy_ = panel.state.view;
    panel.probe.clear();
    panel.reasons.clear();
    if (!inspected_) return;
    if (!same)
        inspector_.show(device_, shownTexels(*inspected_, inspectedBy_),
                        {inspected_->width, inspected_->height});
    panel.probe = probeOf(*inspected_, panel.area);
    if (shown.reasons) panel.reasons = studio::historyText(*shown.reasons, mousePosition(panel.area));
}

void Display::Uploaded::show(gpu::Device& device, const std::shared_ptr<const studio::Picture>& now) {
    if (picture == now || !now) return;
    picture = now;
    texels.show(device, *now);
}

void Display::drawDivider(const std::string& left, const PanelState& panel, const studio::Facts& facts) {
    const Area& area = panel.area;
    ImDrawList& marks = *ImGui::GetBackgroundDrawList();
    const float at = area.left + panel.divider * area.width, bottom = area.top + area.height;
    marks.AddLine({at, area.top}, {at, bottom}, shadowColor, 3.0f);
    marks.AddLine({at, area.top}, {at, bottom}, lineColor, 1.0f);
    const float width = ImGui::CalcTextSize(left.c_str()).x;
    drawLabel(marks, {at - width - 12.0f, area.top + 8.0f}, left);
    drawLabel(marks, {at + 12.0f, area.top + 8.0f}, facts.comparedWith);
}

void Display::present(PanelState& panel, const studio::Shown& shown) {
    inspect(panel, shown);
    main_.show(device_, shown.picture);
    compared_.show(device_, shown.compared);
    std::vector<gpu::Pane> panes;
    if (inspected_)
        panes.push_back(inspector_.pane());
    else if (shown.picture)
        panes.push_back(main_.texels.pane());
    const gpu::Extent picture = panes.empty() ? gpu::Extent{} : extentOf(panes.front());
    if (shown.motion) drawArrows(*shown.motion, panel.area);
    if (shown.compared && !panes.empty()) {
        const gpu::Pane whole = panes.front();
        const auto both = splitPanes(whole, compared_.texels.pane(), picture, panel.divider);
        panes.front() = both[0];
        panes.push_back(both[1]);
        drawDivider(inspected_ ? nameOfInspected(shown) : shown.state.render.pipeline.title(), panel,
                    shown.facts);
    }
    if (inspected_ && !shown.compared)
        drawLabel(*ImGui::GetBackgroundDrawList(), {panel.area.left + 12.0f, panel.area.top + 8.0f},
                  nameOfInspected(shown));
    drawProbe(shown.facts, panel.area);
    if (panel.magnifier && !panes.empty()) drawMagnifier(panes, picture, panel.area);
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    for (gpu::Pane& pane : panes) pane.target = placed(pane.target, panel.area, window.x, window.y);
    if (panes.empty()) drawStage(panel);
    const Memory& memory = panel.memory;
    presenter_.setHighRange(memory.hdr ? std::optional(gpu::HighRange{
                                             memory.paperWhite, std::max(memory.peak, memory.paperWhite)})
                                       : std::nullopt);
    presenter_.present(panes, window_.pixels(), interface_.end());
}

}  // namespace limpid::viewer

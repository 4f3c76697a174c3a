#include "viewer/camera/steering.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <cmath>

namespace limpid::viewer {
namespace {

constexpr float radiansAPixel = 0.005f;
constexpr float zoomAStep = 0.85f;

}  // namespace

Steering Steering::now() {
    const ImGuiIO& io = ImGui::GetIO();
    // Movement before the button went down is not a drag.
    const auto held = [&](int button) { return io.MouseDown[button] && io.MouseDownDuration[button] > 0.0f; };
    return {.left = held(ImGuiMouseButton_Left),
            .middle = held(ImGuiMouseButton_Middle),
            .right = held(ImGuiMouseButton_Right),
            .x = io.MouseDelta.x,
            .y = io.MouseDelta.y,
            .height = io.DisplaySize.y,
            .wheel = io.MouseWheel};
}

void Steering::apply(FlyCamera& camera, float seconds, float& speed) const {
    if (left) camera.orbit(radiansAPixel * x, -radiansAPixel * y);
    if (middle) camera.pan(x / height, -y / height);
    if (!right) {
        if (wheel != 0.0f) camera.zoom(std::pow(zoomAStep, wheel));
        return;
    }
    camera.look(radiansAPixel * x, -radiansAPixel * y);
    if (wheel != 0.0f) speed *= std::pow(1.0f / zoomAStep, wheel);
    const auto axis = [](int more, int less) {
        return (ImGui::IsKeyDown(more) ? 1.0f : 0.0f) - (ImGui::IsKeyDown(less) ? 1.0f : 0.0f);
    };
    camera.move(
        speed * seconds *
        vec3(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_W, GLFW_KEY_S)));
}

}  // namespace limpid::viewer

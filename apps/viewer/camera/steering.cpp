#include "viewer/camera/steering.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace limpid::viewer {
namespace {

constexpr float radiansPerPixel = 0.005f;

}  // namespace

studio::Gesture gestureNow(float seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    // Movement before the button went down is not a drag.
    const auto held = [&](int button) { return io.MouseDown[button] && io.MouseDownDuration[button] > 0.0f; };
    const vec2 moved(io.MouseDelta.x, -io.MouseDelta.y);
    studio::Gesture gesture;
    if (held(ImGuiMouseButton_Left)) gesture.orbit = radiansPerPixel * moved;
    if (held(ImGuiMouseButton_Middle)) gesture.pan = moved / io.DisplaySize.y;
    if (!held(ImGuiMouseButton_Right)) {
        gesture.zoom = io.MouseWheel;
        return gesture;
    }
    gesture.look = radiansPerPixel * moved;
    gesture.speed = io.MouseWheel;
    const auto axis = [](int more, int less) {
        return (ImGui::IsKeyDown(more) ? 1.0f : 0.0f) - (ImGui::IsKeyDown(less) ? 1.0f : 0.0f);
    };
    gesture.fly = seconds * vec3(axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                                 axis(GLFW_KEY_W, GLFW_KEY_S));
    return gesture;
}

}  // namespace limpid::viewer

#include "window.h"

#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan_core.h>
// GLFW only declares its Vulkan functions after Vulkan's header is included.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"

namespace limpid::viewer {
namespace {

[[noreturn]] void fail(const std::string& what) {
    const char* why = nullptr;
    glfwGetError(&why);
    throw Error(what + (why ? std::string(" (") + why + ")" : "") +
                "; without a window, 'limpid render' writes pictures, and 'limpid bench quality --report' a "
                "page to look around in");
}

}  // namespace

Desktop::Desktop() {
    if (!glfwInit()) fail("there is no display to open a window on");
}

Desktop::~Desktop() {
    glfwTerminate();
}

Window::Window(const std::string& title, gpu::Extent size) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window_ = glfwCreateWindow(static_cast<int>(size.width), static_cast<int>(size.height), title.c_str(),
                               nullptr, nullptr);
    if (!window_) fail("no window can be opened");
    listen();
}

/// Waiting for events does not tell whether there were any, so callbacks record them.
void Window::listen() {
    using Kind = InputEvent::Kind;
    constexpr float outside = -std::numeric_limits<float>::max();  // same value as in ImGui
    glfwSetWindowUserPointer(window_, this);
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
        Window& self = of(window);
        self.dropped_.insert(self.dropped_.end(), paths, paths + count);
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
        if (action != GLFW_REPEAT && key != GLFW_KEY_UNKNOWN)
            of(window).input_.add({.kind = Kind::Key, .code = key, .down = action == GLFW_PRESS});
    });
    glfwSetCharCallback(window_, [](GLFWwindow* window, unsigned character) {
        of(window).input_.add({.kind = Kind::Text, .code = static_cast<int>(character)});
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* window, double x, double y) {
        of(window).input_.add({.kind = Kind::Move, .x = static_cast<float>(x), .y = static_cast<float>(y)});
    });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* window, int entered) {
        if (!entered) return of(window).input_.add({.kind = Kind::Move, .x = outside, .y = outside});
        // GLFW does not report a position at which it was seen last.
        double x = 0.0, y = 0.0;
        glfwGetCursorPos(window, &x, &y);
        of(window).input_.add({.kind = Kind::Move, .x = static_cast<float>(x), .y = static_cast<float>(y)});
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* window, int button, int action, int) {
        Window& self = of(window);
        const bool down = action == GLFW_PRESS;
        self.input_.add({.kind = Kind::Button,
                         .code = button,
                         .down = down,
                         .twice = down && self.isSecondClick(button)});
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* window, double x, double y) {
        of(window).input_.add({.kind = Kind::Wheel, .x = static_cast<float>(x), .y = static_cast<float>(y)});
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* window, int) { of(window); });
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* window, int, int) { of(window); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* window) { of(window); });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* window) { of(window); });
}

/// Events have no time of their own, only that of the poll, so they may be a frame old.
bool Window::isSecondClick(int button) {
    constexpr double soon = 0.35, near = 6.0;  // seconds, pixels
    Click now{button, glfwGetTime()};
    glfwGetCursorPos(window_, &now.x, &now.y);
    const bool second = lastClick_.button == button &&
                        now.seconds - lastClick_.seconds < soon + betweenPolls_ &&
                        std::abs(now.x - lastClick_.x) < near && std::abs(now.y - lastClick_.y) < near;
    lastClick_ = second ? Click{} : now;
    return second;
}

/// Returns the window that received an event, and marks it as touched.
Window& Window::of(GLFWwindow* window) {
    Window& self = *static_cast<Window*>(glfwGetWindowUserPointer(window));
    self.touched_ = true;
    return self;
}

Window::~Window() {
    glfwDestroyWindow(window_);
}

std::vector<std::string> Window::surfaceExtensions() {
    uint32_t count = 0;
    const char** const names = glfwGetRequiredInstanceExtensions(&count);
    return names ? std::vector<std::string>(names, names + count) : std::vector<std::string>();
}

uint64_t Window::makeSurface(void* instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(static_cast<VkInstance>(instance), window_, nullptr, &surface) != VK_SUCCESS)
        fail("Vulkan cannot draw in this window");
    return reinterpret_cast<uint64_t>(surface);
}

gpu::Extent Window::pixels() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

float Window::scale() const {
    float content = 1.0f, unused = 1.0f;
    glfwGetWindowContentScale(window_, &content, &unused);
    const uint32_t across = size().width, pixelsAcross = pixels().width;
    if (across == 0 || pixelsAcross == 0) return std::max(content, 1.0f);
    return std::max(content * static_cast<float>(across) / static_cast<float>(pixelsAcross), 1.0f);
}

gpu::Extent Window::size() const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

void Window::resize(gpu::Extent size) const {
    glfwSetWindowSize(window_, static_cast<int>(size.width), static_cast<int>(size.height));
}

int Window::keyOf(char letter) {
    for (int key = GLFW_KEY_A; key <= GLFW_KEY_Z; ++key) {
        const char* const name = glfwGetKeyName(key, 0);
        if (name && name[0] == letter && name[1] == '\0') return key;
    }
    return GLFW_KEY_A + (letter - 'a');
}

void Window::setClipboard(const std::string& text) const {
    glfwSetClipboardString(window_, text.c_str());
}

void Window::setTitle(const std::string& title) const {
    glfwSetWindowTitle(window_, title.c_str());
}

bool Window::closed() const {
    return glfwWindowShouldClose(window_) != 0;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::wake() const {
    glfwPostEmptyEvent();
}

bool Window::poll(double wait) {
    betweenPolls_ = glfwGetTime() - polled_;
    if (wait > 0.0)
        glfwWaitEventsTimeout(wait);
    else
        glfwPollEvents();
    polled_ = glfwGetTime();
    return std::exchange(touched_, false);
}

}  // namespace limpid::viewer

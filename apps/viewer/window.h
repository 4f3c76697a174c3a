// A window of the desktop, with a surface to present on. GLFW's only user.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gpu/frame_graph.h"

struct GLFWwindow;

namespace limpid::viewer {

class Window {
  public:
    /// Throws Error where there is no display, saying what to use instead.
    Window(const std::string& title, gpu::Extent size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What DeviceOptions::surfaceExtensions must hold.
    static std::vector<std::string> surfaceExtensions();
    /// For gpu::Presenter.
    uint64_t makeSurface(void* instance) const;

    gpu::Extent pixels() const;  ///< 0 while it is minimised
    bool closed() const;
    void close();
    /// Handles what has happened; `wait`: until something has, or for so many seconds.
    void poll(double wait = 0.0);
    GLFWwindow* handle() const { return window_; }

  private:
    GLFWwindow* window_ = nullptr;
};

}  // namespace limpid::viewer

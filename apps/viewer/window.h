// A window of the desktop, with a surface to present on. GLFW's only user.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gpu/graph/frame_graph.h"
#include "viewer/camera/input.h"

struct GLFWwindow;

namespace limpid::viewer {

/// The connection to the display, which must outlive its windows. One that ends between two windows may take
/// the display with it: X starts anew when its last client goes.
class Desktop {
  public:
    /// Throws Error where there is no display, saying what to use instead.
    Desktop();
    ~Desktop();
    Desktop(const Desktop&) = delete;
    Desktop& operator=(const Desktop&) = delete;
};

class Window {
  public:
    /// While there is a Desktop. Throws Error if no window can be opened, saying what to use instead.
    Window(const std::string& title, gpu::Extent size);
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    /// What DeviceOptions::surfaceExtensions must hold.
    static std::vector<std::string> surfaceExtensions();
    /// For gpu::Presenter.
    uint64_t makeSurface(void* instance) const;

    gpu::Extent pixels() const;  ///< 0 while it is minimised
    gpu::Extent size() const;    ///< in the units that it was made with
    /// How much larger than their nominal size letters should be, in the units of mouse positions.
    float scale() const;
    void resize(gpu::Extent size) const;
    /// GLFW's number of the key that types this letter with the keyboard's layout.
    static int keyOf(char letter);
    bool closed() const;
    void close();
    /// Handles what has happened; `wait`: until something has, or for so many seconds. Whether something may
    /// have.
    bool poll(double wait = 0.0);
    /// Ends a wait of poll(). May be called on any thread.
    void wake() const;
    /// What has been dropped on it since the last call.
    std::vector<std::string> takeDropped() { return std::exchange(dropped_, {}); }
    InputQueue& input() { return input_; }
    void setClipboard(const std::string& text) const;
    void setTitle(const std::string& title) const;
    GLFWwindow* handle() const { return window_; }

  private:
    void listen();
    bool isSecondClick(int button);
    static Window& of(GLFWwindow* window);

    GLFWwindow* window_ = nullptr;
    std::vector<std::string> dropped_;
    InputQueue input_;
    struct Click {
        int button = -1;
        double seconds = 0.0, x = 0.0, y = 0.0;
    } lastClick_;
    bool touched_ = true;
    double polled_ = 0.0;        ///< when the last poll ended, seconds
    double betweenPolls_ = 0.0;  ///< from there to this one
};

}  // namespace limpid::viewer

// ImGui's controls, which also say where they were drawn: tests that move a real mouse find them by name.
#pragma once

#include <string>
#include <vector>

namespace limpid::viewer {

struct DrawnControl {
    std::string name, value;
    float left = 0.0f, top = 0.0f, right = 0.0f,
          bottom = 0.0f;  ///< pixels of the window; outside it: scrolled away
};

/// Every function draws a control named `name` and returns whether the user changed it.
class Controls {
  public:
    /// Forgets where the last frame's were.
    void begin() { drawn_.clear(); }
    /// Names that follow are `group`.name; "" ends that.
    void setGroup(std::string group) { group_ = std::move(group); }

    bool button(const char* name);
    bool checkbox(const char* name, bool& value);
    /// Ranges of more than a thousand to one are logarithmic.
    bool slider(const char* name, int& value, int least, int most);
    bool slider(const char* name, float& value, float least, float most, const char* format = "%.4g");
    bool header(const char* name);
    /// `choices` are shown in a list that opens; `chosen` is one's number.
    bool choice(const char* name, const std::vector<std::string>& choices, int& chosen);
    /// Of whatever was drawn last.
    void note(const std::string& name, const std::string& value = {});
    void note(const std::string& name, const std::string& value, float left, float top, float right,
              float bottom);

    /// One a line: left, top, right, bottom, name, value; between tabs.
    std::string text() const;

  private:
    std::string group_;
    std::vector<DrawnControl> drawn_;
};

}  // namespace limpid::viewer

// ImGui's controls, which also say where they were drawn: tests that move a real mouse find them by name.
#pragma once

#include <string>
#include <vector>

#include "base/math.h"
#include "base/slider_span.h"

namespace limpid::viewer {

/// What a number may be, and the part of it that its slider runs over.
struct Range {
    double minimum, maximum;
    SliderSpan slider;
    Range(double min, double max) : minimum(min), maximum(max), slider{min, max, SliderScale::Linear, 0.0} {}
    Range(double min, double max, const SliderSpan& span) : minimum(min), maximum(max), slider(span) {}
};

struct DrawnControl {
    std::string name, value;
    float left = 0.0f, top = 0.0f, right = 0.0f,
          bottom = 0.0f;  ///< pixels of the window; outside it: scrolled away
};

/// The next button, with this text, goes beside what was drawn last, if it fits.
void sameLineFor(const char* text);

/// A text beside the mouse.
void explain(const std::string& text);
/// A text left of the window that is being drawn, at the height of the mouse: it covers no list.
void explainBeside(const std::string& text);

/// Every function draws a control named `name` and returns whether the user changed it. Those for values are
/// rows: the name on the left, the control on the right.
class Controls {
  public:
    /// Forgets where the last frame's were.
    void begin() { drawn_.clear(); }
    /// Names that follow are `group`.name; "" ends that.
    void setGroup(std::string group) { group_ = std::move(group); }

    bool button(const char* name);
    /// Not a row: the name stands on the right.
    bool checkbox(const char* name, bool& value);
    bool toggle(const char* name, bool& value);
    /// One line of text. `hint` stands in it where it is empty. Returns true while it is changed; with
    /// `onEnter`, when Enter is pressed.
    bool text(const char* name, const char* hint, std::string& value, bool onEnter = false);
    /// Moves over range.slider; a number that is typed (Ctrl and a click) may be anything of the range.
    /// `unit` stands behind the number.
    bool slider(const char* name, int& value, const Range& range, const std::string& unit = {});
    bool slider(const char* name, float& value, const Range& range, const char* format = "{:.4g}",
                const std::string& unit = {});
    /// Three numbers side by side, to drag (`speed` per pixel) or to type; noted as "NAME x" and so on.
    bool vector(const char* name, vec3& value, float speed);
    /// A line that opens what follows; `noted` is its name for tests. `open`: whether it is.
    bool header(const char* name, const std::string& noted, bool& open);
    /// One line that opens; if it is open, ImGui::TreePop() ends what is in it.
    bool tree(const char* name);
    /// Hue and saturation of linear Rec. 709; the largest component stays as it is.
    bool color(const char* name, vec3& value);
    /// `choices` are shown in a list that opens; `chosen` is one's number. `help`: empty, or a sentence for
    /// each, shown while the mouse is over it.
    bool choice(const char* name, const std::vector<std::string>& choices, int& chosen,
                const std::vector<std::string>& help = {});
    /// The mouse is over the row that was drawn last, or over its name.
    bool rowHovered() const;
    /// Of whatever was drawn last.
    void note(const std::string& name, const std::string& value = {});
    void note(const std::string& name, const std::string& value, float left, float top, float right,
              float bottom);

    /// One a line: left, top, right, bottom, name, value; between tabs.
    std::string lines() const;

  private:
    /// Draws a row's name, and makes what follows as wide as what is left. Returns the hidden name for ImGui.
    std::string beginRow(const char* name);

    std::string group_;
    bool nameHovered_ = false;
    std::vector<DrawnControl> drawn_;
};

}  // namespace limpid::viewer

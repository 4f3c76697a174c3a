// What mouse and keyboard did, in the order in which they did it, a frame's worth at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <set>
#include <vector>

namespace limpid::viewer {

struct InputEvent {
    enum class Kind { Move, Button, Wheel, Key, Text };
    Kind kind = Kind::Move;
    int code = 0;              ///< number of the button; GLFW's of the key; the character
    bool down = false;         ///< of buttons and keys
    bool twice = false;        ///< a button that goes down for the second time, soon and nearby
    float x = 0.0f, y = 0.0f;  ///< Move: pixels of the window; Wheel: steps
    bool operator==(const InputEvent&) const = default;
};

/// A user interface that looks at buttons and keys once a frame sees what they are then, not what they were
/// in between. Slow frames would swallow clicks and turn Ctrl+A into a letter; so what would hide an event
/// of the same frame waits for the next one.
class InputQueue {
  public:
    void add(const InputEvent& event) { events_.push_back(event); }
    bool empty() const { return events_.empty(); }
    /// The events of the next frame. `typing`: into a field of text, to which characters matter and the keys
    /// that made them do not.
    std::vector<InputEvent> take(bool typing);
    /// How often a button has come up in the events that were taken.
    uint64_t clicks() const { return clicks_; }

  private:
    std::deque<InputEvent> events_;
    std::set<int> controls_;  ///< Control, Alt and the like that are held
    uint64_t clicks_ = 0;
};

}  // namespace limpid::viewer

#include "viewer/camera/input.h"

#include <GLFW/glfw3.h>

#include <algorithm>

namespace limpid::viewer {
namespace {

using EventKind = InputEvent::Kind;

bool isShift(const InputEvent& event) {
    return event.kind == EventKind::Key &&
           (event.code == GLFW_KEY_LEFT_SHIFT || event.code == GLFW_KEY_RIGHT_SHIFT);
}

/// While one of these is held, keys are commands.
bool isControl(const InputEvent& event) {
    return event.kind == EventKind::Key && event.code >= GLFW_KEY_LEFT_SHIFT &&
           event.code <= GLFW_KEY_RIGHT_SUPER && !isShift(event);
}

/// A key that produces a character reports it separately as Text.
bool isPrintable(const InputEvent& event) {
    return event.kind == EventKind::Key && event.code >= GLFW_KEY_SPACE && event.code < GLFW_KEY_ESCAPE;
}

/// True if `earlier`, of the same frame, could no longer be distinguished from `later`. `typing`: printable
/// keys only matter through their characters.
bool hides(const InputEvent& later, const InputEvent& earlier, bool typing) {
    const auto matters = [&](const InputEvent& e) { return !typing || (!isPrintable(e) && !isShift(e)); };
    switch (later.kind) {
        case EventKind::Move:
            return earlier.kind == EventKind::Button || earlier.kind == EventKind::Wheel;
        case EventKind::Button:
            // The interface needs to find the control under the mouse before a button counts; and movement
            // before a release happened while the button was down.
            return (earlier.kind == EventKind::Button && earlier.code == later.code) ||
                   earlier.kind == EventKind::Move;
        case EventKind::Wheel:
            return false;
        case EventKind::Key:
            if (isControl(later)) return earlier.kind != EventKind::Move;
            if (isShift(later))
                return earlier.kind == EventKind::Button ||
                       (earlier.kind == EventKind::Key && matters(earlier));
            return earlier.kind == EventKind::Key && earlier.code == later.code && matters(later);
        case EventKind::Text:
            // Text fields handle a frame's characters before its keys.
            return earlier.kind == EventKind::Button ||
                   (earlier.kind == EventKind::Key && earlier.down && matters(earlier) &&
                    !isPrintable(earlier) && !isShift(earlier) && !isControl(earlier));
    }
    return false;
}

}  // namespace

std::vector<InputEvent> InputQueue::take(bool typing) {
    std::vector<InputEvent> taken;
    while (!events_.empty()) {
        const InputEvent& next = events_.front();
        const bool prints = typing && controls_.empty();
        if (std::any_of(taken.begin(), taken.end(),
                        [&](const InputEvent& earlier) { return hides(next, earlier, prints); }))
            break;
        if (next.kind == EventKind::Move && !taken.empty() && taken.back().kind == EventKind::Move)
            taken.back() = next;
        else
            taken.push_back(next);
        if (next.kind == EventKind::Button && !next.down) ++clicks_;
        if (isControl(next)) {
            if (next.down)
                controls_.insert(next.code);
            else
                controls_.erase(next.code);
        }
        events_.pop_front();
    }
    return taken;
}

}  // namespace limpid::viewer

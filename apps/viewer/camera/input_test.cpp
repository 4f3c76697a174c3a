#include "viewer/camera/input.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

using Kind = InputEvent::Kind;

InputEvent down(int key) {
    return {.kind = Kind::Key, .code = key, .down = true};
}
InputEvent up(int key) {
    return {.kind = Kind::Key, .code = key};
}
InputEvent text(char c) {
    return {.kind = Kind::Text, .code = c};
}
InputEvent press() {
    return {.kind = Kind::Button, .down = true};
}
InputEvent release() {
    return {.kind = Kind::Button};
}
InputEvent move(float x) {
    return {.kind = Kind::Move, .x = x};
}

/// Returns the frames into which simultaneous events are split.
std::vector<std::vector<InputEvent>> frames(const std::vector<InputEvent>& events, bool typing = false) {
    InputQueue queue;
    for (const InputEvent& event : events) queue.add(event);
    std::vector<std::vector<InputEvent>> result;
    while (!queue.empty()) result.push_back(queue.take(typing));
    return result;
}

using Frames = std::vector<std::vector<InputEvent>>;

TEST(InputQueue, AClickIsSeenWhereItWas) {
    EXPECT_EQ(frames({move(1), move(2), press(), release(), move(3)}),
              (Frames{{move(2)}, {press()}, {release()}, {move(3)}}));
}

TEST(InputQueue, ADragMovesInBetween) {
    EXPECT_EQ(frames({press(), move(5), move(9), release()}), (Frames{{press()}, {move(9)}, {release()}}));
}

TEST(InputQueue, AKeyThatIsOnlyTouchedIsSeen) {
    EXPECT_EQ(frames({down(GLFW_KEY_TAB), up(GLFW_KEY_TAB), down(GLFW_KEY_TAB)}),
              (Frames{{down(GLFW_KEY_TAB)}, {up(GLFW_KEY_TAB)}, {down(GLFW_KEY_TAB)}}));
}

TEST(InputQueue, WordsNeedOneFrame) {
    const std::vector<InputEvent> word{down(GLFW_KEY_LEFT_SHIFT), down('A'), text('A'), up('A'),
                                       up(GLFW_KEY_LEFT_SHIFT),   down('A'), text('a'), up('A')};
    EXPECT_EQ(frames(word, true), Frames{word});
}

TEST(InputQueue, ControlAStaysItselfAndComesBeforeWhatReplacesTheText) {
    const int control = GLFW_KEY_LEFT_CONTROL;
    EXPECT_EQ(frames({down(control), down('A'), up('A'), up(control), down('B'), text('b'), up('B')}, true),
              (Frames{{down(control), down('A')}, {up('A')}, {up(control), down('B'), text('b'), up('B')}}));
}

TEST(InputQueue, TextAfterBackspaceIsNotDeleted) {
    EXPECT_EQ(frames({down(GLFW_KEY_BACKSPACE), text('b')}, true),
              (Frames{{down(GLFW_KEY_BACKSPACE)}, {text('b')}}));
}

}  // namespace
}  // namespace limpid::viewer

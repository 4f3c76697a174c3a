#include "viewer/panel/history.h"

#include <gtest/gtest.h>

namespace limpid::viewer {
namespace {

using nlohmann::json;

TEST(History, GoesBackAndForth) {
    History history;
    EXPECT_FALSE(history.undo());
    history.note({{"seed", 1}}, {{"seed", 0}, {"fov", 45}});
    history.endStep();
    history.note({{"fov", 50}}, {{"seed", 1}, {"fov", 45}});
    history.endStep();
    EXPECT_EQ(history.undo(), json({{"fov", 45}}));
    EXPECT_EQ(history.undo(), json({{"seed", 0}}));
    EXPECT_FALSE(history.canUndo());
    EXPECT_EQ(history.redo(), json({{"seed", 1}}));
    EXPECT_EQ(history.redo(), json({{"fov", 50}}));
    EXPECT_FALSE(history.redo());
}

TEST(History, AGestureIsOneStep) {
    History history;
    history.note({{"seed", 1}}, {{"seed", 0}, {"fov", 45}});
    history.note({{"seed", 2}, {"fov", 46}}, {{"seed", 1}, {"fov", 45}});
    history.endStep();
    EXPECT_EQ(history.undo(), json({{"seed", 0}, {"fov", 45}}));
    EXPECT_FALSE(history.canUndo());
    EXPECT_EQ(history.redo(), json({{"seed", 2}, {"fov", 46}}));
}

TEST(History, AnEditEndsWhatCouldBeRedone) {
    History history;
    history.note({{"seed", 1}}, {{"seed", 0}});
    history.undo();
    history.note({{"seed", 5}}, {{"seed", 0}});
    EXPECT_FALSE(history.canRedo());
    EXPECT_EQ(history.undo(), json({{"seed", 0}}));
    history.clear();
    EXPECT_FALSE(history.canRedo());
}

TEST(History, ForgetsTheOldestSteps) {
    History history;
    for (int i = 0; i < 250; ++i) {
        history.note({{"seed", i + 1}}, {{"seed", i}});
        history.endStep();
    }
    size_t steps = 0;
    while (history.undo()) ++steps;
    EXPECT_EQ(steps, History::mostSteps);
}

}  // namespace
}  // namespace limpid::viewer

#include "studio/live/playback.h"

#include <gtest/gtest.h>

#include "renderer/sequence/sequence.h"

namespace limpid::studio {
namespace {

scene::CameraKey keyAt(float x) {
    scene::CameraKey key;
    key.eye.x = x;
    return key;
}

TEST(Playback, PlaysAsASequenceDoes) {
    Playback playback;
    playback.playing = true;
    playback.reset(0.7);
    const SequenceTiming timing{30.0, 0.7};
    for (uint64_t frame = 0; frame < 100; ++frame) {
        EXPECT_EQ(playback.time(), timing.timeOf(frame));
        EXPECT_EQ(playback.moment({}).number, frame);
        EXPECT_EQ(playback.moment({}).previousCamera.has_value(), frame > 0);
        const auto change = playback.change();
        ASSERT_TRUE(change);
        EXPECT_EQ(change->from, frame == 0 ? 0.7 : timing.timeOf(frame - 1));
        EXPECT_EQ(change->to, timing.timeOf(frame));
        playback.advance({}, keyAt(static_cast<float>(frame)));
        EXPECT_EQ(playback.cameras().back().time, timing.timeOf(frame));
    }
    EXPECT_TRUE(playback.playedThroughout());
    EXPECT_FALSE(playback.cameraStoodStill());
}

TEST(Playback, WhatStandsIsToldOnce) {
    Playback playback;
    playback.playing = true;
    playback.reset(0.0);
    playback.advance({}, keyAt(0));
    playback.playing = false;
    playback.advance({}, keyAt(0));  // moved since the frame before
    const auto stop = playback.change();
    ASSERT_TRUE(stop);
    EXPECT_EQ(stop->from, stop->to);
    playback.advance({}, keyAt(0));
    EXPECT_FALSE(playback.change());
    EXPECT_TRUE(playback.cameraStoodStill());
    EXPECT_FALSE(playback.playedThroughout());
}

TEST(Playback, ASeekIsACut) {
    Playback playback;
    playback.reset(0.0);
    playback.advance({}, keyAt(0));
    EXPECT_FALSE(playback.change());
    playback.seek(2.0);
    EXPECT_EQ(playback.change()->from, 2.0);
    EXPECT_FALSE(playback.moment({}).previousCamera);
    playback.reset(2.0);
    EXPECT_EQ(playback.frames(), 0u);
    EXPECT_TRUE(playback.playedThroughout());
}

}  // namespace
}  // namespace limpid::studio

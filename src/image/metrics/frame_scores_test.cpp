#include "image/metrics/frame_scores.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <vector>

namespace limpid::image {
namespace {

const Metric& metric(std::string_view name) {
    for (const Metric& m : sequenceMetrics()) {
        if (m.name == name) return m;
    }
    throw std::out_of_range("no such metric");
}

TEST(FrameScores, MeanAndWorst) {
    const std::vector<FrameScores> frames = {
        {.frame = 7, .psnr = 30, .ssim = 0.9, .relMse = 2, .flip = 0.1},
        {.frame = 8, .psnr = 20, .ssim = 0.6, .relMse = 5, .flip = 0.3, .hdrFlip = 0.5, .flicker = -0.2},
        {.frame = 9, .psnr = 40, .ssim = 0.6, .relMse = 2, .flip = 0.2, .hdrFlip = 0.4, .flicker = 0.1},
    };
    EXPECT_DOUBLE_EQ(*meanOf(metric("psnr"), frames), 30.0);
    EXPECT_DOUBLE_EQ(*meanOf(metric("relmse"), frames), 3.0);
    EXPECT_DOUBLE_EQ(*meanOf(metric("hdr_flip"), frames), 0.45) << "over the frames that have it";
    EXPECT_DOUBLE_EQ(*meanOf(metric("flicker"), frames), 0.15) << "lag and noise do not cancel";
    EXPECT_EQ(worstOf(metric("psnr"), frames)->frame, 8);
    EXPECT_EQ(worstOf(metric("psnr"), frames)->value, 20.0);
    EXPECT_EQ(worstOf(metric("ssim"), frames)->frame, 8) << "the first of equals";
    EXPECT_EQ(worstOf(metric("flip"), frames)->frame, 8);
    EXPECT_EQ(worstOf(metric("flicker"), frames)->frame, 8);
    EXPECT_EQ(worstOf(metric("flicker"), frames)->value, -0.2) << "the farthest from zero";
    const std::span<const FrameScores> first(frames.data(), 1);
    EXPECT_EQ(meanOf(metric("flicker"), first), std::nullopt);
    EXPECT_FALSE(worstOf(metric("flicker"), first));
}

TEST(FrameScores, EqualFramesHaveAnInfinitePsnr) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<FrameScores> frames = {{.frame = 1, .psnr = infinity}, {.frame = 2, .psnr = 25}};
    EXPECT_EQ(meanOf(metric("psnr"), frames), infinity);
    EXPECT_EQ(worstOf(metric("psnr"), frames)->frame, 2);
}

}  // namespace
}  // namespace limpid::image

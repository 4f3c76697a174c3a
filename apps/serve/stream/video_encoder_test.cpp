#include "serve/stream/video_encoder.h"

#include <gtest/gtest.h>

#include "serve/remote/video_decoder.h"
#include "serve/stream/test_pictures.h"

namespace limpid::serve {
namespace {

constexpr double frameSeconds = 1.0 / 30.0;

class VideoEncoderTest : public testing::TestWithParam<gpu::Extent> {};

TEST_P(VideoEncoderTest, PicturesComeBack) {
    VideoEncoder encoder(GetParam(), 2'000'000, 2);
    VideoDecoder decoder;
    double worst = 99.0, atRest = 0.0;
    for (int i = 0; i < 40; ++i) {
        const studio::Picture picture = wavePicture(GetParam(), std::min(i, 20));
        const VideoEncoder::Frame frame = encoder.encode(picture, i == 0, frameSeconds);
        ASSERT_FALSE(frame.bytes.empty()) << i;
        EXPECT_EQ(frame.key, i == 0) << i;
        decoder.decode(frame.bytes);
        const studio::Picture decoded = decoder.picture();
        ASSERT_EQ(decoded.extent, GetParam());
        atRest = psnr(picture, decoded);
        worst = std::min(worst, atRest);
    }
    EXPECT_GT(worst, 28.0) << "while it moves";
    EXPECT_GT(atRest, 34.0) << "at rest";
}

INSTANTIATE_TEST_SUITE_P(Sizes, VideoEncoderTest,
                         testing::Values(gpu::Extent{320, 200}, gpu::Extent{321, 201}, gpu::Extent{17, 3}),
                         [](const auto& each) {
                             return std::to_string(each.param.width) + "x" +
                                    std::to_string(each.param.height);
                         });

TEST(VideoEncoder, MakesKeyFramesOnRequestOnly) {
    VideoEncoder encoder({160, 120}, 1'000'000, 1);
    for (int i = 0; i < 20; ++i) {
        const bool key = i % 7 == 0;
        const auto frame = encoder.encode(wavePicture({160, 120}, i), key, frameSeconds);
        EXPECT_EQ(frame.key, key) << i;
        if (key) {
            EXPECT_NO_THROW(VideoDecoder().decode(frame.bytes)) << "begins anew at " << i;
        }
    }
}

TEST(VideoEncoder, FollowsTheBitrate) {
    const gpu::Extent extent{320, 240};
    VideoEncoder encoder(extent, 4'000'000, 1);
    VideoDecoder decoder;
    const auto bytesOfASecond = [&](int from) {
        size_t bytes = 0;
        for (int i = from; i < from + 30; ++i) {
            // Noise that moves: nothing of it can be predicted.
            studio::Picture picture = noisePicture(extent);
            std::rotate(picture.texels.begin(), picture.texels.begin() + i * 101, picture.texels.end());
            const auto frame = encoder.encode(picture, i == 0, frameSeconds);
            decoder.decode(frame.bytes);
            bytes += frame.bytes.size();
        }
        return bytes;
    };
    bytesOfASecond(0);
    const size_t high = bytesOfASecond(30);
    encoder.setBitrate(400'000);
    bytesOfASecond(60);
    EXPECT_LT(bytesOfASecond(90), high) << "bytes at a tenth of the bitrate";
}

}  // namespace
}  // namespace limpid::serve

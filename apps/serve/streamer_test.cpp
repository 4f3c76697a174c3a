#include "serve/streamer.h"

#include <gtest/gtest.h>

#include <atomic>

#include "image/io/png/png.h"
#include "serve/published_session.h"
#include "serve/test_pictures.h"
#include "serve/vp9_decoder.h"

namespace limpid::serve {
namespace {

constexpr gpu::Extent extent{64, 48};

class StreamerTest : public testing::Test {
  protected:
    ~StreamerTest() override { streamer.stop(); }

    Streamer::ClientId client(bool vp9) {
        const auto id = streamer.add();
        streamer.start(id, vp9);
        return id;
    }
    void publish(bool computing = true) { session.publish(wavePicture(extent, time++), computing); }
    /// The next packet, or none after a while.
    std::optional<Packet> next(Streamer::ClientId id, double seconds = 2.0) {
        std::optional<Packet> packet;
        soon([&] { return (packet = streamer.take(id)).has_value(); }, seconds);
        return packet;
    }

    PublishedSession session;
    std::atomic<int> woken = 0;
    int time = 0;
    Streamer streamer{session, [this] { ++woken; }};
};

TEST_F(StreamerTest, SendsNothingBeforeStart) {
    const auto id = streamer.add();
    publish();
    EXPECT_FALSE(next(id, 0.1));
    streamer.start(id, false);
    EXPECT_TRUE(next(id));
    EXPECT_GT(woken, 0);
}

TEST_F(StreamerTest, HasTwoInFlightAndSendsTheNewest) {
    const auto id = client(false);
    publish();
    const auto first = next(id);
    publish();
    const auto second = next(id);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(first->header.frame + 1, second->header.frame);
    for (int i = 0; i < 5; ++i) publish();
    EXPECT_FALSE(next(id, 0.1)) << "a third one is in flight";
    streamer.received(id, 12345);
    EXPECT_FALSE(next(id, 0.1)) << "an unknown number counts";
    streamer.received(id, first->header.frame);
    const auto third = next(id);
    ASSERT_TRUE(third);
    EXPECT_EQ(third->header.snapshot, 7u) << "not the newest";
    streamer.received(id, first->header.frame);
    EXPECT_FALSE(next(id, 0.1)) << "one number counts twice";
}

TEST_F(StreamerTest, ASlowClientDoesNotStopAFastOne) {
    const auto slow = client(true), fast = client(true);
    int frames = 0;
    Vp9Decoder decoder;
    for (int i = 0; i < 20; ++i) {
        publish();
        if (i < 2) next(slow, 0.2);
        const auto packet = next(fast, 1.0);
        ASSERT_TRUE(packet) << i;
        EXPECT_NO_THROW(decoder.decode(*packet->bytes)) << i;
        streamer.received(fast, packet->header.frame);
        ++frames;
    }
    EXPECT_EQ(frames, 20);
}

TEST_F(StreamerTest, AClientThatLostFramesGetsAKeyFrame) {
    const auto slow = client(true), fast = client(true);
    std::vector<uint32_t> held;
    Vp9Decoder decoder;
    publish();
    for (int i = 0; i < 8; ++i) {
        if (auto packet = next(slow, i < 2 ? 1.0 : 0.02)) {
            EXPECT_NO_THROW(decoder.decode(*packet->bytes));
            held.push_back(packet->header.frame);
        }
        const auto packet = next(fast, 1.0);
        ASSERT_TRUE(packet);
        streamer.received(fast, packet->header.frame);
        publish();
    }
    ASSERT_EQ(held.size(), 2u);
    for (const uint32_t frame : held) streamer.received(slow, frame);
    std::optional<Packet> packet;
    for (int i = 0; i < 100 && !packet; ++i) {
        publish();
        packet = next(slow, 0.02);
        if (const auto other = streamer.take(fast)) streamer.received(fast, other->header.frame);
    }
    ASSERT_TRUE(packet);
    EXPECT_TRUE(packet->header.key);
    EXPECT_NO_THROW(decoder.decode(*packet->bytes));
}

TEST_F(StreamerTest, SendsTheStillOnceAndBitForBit) {
    const auto id = client(true);
    const studio::Picture picture = noisePicture(extent);
    session.publish(picture, false);
    const auto video = next(id);
    ASSERT_TRUE(video);
    EXPECT_EQ(video->header.codec, Codec::Vp9);
    EXPECT_FALSE(next(id, 0.5)) << "the still comes after the answer";
    streamer.received(id, video->header.frame);
    const auto still = next(id);
    ASSERT_TRUE(still);
    EXPECT_EQ(still->header.codec, Codec::Png);
    EXPECT_TRUE(still->header.lossless);
    EXPECT_EQ(studio::packedTexels(image::decodeImage(*still->bytes, "still.png")), picture.texels);
    streamer.received(id, still->header.frame);
    EXPECT_FALSE(next(id, 0.5)) << "comes twice";
    std::atomic<bool> same = false;
    streamer.requestStill([&](const Bytes& bytes) { same = *bytes == *still->bytes; });
    EXPECT_TRUE(soon([&] { return same.load(); }));
}

TEST_F(StreamerTest, SendsTheComparedPicture) {
    const auto id = client(false);
    const studio::Picture other = noisePicture(extent);
    session.publish(wavePicture(extent, 0), true, std::make_shared<const studio::Picture>(other));
    const auto a = next(id), b = next(id);
    ASSERT_TRUE(a && b);
    EXPECT_FALSE(a->header.compared);
    EXPECT_TRUE(b->header.compared);
}

TEST_F(StreamerTest, StartsAgainWithAnotherCodecAtRest) {
    const auto id = client(false);
    publish(false);
    const auto jpeg = next(id);
    ASSERT_TRUE(jpeg);
    EXPECT_EQ(jpeg->header.codec, Codec::Jpeg);
    streamer.received(id, jpeg->header.frame);
    const auto still = next(id);
    ASSERT_TRUE(still);
    streamer.received(id, still->header.frame);
    streamer.start(id, true);
    const auto video = next(id);
    ASSERT_TRUE(video);
    EXPECT_EQ(video->header.codec, Codec::Vp9);
    EXPECT_TRUE(video->header.key);
}

TEST_F(StreamerTest, ChangesItsSizeWithAKeyFrame) {
    const auto id = client(true);
    Vp9Decoder decoder;
    for (const gpu::Extent size : {gpu::Extent{64, 48}, gpu::Extent{33, 17}, gpu::Extent{64, 48}}) {
        session.publish(wavePicture(size, 0), true);
        const auto packet = next(id);
        ASSERT_TRUE(packet);
        EXPECT_TRUE(packet->header.key);
        EXPECT_EQ(packet->header.width, size.width);
        EXPECT_EQ(decoder.decode(*packet->bytes).extent, size);
        streamer.received(id, packet->header.frame);
    }
}

TEST_F(StreamerTest, ForgetsClientsThatGo) {
    const auto id = client(true);
    publish();
    streamer.remove(id);
    streamer.received(id, 1);
    streamer.start(id, true);
    EXPECT_FALSE(streamer.take(id));
}

}  // namespace
}  // namespace limpid::serve

#include "serve/stream/streamer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include "image/io/png/png.h"
#include "serve/remote/video_decoder.h"
#include "serve/session/fake_session.h"
#include "serve/stream/test_pictures.h"

namespace limpid::serve {
namespace {

constexpr gpu::Extent extent{64, 48};

/// Waits at most `seconds`; returns whether it holds.
bool soon(const std::function<bool()>& condition, double seconds = 2.0) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

class StreamerTest : public testing::Test {
  protected:
    ~StreamerTest() override { streamer.stop(); }

    Streamer::ClientId client(bool vp9, bool jpegFirst = false) {
        const auto id = streamer.add();
        streamer.start(id, vp9, jpegFirst);
        return id;
    }
    void publish(bool computing = true) { session.show(wavePicture(extent, time++), computing); }
    /// The next packet, or none after a while.
    std::optional<Packet> next(Streamer::ClientId id, double seconds = 2.0) {
        std::optional<Packet> packet;
        soon([&] { return (packet = streamer.take(id)).has_value(); }, seconds);
        return packet;
    }

    FakeSession session;
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
    EXPECT_TRUE(soon([&] { return woken > 0; }));
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

/// A decoder may fail, and nobody acknowledges what it was given.
TEST_F(StreamerTest, AClientThatStartsAgainHasNothingInFlight) {
    const auto id = client(false);
    for (int i = 0; i < 2; ++i) {
        publish();
        ASSERT_TRUE(next(id));
    }
    streamer.start(id, false);
    publish();
    const auto first = next(id);
    publish();
    ASSERT_TRUE(first && next(id));
    publish();
    EXPECT_FALSE(next(id, 0.1)) << "a third one is in flight";
    streamer.received(id, first->header.frame);
    EXPECT_TRUE(next(id));
}

/// Pictures come faster than they are encoded.
TEST_F(StreamerTest, ASlowEncoderHoldsNobodyUpAndSkipsStalePictures) {
    constexpr int pictures = 40;
    const auto id = client(true);
    const auto noise = std::make_shared<const studio::Picture>(noisePicture({1920, 1080}));
    std::vector<std::chrono::duration<double>> publishing;
    std::vector<uint64_t> snapshots;
    const auto take = [&](const std::optional<Packet>& packet) {
        if (!packet) return;
        snapshots.push_back(packet->header.snapshot);
        streamer.received(id, packet->header.frame);
    };
    for (int i = 0; i < pictures; ++i) {
        const auto another = i % 2 == 0 ? noise : std::make_shared<const studio::Picture>(*noise);
        const auto begin = std::chrono::steady_clock::now();
        session.publish([&](studio::Shown& shown) {
            shown.facts.computing = true;
            shown.picture = another;
        });
        publishing.push_back(std::chrono::steady_clock::now() - begin);
        take(streamer.take(id));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    while (snapshots.empty() || snapshots.back() < pictures) {
        const auto packet = next(id, 10.0);
        ASSERT_TRUE(packet) << "the last picture does not come";
        take(packet);
    }
    std::ranges::sort(publishing);
    EXPECT_LT(publishing[pictures / 2].count(), 0.005) << "s: the renderer waits for the encoder";
    EXPECT_LT(snapshots.size(), pictures / 2u) << "stale pictures queue";
    EXPECT_TRUE(std::ranges::is_sorted(snapshots, std::less_equal<>()));
}

/// Stages are timed for `limpid bench serve`.
TEST_F(StreamerTest, TellsTheTimeOfEachStage) {
    std::mutex mutex;
    std::map<Stage, double> times;
    FakeSession other;
    StreamSettings settings;
    settings.timed = [&](Stage stage, double milliseconds) {
        const std::lock_guard lock(mutex);
        times[stage] += milliseconds;
    };
    Streamer timed(
        other, [] {}, settings);
    const auto id = timed.add();
    timed.start(id, true);
    other.show(wavePicture({640, 480}, 0), true);
    ASSERT_TRUE(soon([&] { return timed.take(id).has_value(); }));
    timed.stop();
    EXPECT_GT(times[Stage::Convert], 0.0);
    EXPECT_GT(times[Stage::Encode], times[Stage::Convert]);
}

TEST_F(StreamerTest, ASlowClientDoesNotStopAFastOne) {
    const auto slow = client(true), fast = client(true);
    int frames = 0;
    VideoDecoder decoder;
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
    VideoDecoder decoder;
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
    session.show(picture, false);
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
    session.show(wavePicture(extent, 0), true, std::make_shared<const studio::Picture>(other));
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
    VideoDecoder decoder;
    for (const gpu::Extent size : {gpu::Extent{64, 48}, gpu::Extent{33, 17}, gpu::Extent{64, 48}}) {
        session.show(wavePicture(size, 0), true);
        const auto packet = next(id);
        ASSERT_TRUE(packet);
        EXPECT_TRUE(packet->header.key);
        EXPECT_EQ(packet->header.width, size.width);
        decoder.decode(*packet->bytes);
        EXPECT_EQ(decoder.picture().extent, size);
        streamer.received(id, packet->header.frame);
    }
}

TEST_F(StreamerTest, SendsTheInspectedImageInsteadOfThePicture) {
    const auto id = client(true);
    auto image = std::make_shared<image::Image>(20, 10, 1);
    for (size_t i = 0; i < image->pixels.size(); ++i) image->pixels[i] = static_cast<float>(i) / 200.0f;
    session.show(wavePicture(extent, 0), false);
    session.publish([&](studio::Shown& next) { next.inspected = image; });
    const auto still = [&] {
        for (;;) {
            const auto packet = next(id);
            if (!packet) return packet;
            streamer.received(id, packet->header.frame);
            if (packet->header.lossless && packet->header.inspected) return packet;
        }
    };
    const auto first = still();
    ASSERT_TRUE(first);
    EXPECT_EQ(first->header.width, 20);
    EXPECT_EQ(studio::packedTexels(image::decodeImage(*first->bytes, "still.png")),
              studio::shownTexels(*image, {}));
    // Another view is another picture, although the image is the same.
    session.publish([](studio::Shown& next) { next.state.view.falseColor = true; });
    const auto second = still();
    ASSERT_TRUE(second);
    EXPECT_EQ(studio::packedTexels(image::decodeImage(*second->bytes, "still.png")),
              studio::shownTexels(*image, {.falseColor = true}));
    session.publish([](studio::Shown& next) { next.inspected.reset(); });
    const auto picture = next(id);
    ASSERT_TRUE(picture);
    EXPECT_FALSE(picture->header.inspected);
    EXPECT_EQ(picture->header.width, extent.width);
}

TEST_F(StreamerTest, SendsEachMotionOnce) {
    const auto id = client(false);
    const auto publishMotion = [&](uint32_t width) {
        session.publish([&](studio::Shown& next) {
            next.motion = std::make_shared<const image::Image>(width, width, 4);
        });
    };
    publish();
    const auto picture = next(id);
    ASSERT_TRUE(picture);
    publishMotion(8);
    const auto motion = next(id);
    ASSERT_TRUE(motion);
    EXPECT_EQ(motion->header.codec, Codec::Motion);
    EXPECT_EQ(motion->bytes->size(), 8u * motion->header.width * motion->header.height);
    EXPECT_GT(motion->header.width, 0);
    EXPECT_FALSE(next(id, 0.1)) << "comes twice";
    publishMotion(0);
    const auto none = next(id);
    ASSERT_TRUE(none);
    EXPECT_EQ(none->header.codec, Codec::Motion);
    EXPECT_EQ(none->header.width, 0) << "this method has no motion";
    EXPECT_TRUE(none->bytes->empty());
}

// What is being encoded when a client starts again is not for it: it has asked for the other codec, or its
// new decoder has no frame that this one continues.
TEST_F(StreamerTest, AClientThatStartsAgainWhileItsPictureIsEncodedGetsANewBeginning) {
    const studio::Picture large = noisePicture({1280, 720});
    const auto id = client(true);
    for (int i = 0; i < 6; ++i) {
        session.show(large, true);
        const auto packet = next(id, 5.0);
        ASSERT_TRUE(packet);
        streamer.received(id, packet->header.frame);
        session.show(large, true);
        std::this_thread::sleep_for(std::chrono::milliseconds(2 + 2 * i));
        const bool vp9 = i % 2 == 0;
        streamer.start(id, vp9);
        const auto after = next(id, 5.0);
        ASSERT_TRUE(after);
        EXPECT_EQ(after->header.codec, vp9 ? Codec::Vp9 : Codec::Jpeg) << i;
        EXPECT_TRUE(after->header.key) << i;
        streamer.received(id, after->header.frame);
        streamer.start(id, true);
    }
}

TEST_F(StreamerTest, ANewcomerDoesNotWaitLongForAKeyFrame) {
    const auto first = client(true);
    publish();
    ASSERT_TRUE(next(first));
    // No further picture comes: frames are slow.
    const auto newcomer = client(true);
    const auto begin = std::chrono::steady_clock::now();
    const auto packet = next(newcomer);
    ASSERT_TRUE(packet);
    EXPECT_TRUE(packet->header.key);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(350));
}

/// The first picture does not wait for the encoder to start.
TEST_F(StreamerTest, TheVideoBeginsWithAJpeg) {
    const auto first = client(true, true);
    for (const Codec expected : {Codec::Jpeg, Codec::Vp9, Codec::Vp9}) {
        publish();
        const auto packet = next(first);
        ASSERT_TRUE(packet);
        EXPECT_EQ(packet->header.codec, expected);
        EXPECT_EQ(packet->header.key, packet->header.snapshot < 3) << packet->header.snapshot;
        streamer.received(first, packet->header.frame);
    }
    const auto later = client(true, true);
    publish();
    const auto packet = next(later);
    ASSERT_TRUE(packet);
    EXPECT_EQ(packet->header.codec, Codec::Vp9) << "the encoder runs already";
    EXPECT_TRUE(packet->header.key);
}

TEST_F(StreamerTest, AClientThatLostFramesGetsTheKeyFrameWhenItIsDue) {
    const auto slow = client(true), fast = client(true);
    std::vector<uint32_t> held;
    std::chrono::steady_clock::time_point key;
    for (int i = 0; i < 3; ++i) {
        publish();
        const auto packet = next(fast);
        ASSERT_TRUE(packet);
        streamer.received(fast, packet->header.frame);
        if (packet->header.key) key = std::chrono::steady_clock::now();
        if (const auto other = next(slow, 0.1)) held.push_back(other->header.frame);
    }
    ASSERT_EQ(held.size(), 2u);
    // Just before the time at which it may have one, it can take one, and nothing else happens until then.
    std::this_thread::sleep_until(key + std::chrono::milliseconds(400));
    for (const uint32_t frame : held) streamer.received(slow, frame);
    const auto packet = next(slow);
    ASSERT_TRUE(packet);
    EXPECT_TRUE(packet->header.key);
    EXPECT_LT(std::chrono::steady_clock::now() - key, std::chrono::milliseconds(750));
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

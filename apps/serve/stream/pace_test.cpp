#include "serve/stream/pace.h"

#include <gtest/gtest.h>

namespace limpid::serve {
namespace {

using namespace std::chrono_literals;
using std::chrono::microseconds;

struct Sent {
    int pictures = 0;
    microseconds age{};  ///< mean, when they are sent
};

/// What is sent in four seconds of pictures that come at this interval.
Sent sentOf(microseconds interval) {
    Pace pace;
    Sent sent;
    microseconds ages{};
    const Pace::Clock::time_point start(1h);
    auto came = start;
    bool waits = false;
    const auto send = [&](Pace::Clock::time_point now) {
        pace.note(now);
        ++sent.pictures;
        ages += std::chrono::duration_cast<microseconds>(now - came);
        waits = false;
    };
    for (auto now = start; now < start + 4s; now += interval) {
        if (waits && pace.latest() < now) send(pace.latest());
        came = now;
        waits = true;
        if (pace.isDue(now, true)) send(now);
    }
    sent.age = ages / sent.pictures;
    return sent;
}

TEST(Pace, SendsNewPicturesAtItsRate) {
    for (const auto interval : {3000us, 8000us, 9000us, 12300us, 14000us, 16000us}) {
        const Sent sent = sentOf(interval);
        EXPECT_NEAR(sent.pictures, 240, 2) << interval.count();
        EXPECT_LT(sent.age, 1500us) << interval.count();
    }
    for (const auto interval : {17000us, 20000us, 50000us}) {
        const Sent sent = sentOf(interval);
        EXPECT_NEAR(sent.pictures, 4s / interval, 1) << interval.count();
        EXPECT_EQ(sent.age, 0us) << "waits for nothing at " << interval.count();
    }
}

TEST(Pace, DoesNotCatchUpAfterAPause) {
    Pace pace;
    const Pace::Clock::time_point start(1h);
    EXPECT_TRUE(pace.isDue(start, false));
    for (const auto now : {start, start + 5s}) {
        pace.note(now);
        EXPECT_FALSE(pace.isDue(now + 8ms, true));
        EXPECT_TRUE(pace.isDue(now + 9ms, true));
        EXPECT_FALSE(pace.isDue(now + 24ms, false));
        EXPECT_TRUE(pace.isDue(now + 26ms, false));
    }
}

}  // namespace
}  // namespace limpid::serve

#include "studio/loop/mailbox.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace limpid::studio {
namespace {

using nlohmann::json;

TEST(Mailbox, GesturesAddUpAndKeepTheirPlace) {
    Mailbox mailbox;
    mailbox.post(Gesture{.orbit = {1.0f, 2.0f}});
    mailbox.post(Gesture{.orbit = {3.0f, 0.0f}, .zoom = 1.0f});
    mailbox.post(json{{"seed", 1}});
    const uint64_t last = mailbox.post(Gesture{.zoom = 2.0f});
    const auto messages = mailbox.take(0.0);
    ASSERT_EQ(messages.size(), 3u);
    const auto& first = std::get<Gesture>(messages[0].content);
    EXPECT_EQ(first.orbit, vec2(4.0f, 2.0f));
    EXPECT_EQ(first.zoom, 1.0f);
    EXPECT_EQ(messages[0].number, 2u);
    EXPECT_EQ(messages[2].number, last);
    EXPECT_TRUE(mailbox.take(0.0).empty());
}

/// Scenes have hundreds of lights, and a hand drags one of them.
TEST(Mailbox, TheNewestLightsReplaceThoseBefore) {
    Mailbox mailbox;
    mailbox.post(json{{"lights", {1}}});
    mailbox.post(json{{"lights", {1}}, {"exposure", 1.0}});
    mailbox.post(json{{"seed", 1}});
    mailbox.post(json{{"lights", {2}}});
    const uint64_t last = mailbox.post(json{{"lights", {3}}});
    const auto messages = mailbox.take(0.0);
    ASSERT_EQ(messages.size(), 3u);
    EXPECT_EQ(std::get<json>(messages[0].content).size(), 2u) << "it says more than that";
    EXPECT_EQ(std::get<json>(messages[1].content), (json{{"seed", 1}}));
    EXPECT_EQ(std::get<json>(messages[2].content), (json{{"lights", {3}}}));
    EXPECT_EQ(messages[2].number, last);
}

TEST(Mailbox, UrgentIsWhatChangesTheFrame) {
    const auto urgent = [](std::variant<json, Gesture, Request> content) {
        Mailbox mailbox;
        EXPECT_FALSE(mailbox.hasUrgentMail());
        mailbox.post(std::move(content));
        return mailbox.hasUrgentMail();
    };
    EXPECT_TRUE(urgent(Gesture{.zoom = 1.0f}));
    EXPECT_TRUE(urgent(json{{"exposure", 1.0}, {"denoiser", "svgf"}}));
    EXPECT_FALSE(urgent(json{{"exposure", 1.0}, {"pass", ""}}));
    EXPECT_FALSE(urgent(json{{"tone_curve", "agx"}}));
    EXPECT_FALSE(urgent(json{{"kept_settings", {"integrator=path"}}}));
    EXPECT_TRUE(urgent(Request{Request::Kind::SeeAll}));
    EXPECT_FALSE(urgent(Request{Request::Kind::SavePng}));
}

TEST(Mailbox, GivesTheFirstThatAreWanted) {
    const auto opens = [](const Message& message) {
        const Request* const request = std::get_if<Request>(&message.content);
        return request && request->kind == Request::Kind::Open;
    };
    Mailbox mailbox;
    EXPECT_TRUE(mailbox.takeFirst(opens).empty());
    for (int i = 0; i < 2; ++i) mailbox.post(Request{Request::Kind::Open});
    mailbox.post(Gesture{.zoom = 1.0f});
    mailbox.post(Request{Request::Kind::Open});
    EXPECT_EQ(mailbox.takeFirst(opens).size(), 2u);
    EXPECT_TRUE(mailbox.takeFirst(opens).empty()) << "a gesture comes first";
    EXPECT_EQ(mailbox.take(0.0).size(), 2u);
}

TEST(Mailbox, WakesItsReader) {
    Mailbox mailbox;
    std::thread writer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        mailbox.post(Request{Request::Kind::Step});
    });
    EXPECT_EQ(mailbox.take(60.0).size(), 1u);
    writer.join();
    std::thread closer([&] { mailbox.close(); });
    EXPECT_TRUE(mailbox.take(60.0).empty());
    closer.join();
    EXPECT_TRUE(mailbox.isClosed());
}

TEST(Mailbox, TellsListenersUntilTheyAreRemoved) {
    Mailbox mailbox;
    int heard = 0;
    const uint64_t listener = mailbox.addListener([&] { ++heard; });
    auto shown = std::make_shared<Shown>();
    shown->number = 7;
    mailbox.publish(shown);
    EXPECT_EQ(heard, 1);
    EXPECT_EQ(mailbox.shown()->number, 7u);
    mailbox.removeListener(listener);
    mailbox.publish(shown);
    EXPECT_EQ(heard, 1);
}

}  // namespace
}  // namespace limpid::studio

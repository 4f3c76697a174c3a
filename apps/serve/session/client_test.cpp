#include "serve/session/client.h"

#include <gtest/gtest.h>

#include "denoise/stages/reproject/reasons_params.h"
#include "serve/session/fake_session.h"
#include "serve/stream/test_pictures.h"

namespace limpid::serve {
namespace {

using nlohmann::json;

class ClientTest : public testing::Test {
  protected:
    ~ClientTest() override { streamer.stop(); }
    bool say(const std::string& text) { return client.receive(text, true); }
    /// The next text of a type; null if there is none.
    json next(const std::string& type) {
        while (const auto text = client.nextText()) {
            json message = json::parse(*text);
            if (message.at("type") == type) return message;
        }
        return nullptr;
    }

    FakeSession session;
    SceneFiles files{std::filesystem::path()};
    Streamer streamer{session, [] {}};
    Client client{session, streamer, files, 0};
};

TEST_F(ClientTest, GreetsFirst) {
    const auto text = client.nextText();
    ASSERT_TRUE(text);
    EXPECT_EQ(json::parse(*text).at("type"), "hello");
    EXPECT_FALSE(client.nextText()) << "nothing was published";
}

TEST_F(ClientTest, AcksCarryTheSessionsNumbers) {
    session.edit(json::object());
    EXPECT_TRUE(say(R"({"type":"edit","id":77,"changes":{"exposure":1}})"));
    const json ack = next("ack");
    EXPECT_EQ(ack.at("id"), 77);
    EXPECT_EQ(ack.at("message"), 2);
    EXPECT_TRUE(say(R"({"type":"open","id":78,"scene":"builtin:cornell"})"));
    EXPECT_EQ(next("ack").at("message"), 3);
    EXPECT_EQ(session.shown()->state.exposure, 1.0f);
    ASSERT_EQ(session.asked().size(), 1u);
    EXPECT_EQ(session.asked()[0].file, "builtin:cornell");
}

TEST_F(ClientTest, TellsWhatIsRefused) {
    // The quotation of the last one ends within a character.
    for (const std::string& text : {std::string("x"), std::string(R"({"type":"open","scene":"/etc/passwd"})"),
                                    R"({"type":"ask","request":")" + std::string(39, 'a') + "\xc3\xa4\"}"}) {
        EXPECT_TRUE(say(text));
        EXPECT_FALSE(next("refused").at("why").get<std::string>().empty());
    }
    EXPECT_EQ(session.shown()->messages, 0u);
}

TEST_F(ClientTest, JoinsPartsUpToTheLimit) {
    EXPECT_TRUE(client.receive(R"({"type":"edit","id":1,)", false));
    EXPECT_TRUE(client.receive(R"("changes":{}})", true));
    EXPECT_EQ(next("ack").at("id"), 1);
    EXPECT_TRUE(client.receive(std::string(maxTextBytes, ' '), false));
    EXPECT_FALSE(client.receive(" ", false));
}

TEST_F(ClientTest, ReadsValuesOfTheInspectedImage) {
    auto image = std::make_shared<image::Image>(2, 1, 1);
    image->pixels = {0.25f, 4.0f};
    session.publish([&](studio::Shown& next) { next.inspected = image; });
    EXPECT_TRUE(say(R"({"type":"read","id":5,"position":[0.9,0.5]})"));
    EXPECT_EQ(next("values"), (json{{"type", "values"}, {"id", 5}, {"pixel", {1, 0}}, {"values", {4.0}}}));
}

TEST_F(ClientTest, TellsWhyTheHistoryWasRejected) {
    auto image = std::make_shared<image::Image>(2, 1, 1);
    const HistoryReasons told{
        .extent = {2, 1}, .signals = {{"joint", {denoise::REASON_CUT, 1, denoise::REASON_OFF_SCREEN, 1}}}};
    session.publish([&](studio::Shown& next) {
        next.inspected = image;
        next.reasons = std::make_shared<const HistoryReasons>(told);
    });
    EXPECT_TRUE(say(R"({"type":"read","id":5,"position":[0.9,0.5]})"));
    EXPECT_EQ(next("values").at("history"), "history rejected: outside the previous picture");
}

TEST_F(ClientTest, LimitsTheRate) {
    int said = 0;
    while (said < 5000 && say(R"({"type":"steer"})")) ++said;
    EXPECT_GE(said, 990);
    EXPECT_LT(said, 3000);
}

/// A renderer that is busy keeps what is said to it.
TEST_F(ClientTest, LimitsWhatWaitsForTheRenderer) {
    const auto edit = [](const char* key, size_t bytes) {
        return json{{"type", "edit"}, {"changes", {{key, std::string(bytes, 'x')}}}}.dump();
    };
    session.busy = true;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(say(edit("lights", 900'000))) << "the newest lights alone wait";
    int said = 0;
    while (said < 20 && say(edit("pass", 900'000))) ++said;
    EXPECT_EQ(said, 5);
    session.busy = false;
    session.edit(json::object());
    EXPECT_TRUE(say(edit("pass", 900'000)));
}

TEST_F(ClientTest, TellsOnlyWhatHasChanged) {
    session.show(wavePicture({64, 48}, 0), false);
    const json first = next("state");
    EXPECT_GT(first.at("state").size(), 10u);
    EXPECT_TRUE(next("state").is_null());
    session.publish([](studio::Shown& changed) {
        changed.messages = 9;
        changed.state.exposure = 2.5f;
    });
    const json second = next("state");
    EXPECT_EQ(second.at("state"), (json{{"exposure", 2.5}}));
    EXPECT_EQ(second.at("message"), 9);
}

}  // namespace
}  // namespace limpid::serve

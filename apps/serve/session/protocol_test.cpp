#include "serve/session/protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace limpid::serve {
namespace {

template <typename T>
T content(const char* text) {
    return std::get<T>(parseMessage(text).content);
}

TEST(Protocol, ReadsEveryMessage) {
    EXPECT_TRUE(content<Start>(R"({"type":"start","codecs":["av1","vp9","jpeg"]})").vp9);
    EXPECT_TRUE(content<Start>(R"({"type":"start","codecs":["vp9","jpeg"]})").jpegFirst);
    EXPECT_FALSE(content<Start>(R"({"type":"start","codecs":["vp9"]})").jpegFirst);
    EXPECT_FALSE(content<Start>(R"({"type":"start","codecs":["jpeg","vp9"]})").vp9);
    EXPECT_FALSE(content<Start>(R"({"type":"start","codecs":["jpeg","vp9"]})").jpegFirst);
    EXPECT_EQ(content<Received>(R"({"type":"received","frame":4294967295})").frame, 4294967295u);
    EXPECT_EQ(content<Edit>(R"({"type":"edit","changes":{"exposure":1.5}})").changes.at("exposure"), 1.5);
    EXPECT_EQ(content<Open>(R"({"type":"open","scene":"builtin:cornell"})").scene, "builtin:cornell");
    const auto gesture = content<studio::Gesture>(
        R"({"type":"steer","orbit":[1,2],"look":[3,4],"pan":[5,6],"fly":[7,8,9],"zoom":-1,"speed":2})");
    EXPECT_EQ(gesture.orbit, vec2(1, 2));
    EXPECT_EQ(gesture.look, vec2(3, 4));
    EXPECT_EQ(gesture.pan, vec2(5, 6));
    EXPECT_EQ(gesture.fly, vec3(7, 8, 9));
    EXPECT_EQ(gesture.zoom, -1.0f);
    EXPECT_EQ(gesture.speed, 2.0f);
    const auto request =
        content<studio::Request>(R"({"type":"ask","request":"probe","position":[0.25,1],"index":3})");
    EXPECT_EQ(request.kind, studio::Request::Kind::Probe);
    EXPECT_EQ(request.position[0], 0.25f);
    EXPECT_EQ(request.index, 3);
    EXPECT_EQ(content<Read>(R"({"type":"read","position":[0.5,1]})").position,
              (std::array<float, 2>{0.5f, 1.0f}));
    EXPECT_EQ(parseMessage(R"({"type":"steer","id":18446744073709551615})").id, UINT64_MAX);
}

TEST(Protocol, ReadsEveryRequestOfHello) {
    const nlohmann::json hello = helloMessage({"builtin:cornell"}, 0);
    EXPECT_EQ(hello.at("scenes"), nlohmann::json::array({"builtin:cornell"}));
    EXPECT_GT(hello.at("requests").size(), 5u);
    for (const auto& name : hello.at("requests")) {
        const std::string text = nlohmann::json{{"type", "ask"}, {"request", name}}.dump();
        EXPECT_NO_THROW(parseMessage(text)) << text;
    }
    EXPECT_FALSE(hello.at("fields").empty());
    EXPECT_LT(hello.dump().size(), 1u << 20);
}

TEST(Protocol, SaysWhichDenoisersHaveAPart) {
    const nlohmann::json hello = helloMessage({}, 0);
    const auto denoisersOf = [&](const char* key) -> std::vector<std::string> {
        for (const auto& field : hello.at("fields"))
            if (field.at("key") == key) return field.value("denoisers", std::vector<std::string>());
        return {"there is no such field"};
    };
    EXPECT_THAT(denoisersOf("part.temporal"),
                testing::UnorderedElementsAre("temporal", "svgf", "nano", "film", "atrous"));
    EXPECT_THAT(denoisersOf("part.spatial"),
                testing::UnorderedElementsAre("svgf", "nano", "film", "atrous", "bilateral"));
    EXPECT_THAT(denoisersOf("seed"), testing::IsEmpty());
}

TEST(Protocol, ExplainsTheChoicesThatNeedIt) {
    const nlohmann::json hello = helloMessage({}, 0);
    size_t explained = 0;
    for (const auto& field : hello.at("fields")) {
        if (!field.contains("choice_help")) continue;
        EXPECT_EQ(field.at("choice_help").size(), field.at("choices").size()) << field.at("key");
        ++explained;
    }
    EXPECT_EQ(explained, 2u) << "integrator and denoiser";
}

TEST(Protocol, RefusesWhatIsNoMessage) {
    for (const char* text : {"",
                             "x",
                             "null",
                             "5",
                             "\"start\"",
                             "[]",
                             "{}",
                             "{\"type\":5}",
                             R"({"type":"none"})",
                             R"({"type":"start"})",
                             R"({"type":"start","codecs":[]})",
                             R"({"type":"start","codecs":"av1"})",
                             R"({"type":"start","codecs":[5]})",
                             R"({"type":"received"})",
                             R"({"type":"received","frame":-1})",
                             R"({"type":"received","frame":4294967296})",
                             R"({"type":"received","frame":1.5})",
                             R"({"type":"received","frame":"1"})",
                             R"({"type":"edit"})",
                             R"({"type":"open","scene":5})",
                             R"({"type":"open"})",
                             R"({"type":"steer","orbit":1})",
                             R"({"type":"steer","orbit":[1]})",
                             R"({"type":"steer","orbit":[1,2,3]})",
                             R"({"type":"steer","orbit":[1,null]})",
                             R"({"type":"steer","zoom":1e30})",
                             R"({"type":"steer","zoom":1e300})",
                             R"({"type":"steer","zoom":1e999})",
                             R"({"type":"steer","zoom":NaN})",
                             R"({"type":"steer","zoom":"1"})",
                             R"({"type":"steer","id":-1})",
                             R"({"type":"steer","id":18446744073709551616})",
                             R"({"type":"ask"})",
                             R"({"type":"ask","request":"save_png"})",
                             R"({"type":"ask","request":"open"})",
                             R"({"type":"ask","request":"probe","position":[0]})",
                             R"({"type":"ask","request":"probe","position":[0,1.1]})",
                             R"({"type":"ask","request":"probe","position":[-1,0]})",
                             R"({"type":"read"})",
                             R"({"type":"read","position":[0,2]})",
                             R"({"type":"read","position":[0,null]})",
                             R"({"type":"ask","request":"remove_lamp","index":-1})",
                             R"({"type":"ask","request":"remove_lamp","index":1e9})",
                             "{\"type\":\"open\",\"scene\":\"\xff\"}",
                             R"({"type":"steer"} x)"})
        EXPECT_THROW(parseMessage(text), UsageError) << text;
}

TEST(Protocol, RefusesDeepAndLongMessages) {
    const auto edit = [](const std::string& changes) {
        return R"({"type":"edit","changes":)" + changes + "}";
    };
    const auto nested = [](size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    EXPECT_NO_THROW(parseMessage(edit(nested(10))));
    EXPECT_THROW(parseMessage(edit(nested(100))), UsageError);
    EXPECT_THROW(parseMessage(edit(nested(30000))), UsageError);
    // Brackets in a string close nothing, and open nothing.
    EXPECT_THROW(parseMessage(R"({"x":")" + std::string(1000, ']') + R"(","type":"edit","changes":)" +
                              nested(1000) + "}"),
                 UsageError);
    EXPECT_NO_THROW(parseMessage(edit('"' + std::string(1000, '[') + '"')));
    EXPECT_THROW(parseMessage(edit('"' + std::string(maxTextBytes, 'x') + '"')), UsageError);
}

TEST(Protocol, HeadersComeBack) {
    const FrameHeader header{.codec = Codec::Png,
                             .key = false,
                             .compared = true,
                             .lossless = true,
                             .inspected = true,
                             .width = 65535,
                             .height = 258,
                             .frame = 0xfedcba98u,
                             .message = 0x0123456789abcdefu,
                             .snapshot = UINT64_MAX};
    const auto bytes = packed(header);
    EXPECT_EQ(unpackedHeader(bytes), header);
    EXPECT_EQ(bytes[0], std::byte{3});
    EXPECT_EQ(bytes[1], std::byte{14});
    EXPECT_EQ(bytes[6], std::byte{2}) << "little endian";
    EXPECT_EQ(bytes[16], std::byte{0xef});
    EXPECT_THROW(unpackedHeader(std::span(bytes).first(31)), Error);
    EXPECT_THROW(unpackedHeader(std::array<std::byte, frameHeaderBytes>{}), Error);
}

}  // namespace
}  // namespace limpid::serve

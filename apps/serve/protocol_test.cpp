#include "serve/protocol.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "serve/access.h"
#include "serve/token.h"
#include "serve/yuv.h"

namespace limpid::serve {
namespace {

TEST(Protocol, ReadsEachMessage) {
    EXPECT_TRUE(
        std::get<Start>(parseMessage(R"({"type":"start","codecs":["av1","vp9","jpeg"]})").content).vp9);
    EXPECT_FALSE(std::get<Start>(parseMessage(R"({"type":"start","codecs":["jpeg","vp9"]})").content).vp9);
    EXPECT_EQ(std::get<Received>(parseMessage(R"({"type":"received","frame":5})").content).frame, 5u);
    const ClientMessage edit = parseMessage(R"({"type":"edit","id":9,"changes":{"spp":2}})");
    EXPECT_EQ(edit.id, 9u);
    EXPECT_EQ(std::get<Edit>(edit.content).changes.at("spp"), 2);
    EXPECT_NO_THROW(parseMessage(R"({"type":"edit","changes":{"viewport":[5120,2880]}})"));
    const auto gesture = std::get<studio::Gesture>(
        parseMessage(R"({"type":"steer","orbit":[1,2],"fly":[0,0,3],"zoom":-1})").content);
    EXPECT_EQ(gesture.orbit, vec2(1.0f, 2.0f));
    EXPECT_EQ(gesture.fly, vec3(0.0f, 0.0f, 3.0f));
    EXPECT_EQ(gesture.zoom, -1.0f);
    const auto request = std::get<studio::Request>(
        parseMessage(R"({"type":"ask","request":"probe","position":[0.25,1]})").content);
    EXPECT_EQ(request.kind, studio::Request::Kind::Probe);
    EXPECT_EQ(request.position, (std::array{0.25f, 1.0f}));
    EXPECT_EQ(std::get<Open>(parseMessage(R"({"type":"open","scene":"a.glb"})").content).scene, "a.glb");
}

TEST(Protocol, RefusesEverythingElse) {
    for (const char* text :
         {"", "null", "{}", R"({"type":1})", R"({"type":"steer","orbit":[1]})",
          R"({"type":"steer","zoom":1e30})", R"({"type":"steer","zoom":"1"})", R"({"type":"received"})",
          R"({"type":"received","frame":1.5})", R"({"type":"received","frame":4294967296})",
          R"({"type":"start","codecs":[]})", R"({"type":"ask","request":"save_exr"})",
          R"({"type":"ask","request":"probe","position":[2,0]})",
          R"({"type":"ask","request":"remove_lamp","index":-1})", R"({"type":"edit"})",
          R"({"type":"edit","changes":{},"id":-1})",
          R"({"type":"edit","changes":{"viewport":[16384,16384]}})",
          R"({"type":"edit","changes":{"viewport":[4096,4097]}})"})
        EXPECT_THROW(parseMessage(text), UsageError) << text;
    EXPECT_THROW(parseMessage(std::string(maxTextBytes + 1, ' ')), UsageError);
    EXPECT_THROW(parseMessage(std::string(1000, '[') + std::string(1000, ']')), UsageError);
}

TEST(Protocol, HeadersSurvive) {
    const FrameHeader header{.codec = Codec::Png,
                             .key = true,
                             .compared = true,
                             .lossless = true,
                             .width = 1920,
                             .height = 1080,
                             .frame = 0x89abcdef,
                             .message = 0x0123456789abcdef,
                             .snapshot = 77};
    EXPECT_EQ(unpackedHeader(packed(header)), header);
    EXPECT_EQ(std::to_integer<int>(packed(header)[4]), 1920 & 0xff);
    EXPECT_THROW(unpackedHeader(std::vector<std::byte>(31)), Error);
    EXPECT_THROW(unpackedHeader(std::vector<std::byte>(32)), Error);
}

TEST(Access, HostsAndOrigins) {
    EXPECT_TRUE(isAllowedHost("127.0.0.2:1", "127.0.0.2"));
    EXPECT_FALSE(isAllowedHost("127.0.0.3:1", "127.0.0.2"));
    EXPECT_FALSE(isAllowedHost("localhost:1x", "127.0.0.1"));
    EXPECT_FALSE(isAllowedHost("", "0.0.0.0"));
    EXPECT_TRUE(isAllowedHost("render.example:443", "0.0.0.0"));
    EXPECT_TRUE(isAllowedOrigin("https://a:1", "a:1", true));
    EXPECT_FALSE(isAllowedOrigin("http://a:1", "a:1", true));
}

TEST(Token, IsRandomAndCompared) {
    const std::string token = makeToken();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_NE(token, makeToken());
    EXPECT_TRUE(sameToken(token, token));
    EXPECT_FALSE(sameToken(token, token.substr(1)));
    EXPECT_FALSE(sameToken("", token));
}

TEST(Yuv, KnownColoursAndOddSizes) {
    // BT.709, limited range: white 235 128 128, red 63 102 240.
    const auto planes = [](uint32_t texel) {
        std::vector<uint8_t> y(15), cb(6), cr(6);
        const studio::Picture picture{{5, 3}, std::vector<uint32_t>(15, texel)};
        toYuv420(picture, {y.data(), 5}, {cb.data(), 3}, {cr.data(), 3});
        return std::array{y[14], cb[5], cr[5]};
    };
    EXPECT_EQ(planes(0xffffffff), (std::array<uint8_t, 3>{235, 128, 128}));
    EXPECT_EQ(planes(0xff0000ff), (std::array<uint8_t, 3>{63, 102, 240}));
    EXPECT_EQ(planes(0xff000000), (std::array<uint8_t, 3>{16, 128, 128}));
}

}  // namespace
}  // namespace limpid::serve

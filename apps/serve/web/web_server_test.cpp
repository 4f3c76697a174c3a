#include "serve/web/web_server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "base/error.h"
#include "image/io/png/png.h"
#include "serve/remote/remote_socket.h"
#include "serve/remote/video_decoder.h"
#include "serve/session/fake_session.h"
#include "serve/session/protocol.h"
#include "serve/stream/test_pictures.h"
#include "serve/web/token.h"

namespace limpid::serve {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

constexpr unsigned headerSeconds = 2;
constexpr double stillSeconds = 0.5;
constexpr double patience = 10.0;
constexpr uint64_t largestUpload = 20000;

/// Smooth colours, shifted by `step`: video must be able to keep it.
studio::Picture gradient(uint32_t width, uint32_t height, uint32_t step) {
    studio::Picture picture{{width, height}, {}};
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x)
            picture.texels.push_back(((x + step) & 0xff) | (y & 0xff) << 8 | ((x / 2 + y / 2) & 0xff) << 16 |
                                     0xff000000u);
    }
    return picture;
}

/// While it lives, writing a file beyond 4096 bytes fails, as on a full disk.
class SmallFiles {
  public:
    SmallFiles() : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit small = before_;
        small.rlim_cur = 4096;
        ::setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallFiles() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    SmallFiles(const SmallFiles&) = delete;
    SmallFiles& operator=(const SmallFiles&) = delete;

  private:
    void (*handler_)(int);
    rlimit before_{};
};

struct Frame {
    FrameHeader header;
    std::string bytes;
};

/// A client that answers each picture.
class Viewer {
  public:
    Viewer(int port, const std::string& token, const char* codec = "") : session_(port, token) {
        if (*codec) say({{"type", "start"}, {"codecs", json::array({codec})}});
    }
    void say(const json& message) { session_.sendText(message.dump()); }
    /// Waits for a text of this type that the condition holds for.
    template <typename Condition>
    json text(const std::string& type, Condition condition) {
        return wait<json>([&](const RemoteMessage& message) -> std::optional<json> {
            if (message.kind != RemoteMessage::Kind::Text) return std::nullopt;
            json content = json::parse(message.bytes);
            return content.at("type") == type && condition(content) ? std::optional(content) : std::nullopt;
        });
    }
    json text(const std::string& type) {
        return text(type, [](const json&) { return true; });
    }
    template <typename Condition>
    Frame picture(Condition condition) {
        return wait<Frame>([&](const RemoteMessage& message) -> std::optional<Frame> {
            if (message.kind != RemoteMessage::Kind::Picture) return std::nullopt;
            Frame frame{unpackedHeader(std::as_bytes(std::span(message.bytes))),
                        message.bytes.substr(frameHeaderBytes)};
            if (answers) say({{"type", "received"}, {"frame", frame.header.frame}});
            return condition(frame) ? std::optional(std::move(frame)) : std::nullopt;
        });
    }
    int closeCode() {
        return wait<int>([](const RemoteMessage& message) {
            return message.kind == RemoteMessage::Kind::Closed ? std::optional(message.closeCode)
                                                               : std::nullopt;
        });
    }
    RemoteSession& session() { return session_; }
    bool answers = true;

  private:
    template <typename Result, typename Function>
    Result wait(Function function) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
        while (std::chrono::steady_clock::now() < end) {
            const std::optional<RemoteMessage> message = session_.receive(patience);
            if (!message) break;
            if (auto result = function(*message)) return std::move(*result);
            if (message->kind == RemoteMessage::Kind::Closed)
                throw Error("the server has closed the session");
        }
        throw Error("the server does not say what was expected");
    }
    RemoteSession session_;
};

/// One server for all cases, with a folder of scenes.
class WebServerTest : public testing::Test {
  protected:
    struct Shared {
        fs::path root = fs::temp_directory_path() / fmt::format("limpid_serve_test.{}", ::getpid());
        FakeSession session;
        std::unique_ptr<SceneFiles> files;
        ServeSettings settings;
        std::string token = makeToken();
        std::unique_ptr<WebServer> server;
        std::atomic<bool> ends = false;
        std::thread thread;

        Shared() {
            // Both ends of a thousand connections are in this process.
            rlimit limit{};
            ::getrlimit(RLIMIT_NOFILE, &limit);
            limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, 8192);
            ::setrlimit(RLIMIT_NOFILE, &limit);
            fs::create_directories(root / "scenes/deep");
            for (const char* name : {"secret.glb", "scenes/a.glb", "scenes/deep/b.obj", "scenes/notes.txt"})
                std::ofstream(root / name) << "x";
            fs::create_symlink(root / "secret.glb", root / "scenes/link.glb");
            files = std::make_unique<SceneFiles>(root / "scenes");
            settings.headerSeconds = headerSeconds;
            settings.stillSeconds = stillSeconds;
            settings.uploads = largestUpload;
            settings.origins = {"https://limpid.example"};
            session.show(gradient(64, 48, 0), false);
            server = std::make_unique<WebServer>(session, settings, *files, token);
            thread = std::thread([this] { server->run([this] { return ends.load(); }); });
        }
        ~Shared() {
            ends = true;
            thread.join();
            server.reset();
            fs::remove_all(root);
        }
    };
    static std::unique_ptr<Shared> shared;
    static void SetUpTestSuite() { shared = std::make_unique<Shared>(); }
    static void TearDownTestSuite() { shared.reset(); }

    static int port() { return shared->server->port(); }
    static std::string host() { return fmt::format("127.0.0.1:{}", port()); }
    static const std::string& token() { return shared->token; }
    static FakeSession& session() { return shared->session; }

    /// The answer to these bytes, as long as it says that it is.
    static std::string answerTo(const std::string& request) {
        RemoteSocket socket(port());
        socket.send(request);
        std::string answer;
        const std::string length = "content-length: ";
        while (const auto part = socket.receive(patience)) {
            if (part->empty()) break;
            answer += *part;
            const size_t end = answer.find("\r\n\r\n"), at = answer.find(length);
            if (end == std::string::npos || at > end) continue;
            if (answer.size() >= end + 4 + std::stoull(answer.substr(at + length.size()))) break;
        }
        return answer;
    }
    static std::string get(const std::string& path, const std::string& host) {
        return answerTo(fmt::format("GET {} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n", path, host));
    }
    static std::string get(const std::string& path) { return get(path, host()); }
    static std::string post(const std::string& query, const std::string& body, const std::string& more = {}) {
        return answerTo(
            fmt::format("POST /upload?{} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n{}Content-Length: {}"
                        "\r\n\r\n{}",
                        query, host(), more, body.size(), body));
    }
    static void expectAlive() { EXPECT_THAT(get("/?token=" + token()), StartsWith("HTTP/1.1 200")); }
};
std::unique_ptr<WebServerTest::Shared> WebServerTest::shared;

TEST_F(WebServerTest, SendsThePageToWhoHasTheToken) {
    const std::string page = get("/?token=" + token());
    EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(page, HasSubstr("text/html"));
    for (const char* header :
         {"content-security-policy: default-src 'none'", "x-content-type-options: nosniff",
          "referrer-policy: no-referrer", "frame-ancestors 'none'", "cache-control: no-store"})
        EXPECT_THAT(page, HasSubstr(header));
    std::string wrong = token();
    wrong.back() = wrong.back() == '0' ? '1' : '0';
    for (const std::string& path :
         std::vector<std::string>{"/", "/?token=" + wrong, "/?token=" + token().substr(1),
                                  "/?token=", "/picture.png", "/picture.png?token=" + wrong})
        EXPECT_THAT(get(path), StartsWith("HTTP/1.1 403")) << path;
}

TEST_F(WebServerTest, RefusesOtherHosts) {
    for (const char* other :
         {"evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost:80@evil", "[::1]x"})
        EXPECT_THAT(get("/?token=" + token(), other), StartsWith("HTTP/1.1 421")) << other;
    for (const char* own : {"localhost", "localhost:9000", "[::1]:9000"})
        EXPECT_THAT(get("/?token=" + token(), own), StartsWith("HTTP/1.1 200")) << own;
    RemoteSocket socket(port());
    socket.send(sessionRequest("evil.example", token()));
    EXPECT_THAT(socket.receiveAll(patience), Not(HasSubstr("101")));
}

TEST_F(WebServerTest, RefusesSessionsOfOtherSites) {
    const auto opens = [](const std::string& token, const std::string& origin) {
        RemoteSocket socket(port());
        socket.send(sessionRequest(host(), token, origin));
        return socket.receive(patience).value_or("").starts_with("HTTP/1.1 101");
    };
    EXPECT_TRUE(opens(token(), ""));
    EXPECT_TRUE(opens(token(), "http://" + host()));
    for (const std::string& origin :
         {std::string("http://evil.example"), std::string("null"), "https://" + host(),
          "http://" + host() + ".evil.example", std::string("http://127.0.0.1")})
        EXPECT_FALSE(opens(token(), origin)) << origin;
    EXPECT_TRUE(opens(token(), "https://limpid.example")) << "a proxy";
    EXPECT_THAT(get("/?token=" + token(), "limpid.example"), StartsWith("HTTP/1.1 200"));
    EXPECT_FALSE(opens(token(), "http://limpid.example"));
    EXPECT_FALSE(opens("", ""));
    EXPECT_FALSE(opens(std::string(32, '0'), ""));
}

TEST_F(WebServerTest, SendsNoFilesButThePages) {
    for (const char* path :
         {"/../secret.glb", "/scenes/a.glb", "/%2e%2e/secret.glb", "/..%2f..%2fetc/passwd", "//etc/passwd",
          "/a.glb", "/index.html%00", "/./../../../../etc/passwd", "/.git/config"})
        EXPECT_THAT(get(path), Not(StartsWith("HTTP/1.1 200"))) << path;
    expectAlive();
}

TEST_F(WebServerTest, OpensScenesOfItsFolderOnly) {
    Viewer viewer(port(), token());
    const auto scenes = viewer.text("hello").at("scenes").get<std::vector<std::string>>();
    EXPECT_THAT(scenes, testing::IsSupersetOf({"a.glb", "deep/b.obj", "builtin:cornell"}));
    EXPECT_THAT(scenes, Not(testing::Contains(HasSubstr("notes"))));
    const size_t before = session().asked().size();
    for (const std::string& name :
         {std::string("../secret.glb"), (shared->root / "secret.glb").string(), std::string("link.glb"),
          std::string("notes.txt"), std::string("a.glb/../a.glb"), std::string("")}) {
        viewer.say({{"type", "open"}, {"scene", name}});
        EXPECT_THAT(viewer.text("refused").at("why").get<std::string>(), HasSubstr("no such scene")) << name;
    }
    viewer.say({{"type", "open"}, {"scene", "deep/b.obj"}, {"id", 7}});
    EXPECT_EQ(viewer.text("ack").at("id"), 7);
    const auto asked = session().asked();
    ASSERT_EQ(asked.size(), before + 1);
    EXPECT_EQ(asked.back().kind, studio::Request::Kind::OpenDropped) << "a folder's files are not trusted";
    EXPECT_EQ(asked.back().file, fs::canonical(shared->root / "scenes/deep/b.obj").string());
}

TEST_F(WebServerTest, OpensUploadsAsUntrustedFiles) {
    const size_t before = session().asked().size();
    const std::string good = "token=" + token() + "&name=room.glb", body(900, 'x');
    EXPECT_THAT(post("name=room.glb", body), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(post(good, body, "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
    // Refused by its head: closing the connection while a body arrives could lose the answer.
    EXPECT_THAT(answerTo(fmt::format("POST /upload?{} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n"
                                     "Content-Length: {}\r\n\r\n",
                                     good, host(), largestUpload + 1)),
                StartsWith("HTTP/1.1 413"));
    for (const char* name : {"..%2froom.glb", "%2ftmp%2froom.glb", ".glb", "room.sh", "room", ""})
        EXPECT_THAT(post("token=" + token() + "&name=" + name, body), StartsWith("HTTP/1.1 400")) << name;
    EXPECT_THAT(post("token=" + token() + "&name=a%00.glb", body), Not(HasSubstr(" 200 ")));
    EXPECT_EQ(session().asked().size(), before);
    EXPECT_THAT(post(good, body), StartsWith("HTTP/1.1 200"));
    const auto asked = session().asked();
    ASSERT_EQ(asked.size(), before + 1);
    EXPECT_EQ(asked.back().kind, studio::Request::Kind::OpenDropped);
    EXPECT_EQ(fs::path(asked.back().file).filename(), "room.glb");
    EXPECT_EQ(fs::file_size(asked.back().file), 900u);
    for (const char* name : {"ROOM.GLB", "Sky.Hdr", "room.glb", "room.glb"})
        EXPECT_THAT(post("token=" + token() + "&name=" + name, body), StartsWith("HTTP/1.1 200")) << name;
    EXPECT_FALSE(fs::exists(asked.back().file)) << "the oldest of five is removed";
    EXPECT_EQ(Viewer(port(), token()).text("hello").at("uploads"), largestUpload);
}

TEST_F(WebServerTest, KeepsTheUploadsThatAreShown) {
    const std::string good = "token=" + token() + "&name=room.glb", body(900, 'x');
    std::vector<std::string> files;
    const auto send = [&] {
        EXPECT_THAT(post(good, body), StartsWith("HTTP/1.1 200"));
        files.push_back(session().asked().back().file);
    };
    send();
    session().publish([&](studio::Shown& next) { next.facts.files = {"builtin:cornell", files.front()}; });
    for (int i = 0; i < 5; ++i) send();
    EXPECT_TRUE(fs::exists(files[0])) << "it is shown";
    EXPECT_FALSE(fs::exists(files[1]));
    EXPECT_TRUE(fs::exists(files.back()));
    // A renderer that is busy has yet to say what it uses.
    session().busy = true;
    for (int i = 0; i < 4; ++i) send();
    session().publish([](studio::Shown& next) { next.facts.files.clear(); });
    send();
    for (size_t i = files.size() - 4; i < files.size(); ++i) EXPECT_TRUE(fs::exists(files[i])) << i;
    EXPECT_THAT(post(good, body), StartsWith("HTTP/1.1 503")) << "its disk is not filled meanwhile";
    session().busy = false;
    session().edit(json::object());
    send();
    EXPECT_FALSE(fs::exists(files[0]));
}

TEST_F(WebServerTest, SurvivesAnUploadThatCannotBeStored) {
    const std::string query = "token=" + token() + "&name=room.glb", body(900, 'x');
    ASSERT_THAT(post(query, body), StartsWith("HTTP/1.1 200"));
    const fs::path folder = fs::path(session().asked().back().file).parent_path().parent_path();
    const fs::path away = folder.string() + ".away";
    fs::rename(folder, away);
    EXPECT_THAT(post(query, body), StartsWith("HTTP/1.1 507"));
    expectAlive();
    fs::rename(away, folder);
    EXPECT_THAT(post(query, body), StartsWith("HTTP/1.1 200"));
}

TEST_F(WebServerTest, SurvivesAFullDisk) {
    // Fails while it arrives, as it is longer than what a stream keeps before it writes; or only at the end.
    for (const size_t size : {size_t{largestUpload}, size_t{5000}}) {
        const std::string query = "token=" + token() + "&name=room.glb", body(size, 'x');
        const size_t before = session().asked().size();
        std::string answer;
        {
            const SmallFiles meanwhile;
            answer = post(query, body);
        }
        EXPECT_THAT(answer, StartsWith("HTTP/1.1 507")) << size;
        EXPECT_EQ(session().asked().size(), before);
        EXPECT_THAT(post(query, body), StartsWith("HTTP/1.1 200")) << size;
        EXPECT_EQ(fs::file_size(session().asked().back().file), size);
    }
    expectAlive();
}

TEST_F(WebServerTest, RefusesWhatIsNoMessage) {
    Viewer viewer(port(), token());
    const size_t before = session().asked().size();
    for (const std::string& text :
         {std::string("{"), std::string("[]"), std::string(R"({"type":"nothing"})"),
          std::string(R"({"type":"ask","request":"save_png"})"),
          std::string(R"({"type":"ask","request":"open"})"),
          std::string(R"({"type":"steer","orbit":[1e9,0]})"),
          std::string(R"({"type":"received","frame":-1})"), std::string(60000, '[')}) {
        viewer.session().sendText(text);
        viewer.text("refused");
    }
    EXPECT_EQ(session().asked().size(), before);
    Viewer other(port(), token());
    other.session().sendText(std::string(maxTextBytes + 1, ' '));
    EXPECT_NE(other.closeCode(), 1000);
    for (const uint8_t first : {0x82, 0x83, 0xf1, 0x80}) {
        Viewer strange(port(), token());
        strange.session().sendFrame(first, "{}");
        EXPECT_NE(strange.closeCode(), 1000) << int(first);
    }
    expectAlive();
}

TEST_F(WebServerTest, DisconnectsWhoFloodsIt) {
    Viewer viewer(port(), token());
    for (int i = 0; i < 10000; ++i) {
        if (!viewer.session().sendText(R"({"type":"steer","orbit":[0,0]})")) break;
    }
    const auto isClosed = [&] {
        try {
            return viewer.closeCode() != 1000;
        } catch (const Error&) {
            return false;
        }
    };
    EXPECT_TRUE(isClosed());
    expectAlive();
}

TEST_F(WebServerTest, OneClientsEditIsSeenByTheOther) {
    Viewer one(port(), token()), other(port(), token());
    other.text("state");
    one.say({{"type", "edit"}, {"changes", {{"exposure", 1.5}}}, {"id", 3}});
    const uint64_t number = one.text("ack").at("message");
    const json seen =
        other.text("state", [](const json& text) { return text["state"].contains("exposure"); });
    EXPECT_EQ(seen["state"]["exposure"], 1.5);
    EXPECT_GE(seen["message"].get<uint64_t>(), number);
    one.say({{"type", "edit"}, {"changes", {{"exposure", "much"}}}});
    other.text("facts", [](const json& text) {
        return text["facts"].value("fault", "").find("exposure") != std::string::npos;
    });
}

TEST_F(WebServerTest, VideoIsCloseAndTheStillIsExact) {
    Viewer viewer(port(), token(), "vp9");
    VideoDecoder decoder;
    studio::Picture decoded;
    const auto isVideo = [&](const Frame& frame) {
        if (frame.header.codec != Codec::Vp9) return false;
        decoder.decode(std::as_bytes(std::span(frame.bytes)));
        decoded = decoder.picture();
        return true;
    };
    for (uint32_t step = 0; step < 8; ++step) {
        session().show(gradient(320, 180, step), true);
        const uint64_t number = session().shown()->number;
        viewer.picture([&](const Frame& frame) { return isVideo(frame) && frame.header.snapshot >= number; });
        ASSERT_EQ(decoded.extent, (gpu::Extent{320, 180}));
        EXPECT_GT(psnr(decoded, gradient(320, 180, step)), 32.0) << step;
        EXPECT_LT(psnr(decoded, gradient(320, 180, step + 60)), 25.0) << "the measure tells pictures apart";
    }
    const studio::Picture last = gradient(320, 180, 9);
    session().show(last, false);
    const Frame still = viewer.picture([&](const Frame& frame) {
        isVideo(frame);
        return frame.header.lossless && frame.header.snapshot >= session().shown()->number;
    });
    EXPECT_EQ(still.header.codec, Codec::Png);
    const auto texels =
        studio::packedTexels(image::decodeImage(std::as_bytes(std::span(still.bytes)), "still"));
    EXPECT_EQ(texels, last.texels);
    const std::string http = get("/picture.png?token=" + token());
    EXPECT_EQ(http.substr(http.find("\r\n\r\n") + 4), still.bytes);
}

TEST_F(WebServerTest, SaysThatThereIsNoPictureInFullSize) {
    session().publish([](studio::Shown& next) { next.state.viewport = {128, 96}; });
    const auto begin = std::chrono::steady_clock::now();
    const std::string answer = get("/picture.png?token=" + token());
    EXPECT_GE(std::chrono::steady_clock::now() - begin, std::chrono::duration<double>(stillSeconds));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 504"));
    EXPECT_THAT(answer, HasSubstr("no picture in full size"));
    session().show(gradient(128, 96, 0), false);
    EXPECT_THAT(get("/picture.png?token=" + token()), StartsWith("HTTP/1.1 200"));
    // Nor is one of a method that stands in for the chosen one.
    for (bool studio::Facts::*const standsIn : {&studio::Facts::standsIn, &studio::Facts::compiling}) {
        session().publish([&](studio::Shown& next) { next.facts.*standsIn = true; });
        EXPECT_THAT(get("/picture.png?token=" + token()), StartsWith("HTTP/1.1 504"));
        session().publish([&](studio::Shown& next) { next.facts.*standsIn = false; });
        EXPECT_THAT(get("/picture.png?token=" + token()), StartsWith("HTTP/1.1 200"));
    }
}

TEST_F(WebServerTest, InspectedImagesAndMotionReachTheClient) {
    session().show(gradient(64, 48, 0), false);
    Viewer viewer(port(), token(), "vp9");
    auto image = std::make_shared<image::Image>(32, 24, 3);
    for (size_t i = 0; i < image->pixels.size(); ++i) image->pixels[i] = static_cast<float>(i % 7) / 7.0f;
    auto moved = std::make_shared<image::Image>(64, 48, 4);
    for (size_t i = 0; i < moved->pixels.size(); i += 4) {
        moved->pixels[i] = -6.4f;
        moved->pixels[i + 3] = 1.0f;
    }
    session().publish([&](studio::Shown& next) {
        next.inspected = image;
        next.motion = moved;
    });
    bool hasMotion = false;
    std::optional<Frame> still;
    while (!hasMotion || !still) {
        Frame frame = viewer.picture(
            [](const Frame& f) { return f.header.codec == Codec::Motion || f.header.inspected; });
        if (frame.header.codec == Codec::Motion) {
            EXPECT_EQ(frame.header.width, 2);
            EXPECT_EQ(frame.header.height, 2);
            ASSERT_EQ(frame.bytes.size(), 32u);
            float x = 0.0f;
            std::memcpy(&x, frame.bytes.data(), sizeof(x));
            EXPECT_FLOAT_EQ(x, -0.1f);
            hasMotion = true;
        } else if (frame.header.lossless) {
            still = std::move(frame);
        }
    }
    EXPECT_EQ(studio::packedTexels(image::decodeImage(std::as_bytes(std::span(still->bytes)), "still")),
              studio::shownTexels(*image, {}));
    viewer.say({{"type", "read"}, {"position", {0.5, 0.0}}, {"id", 8}});
    const json values = viewer.text("values");
    EXPECT_EQ(values.at("id"), 8);
    EXPECT_EQ(values.at("pixel"), json({16, 0}));
    EXPECT_EQ(values.at("values").at(2).get<float>(), image->at(16, 0, 2));
    session().publish([&](studio::Shown& next) { next.inspected.reset(), next.motion.reset(); });
    viewer.picture([](const Frame& f) { return !f.header.inspected && f.header.width == 64; });
    viewer.say({{"type", "read"}, {"position", {0.5, 0.0}}, {"id", 9}});
    EXPECT_FALSE(viewer.text("values").contains("values"));
}

TEST_F(WebServerTest, JpegIsForPagesWithoutVideo) {
    Viewer viewer(port(), token(), "jpeg");
    session().show(gradient(160, 90, 20), true);
    const uint64_t number = session().shown()->number;
    const Frame frame = viewer.picture([&](const Frame& f) { return f.header.snapshot >= number; });
    EXPECT_EQ(frame.header.codec, Codec::Jpeg);
    const auto bytes = image::decodeImage(std::as_bytes(std::span(frame.bytes)), "frame");
    EXPECT_GT(psnr({{160, 90}, studio::packedTexels(bytes)}, gradient(160, 90, 20)), 30.0);
}

TEST_F(WebServerTest, ASlowClientDoesNotSlowTheOther) {
    Viewer fast(port(), token(), "vp9"), slow(port(), token(), "vp9");
    slow.answers = false;
    slow.picture([](const Frame&) { return true; });
    const auto begin = std::chrono::steady_clock::now();
    for (uint32_t step = 0; step < 30; ++step) {
        session().show(gradient(160, 90, step), true);
        const uint64_t number = session().shown()->number;
        fast.picture([&](const Frame& frame) { return frame.header.snapshot >= number; });
    }
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
    // What the slow one did not answer is not followed by more.
    int sent = 1;
    while (const auto message = slow.session().receive(0.3))
        sent += message->kind == RemoteMessage::Kind::Picture;
    EXPECT_LE(sent, 2);
    // When it answers, it gets the newest picture, as one that it can decode.
    slow.answers = true;
    for (uint32_t frame = 1; frame <= 2; ++frame) slow.say({{"type", "received"}, {"frame", frame}});
    session().show(gradient(160, 90, 50), true);
    const Frame next = slow.picture([](const Frame&) { return true; });
    EXPECT_TRUE(next.header.key);
    EXPECT_LE(session().shown()->number - next.header.snapshot, 1u);
}

TEST_F(WebServerTest, WaitsForNobodysHeaders) {
    RemoteSocket slow(port());
    const auto begin = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    };
    slow.send("GET / HTTP/1.1\r\n");
    bool closed = false;
    while (!closed && elapsed() < patience) {
        const auto bytes = slow.receive(0.2);
        closed = (bytes && bytes->empty()) || !slow.send("a: b\r\n");
    }
    EXPECT_TRUE(closed) << "a header line now and then must not keep a connection open";
    EXPECT_GT(elapsed(), 0.5 * headerSeconds);
    EXPECT_LT(elapsed(), 2.0 * headerSeconds + 1.0);
}

TEST_F(WebServerTest, SurvivesAThousandConnections) {
    std::vector<RemoteSocket> sockets;
    for (int i = 0; i < 1000; ++i) {
        sockets.emplace_back(port());
        if (i % 3 == 1) sockets.back().send("GET / HT");
        if (i % 3 == 2) sockets.back().send(std::string("\x16\x03\x01\0\xff\xff", 6));
    }
    expectAlive();
    Viewer viewer(port(), token());
    viewer.text("hello");
}

TEST_F(WebServerTest, SurvivesRequestsThatAreNone) {
    for (const std::string& request :
         {std::string("\0\0\0\0", 4), std::string("GET\r\n\r\n"), std::string(200000, 'A'),
          "GET /" + std::string(100000, 'a') + " HTTP/1.1\r\n\r\n",
          "GET / HTTP/1.1\r\nHost: " + std::string(50000, 'h') + "\r\n\r\n",
          "POST /?token=" + token() + " HTTP/1.1\r\nHost: " + host() +
              "\r\nContent-Length: 99999999999\r\n\r\nx",
          "DELETE / HTTP/1.1\r\nHost: " + host() + "\r\n\r\n",
          std::string("GET / HTTP/9.9\r\nHost:\r\n\r\n")}) {
        RemoteSocket socket(port());
        socket.send(request);
        EXPECT_THAT(socket.receiveAll(0.5), Not(HasSubstr(" 200 "))) << request.substr(0, 40);
    }
    expectAlive();
}

}  // namespace
}  // namespace limpid::serve

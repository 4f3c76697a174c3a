// `limpid serve` as a program, and its client `limpid bench serve`. apps/serve has the tests of the server
// itself.
#include <regex>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

constexpr const char* small = "builtin:cornell --device cpu --width 64 --height 36 ";

class CliServeTest : public CliTest {
  protected:
    /// Starts the server, runs a command of the shell with the page's address as $url, and interrupts the
    /// server.
    static Result serve(const std::string& options, const std::string& command) {
        return runProgram(
            "out=$(mktemp); env --default-signal=INT '" + std::string(LIMPID_PROGRAM) + "' serve " + small +
            "--port 0 " + options + " >$out 2>&1 & server=$!; " +
            "for i in $(seq 200); do url=$(grep -o 'https*://.*' $out) && break; sleep 0.05; done; " +
            command + "; kill -INT $server; wait $server; code=$?; cat $out; rm $out; exit $code");
    }
};

TEST_F(CliServeTest, PrintsTheAddressAndEndsOnCtrlC) {
    const Result result = serve("", "curl -s -o /dev/null -w 'status %{http_code}\\n' \"$url\"");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_NE(result.output.find("status 200"), std::string::npos) << result.output;
    EXPECT_TRUE(
        std::regex_search(result.output, std::regex(R"(http://127\.0\.0\.1:[0-9]+/\?token=[0-9a-f]{32})")))
        << result.output;
    EXPECT_EQ(result.output.find("will be written"), std::string::npos) << result.output;
}

TEST_F(CliServeTest, SpeaksTls) {
    const std::string pair = "--certificate '" + path("cert.pem") + "' --key '" + path("key.pem") + "'";
    const Result made =
        runProgram("openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -keyout '" +
                   path("key.pem") + "' -out '" + path("cert.pem") + "'");
    ASSERT_EQ(made.code, 0) << made.output;
    const Result result = serve(
        pair, "curl -s --cacert '" + path("cert.pem") +
                  "' -o /dev/null -w 'status %{http_code}\\n' \"$(echo $url | sed s/127.0.0.1/localhost/)\"");
    EXPECT_EQ(result.code, 0) << result.output;
    EXPECT_NE(result.output.find("status 200"), std::string::npos) << result.output;
    EXPECT_NE(result.output.find("https://127.0.0.1:"), std::string::npos) << result.output;
}

TEST_F(CliServeTest, RefusesAndWarns) {
    expect("serve " + std::string(small) + "--certificate a.pem", 2,
           "--certificate and --key belong together");
    expect("serve " + std::string(small) + "--port 0 --files '" + path("none") + "'", 3, "no such folder");
    const std::string pair = "--port 0 --certificate '" + path("a") + "' --key '" + path("b") + "'";
    expect("serve " + std::string(small) + pair, 3, "does not exist");
    put("a", "no certificate");
    put("b", "no key");
    expect("serve " + std::string(small) + pair, 1, "the certificate or its key cannot be read");
    expect("serve " + std::string(small) + "--port 0 --origin limpid.example", 2, "is no origin");
    const Result proxied =
        serve("--origin https://limpid.example",
              "curl -s -H 'Host: limpid.example' -o /dev/null -w 'status %{http_code}\\n' \"$url\"");
    EXPECT_NE(proxied.output.find("status 200"), std::string::npos) << proxied.output;
    const Result open = serve("--bind 0.0.0.0", "true");
    EXPECT_NE(open.output.find("can be reached from other machines"), std::string::npos) << open.output;
}

TEST_F(CliServeTest, BenchMeasuresBothCodecs) {
    for (const std::string codec : {"vp9", "jpeg"}) {
        const Result result =
            run("bench serve " + std::string(small) + "--seconds 1 --steps 3 --codec " + codec);
        EXPECT_EQ(result.code, 0) << result.output;
        std::smatch match;
        ASSERT_TRUE(std::regex_search(result.output, match, std::regex("latency: ([0-9.]+) ms median")))
            << result.output;
        EXPECT_GT(std::stod(match[1]), 0.0);
        ASSERT_TRUE(std::regex_search(result.output, match, std::regex("rate: ([0-9.]+) frames/s")))
            << result.output;
        EXPECT_GT(std::stod(match[1]), 0.0);
        const bool video = codec == "vp9";
        for (const char* stage : {"render", "download", "convert", "encode", "send", "decode"}) {
            const bool ofVideo = std::string(stage) == "convert" || std::string(stage) == "decode";
            const std::regex time("stages: .*" + std::string(stage) + " ([0-9.]+) ms");
            EXPECT_EQ(std::regex_search(result.output, time), video || !ofVideo) << stage << "\n"
                                                                                 << result.output;
        }
    }
}

}  // namespace
}  // namespace limpid

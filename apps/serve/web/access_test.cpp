#include "serve/web/access.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"

namespace limpid::serve {
namespace {

TEST(Access, AllowsThisMachinesNamesWithAnyPort) {
    for (const char* host : {"127.0.0.1:8080", "localhost:9999", "localhost", "[::1]:8080", "[::1]"})
        EXPECT_TRUE(isAllowedHost(host, "127.0.0.1")) << host;
    EXPECT_TRUE(isAllowedHost("[::1]:8080", "::1"));
    EXPECT_TRUE(isAllowedHost("127.0.0.5:80", "127.0.0.5"));
}

TEST(Access, RefusesNamesThatWereMadeToPointHere) {
    for (const char* host : {"", "evil.example", "evil.example:8080", "localhost.evil.example:8080",
                             "127.0.0.1.evil.example", "127.0.0.1:80.evil.example",
                             "localhost:8080@evil.example", "[::1].evil.example:8080", "[::1", "::1"})
        EXPECT_FALSE(isAllowedHost(host, "127.0.0.1")) << host;
}

TEST(Access, KnowsNoNamesOfOtherAddresses) {
    EXPECT_TRUE(isAllowedHost("workstation.example:8080", "0.0.0.0"));
    EXPECT_FALSE(isAllowedHost("", "0.0.0.0"));
    EXPECT_FALSE(isLoopback("0.0.0.0"));
    EXPECT_FALSE(isLoopback("::"));
    EXPECT_TRUE(isLoopback("127.1.2.3"));
}

/// A proxy passes the page on, with its own name or with ours.
TEST(Access, AllowsOriginsOfProxies) {
    const std::vector<std::string> origins{parseOrigin("https://Limpid.example/"),
                                           parseOrigin("http://proxy:8443")};
    EXPECT_TRUE(isAllowedOrigin("https://limpid.example", "127.0.0.1:8080", false, origins));
    EXPECT_TRUE(isAllowedOrigin("http://proxy:8443", "proxy:8443", false, origins));
    for (const char* origin : {"http://limpid.example", "https://limpid.example:8443",
                               "https://limpid.example.evil.example", "https://evil.example", "null"})
        EXPECT_FALSE(isAllowedOrigin(origin, "127.0.0.1:8080", false, origins)) << origin;
    EXPECT_TRUE(isAllowedHost("limpid.example", "127.0.0.1", origins));
    EXPECT_TRUE(isAllowedHost("proxy:8443", "127.0.0.1", origins));
    for (const char* host : {"evil.example", "limpid.example:80", "proxy", "https"})
        EXPECT_FALSE(isAllowedHost(host, "127.0.0.1", origins)) << host;
    for (const char* text : {"", "limpid.example", "https://", "ftp://limpid.example", "https:///",
                             "https://limpid.example/page", "https://limpid.example?a", "https://me@limpid"})
        EXPECT_THROW(parseOrigin(text), UsageError) << text;
}

TEST(Access, AllowsOnlyTheOwnOrigin) {
    EXPECT_TRUE(isAllowedOrigin("", "localhost:8080", false)) << "no browser";
    EXPECT_TRUE(isAllowedOrigin("http://localhost:8080", "localhost:8080", false));
    EXPECT_TRUE(isAllowedOrigin("https://localhost:8080", "localhost:8080", true));
    EXPECT_TRUE(isAllowedOrigin("http://localhost:9000", "localhost:9000", false))
        << "ssh -L 9000:localhost:8080";
    for (const char* origin :
         {"null", "http://evil.example", "https://localhost:8080", "http://localhost:8081",
          "http://localhost", "http://localhost:8080.evil.example", "localhost:8080"})
        EXPECT_FALSE(isAllowedOrigin(origin, "localhost:8080", false)) << origin;
}

}  // namespace
}  // namespace limpid::serve

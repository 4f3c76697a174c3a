#include "serve/web/token.h"

#include <gtest/gtest.h>

namespace limpid::serve {
namespace {

TEST(Token, Has128BitsAndDiffers) {
    const std::string a = makeToken(), b = makeToken();
    EXPECT_EQ(a.size(), 32u);
    EXPECT_EQ(a.find_first_not_of("0123456789abcdef"), std::string::npos) << a;
    EXPECT_NE(a, b);
}

TEST(Token, IsComparedWhole) {
    const std::string token = makeToken();
    EXPECT_TRUE(sameToken(token, token));
    for (size_t i = 0; i < token.size(); ++i) {
        std::string other = token;
        other[i] = other[i] == '0' ? '1' : '0';
        EXPECT_FALSE(sameToken(other, token)) << i;
        EXPECT_FALSE(sameToken(token.substr(0, i), token)) << i;
    }
    EXPECT_FALSE(sameToken(token + "0", token));
}

}  // namespace
}  // namespace limpid::serve

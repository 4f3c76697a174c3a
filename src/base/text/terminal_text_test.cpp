#include "base/text/terminal_text.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace limpid {
namespace {

TEST(TerminalText, LeavesPlainTextAndUtf8AsTheyAre) {
    for (const char* text : {"", "a b.exr", "\xC3\xA4\xE2\x82\xAC\xF0\x9F\x98\x80", "back\\slash"})
        EXPECT_EQ(terminalText(text), text);
}

TEST(TerminalText, EscapesControlCharacters) {
    EXPECT_EQ(terminalText("a\x1b[2Jb"), "a\\x1b[2Jb");
    EXPECT_EQ(terminalText("\r\x7f"), "\\x0d\\x7f");
    EXPECT_EQ(terminalText(std::string_view("\0", 1)), "\\x00");
    EXPECT_EQ(terminalText("\xC2\x9B"), "\\xc2\\x9b") << "U+009B starts an escape sequence, too";
    EXPECT_EQ(terminalText("\xC2\xA0"), "\xC2\xA0");
    EXPECT_EQ(terminalText("a\nb\tc"), "a\\x0ab\\x09c");
    EXPECT_EQ(terminalText("a\nb\tc\x1b", LineBreaks::Keep), "a\nb\tc\\x1b");
}

TEST(TerminalText, EscapesWhatIsNotUtf8) {
    EXPECT_EQ(terminalText("\xff"), "\\xff");
    EXPECT_EQ(terminalText("\xC3"), "\\xc3") << "cut off";
    EXPECT_EQ(terminalText("\xC0\x80"), "\\xc0\\x80") << "overlong";
    EXPECT_EQ(terminalText("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(terminalText("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(TerminalText, ErrorsEscapeTheNamesOfFiles) {
    EXPECT_STREQ(InputError("a\n\x1b.exr", "is bad").what(), "a\\x0a\\x1b.exr: is bad");
    EXPECT_STREQ(OutputError("\r.exr", "is bad").what(), "\\x0d.exr: is bad");
    EXPECT_STREQ(UsageError("'a\nerror: b'").what(), "'a\\x0aerror: b'");
}

}  // namespace
}  // namespace limpid

// The page of `limpid serve` in a browser.
#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using CliServePageTest = CliTest;

TEST_F(CliServePageTest, DoesWhatTheWindowDoes) {
    const std::string script = std::string(LIMPID_SOURCE_DIR) + "/tests/cli/serve_page";
    const Result result =
        runProgram("python3 '" + script + "' '" + LIMPID_PROGRAM + "' '" + folder_.string() + "'");
    if (result.code == 77) GTEST_SKIP() << result.output;
    EXPECT_EQ(result.code, 0) << result.output;
}

}  // namespace
}  // namespace limpid

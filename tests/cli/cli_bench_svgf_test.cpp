// Tests `limpid bench svgf`: the three charts, as numbers and as pictures.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/cli/cli_fixture.h"

namespace limpid {
namespace {

using nlohmann::json;

class CliBenchSvgfTest : public CliTest {};

TEST_F(CliBenchSvgfTest, StagesTrianglesAndLevels) {
    const Result result = run(
        "bench svgf --device cpu --width 24 --height 14 --frames 1 --warmup 1 --scene builtin:cornell --json "
        "--out '" +
        path("plots") + "'");
    ASSERT_EQ(result.code, 0) << result.output;
    const size_t start = std::min(result.output.find('{'), result.output.size());
    const json bench = json::parse(result.output.substr(start), nullptr, false);
    ASSERT_TRUE(bench.is_object()) << result.output;

    for (const char* stage : {"path tracing", "surfaces", "reprojection", "tiles", "anti-lag", "variance",
                              "a-trous levels", "young pixels", "composition", "anti-aliasing"})
        EXPECT_GT(bench["ms"][stage].get<double>(), 0.0) << stage;
    ASSERT_GE(bench["scenes"].size(), 5u);
    for (size_t i = 1; i < bench["scenes"].size(); ++i)
        EXPECT_LE(bench["scenes"][i - 1]["triangles"], bench["scenes"][i]["triangles"]);
    ASSERT_EQ(bench["levels"].size(), 8u);
    for (const char* name : {"svgf-stages.svg", "svgf-triangles.svg", "svgf-levels.svg"}) {
        const std::string svg = get(std::string("plots/") + name);
        EXPECT_TRUE(svg.starts_with("<svg ")) << name;
        EXPECT_TRUE(svg.ends_with("</svg>\n")) << name;
        EXPECT_EQ(svg.find("nan"), std::string::npos) << name;
    }
}

}  // namespace
}  // namespace limpid

// Tests that shaders whose constants are set before the driver sees them are valid and compute the same.
#include "gpu/specialise/specialise.h"

#include <algorithm>
#include <map>

#include "gpu/vulkan/execute/dynamic_params.h"
#include "scene/builtin/builtin.h"
#include "shader_list.h"
#include "tests/gpu/render_fixture.h"

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
#include "tests/gpu/spirv_validator.h"
#endif

namespace limpid::test {
namespace {

// From the SPIR-V specification: "Instructions", "Decoration".
enum : uint32_t { opSpecConstantTrue = 48, opSpecConstantFalse = 49, opDecorate = 71, decorationSpecId = 1 };

std::vector<std::span<const uint32_t>> instructionsOf(std::span<const uint32_t> words) {
    std::vector<std::span<const uint32_t>> result;
    for (size_t at = 5; at < words.size(); at += result.back().size())
        result.push_back(words.subspan(at, std::clamp<size_t>(words[at] >> 16, 1, words.size() - at)));
    return result;
}

/// The ids of all boolean constants: those of numbers must keep their defaults, since some are sizes.
std::vector<uint32_t> switchesOf(std::span<const uint32_t> words) {
    std::map<uint32_t, uint32_t> ids;  // of constants, by result
    std::vector<uint32_t> switches;
    for (const std::span instruction : instructionsOf(words)) {
        const uint32_t op = instruction[0] & 0xFFFFu;
        if (op == opDecorate && instruction[2] == decorationSpecId) ids[instruction[1]] = instruction[3];
        if ((op == opSpecConstantTrue || op == opSpecConstantFalse) && ids.contains(instruction[2]))
            switches.push_back(ids[instruction[2]]);
    }
    return switches;
}

class SpecialiseTest : public GpuTest {
  protected:
    void SetUp() override {
        if (!gpu::specialiser())
            GTEST_SKIP() << "NOT TESTED: Limpid was built without SPIRV-Tools' optimiser (spirv-tools).";
        GpuTest::SetUp();
    }
};

#if LIMPID_HAVE_SPIRV_TOOLS_OPT
TEST_F(SpecialiseTest, AllShadersStayValid) {
    SpirvValidator validator;
    for (const shaders::Listed& listed : shaders::listed()) {
        const std::span<const uint32_t> words = listed.code->words;
        const std::vector<uint32_t> switches = switchesOf(words);
        if (switches.empty()) continue;
        size_t sizes[2];
        for (const uint32_t on : {0u, 1u}) {
            gpu::SpecialisationConstants constants;
            for (const uint32_t id : switches) constants.emplace_back(id, on);
            const std::vector<uint32_t> result = gpu::specialiser()(words, constants);
            sizes[on] = result.size();
            EXPECT_TRUE(validator.accepts(result))
                << listed.code->name << ", all switches " << on << ": " << validator.fault();
            EXPECT_TRUE(switchesOf(result).empty()) << listed.code->name;
            const std::vector<uint32_t> dynamic = gpu::withDynamicParams(result);
            EXPECT_TRUE(validator.accepts(dynamic))
                << listed.code->name << ", as CPUs get it: " << validator.fault();
        }
        EXPECT_LT(std::min(sizes[0], sizes[1]), words.size()) << listed.code->name;
    }
}
#endif

TEST_F(SpecialiseTest, GarbageIsLeftToTheDriver) {
    const std::vector<uint32_t> garbage(100, 0xDEADBEEFu);
    EXPECT_TRUE(gpu::specialiser()(garbage, {{1, 1}}).empty());
}

/// The driver sets the constants of one device, SPIRV-Tools those of the other.
TEST_F(SpecialiseTest, PicturesStayTheSame) {
    const scene::Scene scene = scene::builtinScene("cornell-spheres");
    gpu::Device plain({.select = wantedDevice()});
    RenderSettings settings;
    settings.extent = {24, 24};
    const Rendered expected = Renderer(plain, scene)(settings, 2);
    EXPECT_EQ(Renderer(device(), scene)(settings, 2).layers.beauty, expected.layers.beauty);
}

}  // namespace
}  // namespace limpid::test

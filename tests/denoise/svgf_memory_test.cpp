// Tests that SVGF takes as much memory as docs/denoising.md says.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/denoise/denoise_fixture.h"

namespace limpid::test {
namespace {

using SvgfMemoryTest = DenoiseTest;

TEST_F(SvgfMemoryTest, IsWhatTheBenchmarksSay) {
    const denoise::Denoiser* const method = denoise::findDenoiser("svgf");
    ASSERT_NE(method, nullptr);
    constexpr uint32_t columns = 64, rows = 40;
    const HostFrame frame = SyntheticScene({}).frame(0, columns, rows, 0);
    for (const bool separate : {false, true}) {
        DenoiserSettings settings;
        settings.svgf.separate = separate;
        denoise(*method, frame, settings);
        // With one signal, images of one pixel stand for those that levels would write for the second.
        const double others = separate ? 0.0 : 8 + 4;
        const double bytes = static_cast<double>(graph_.bytesOfImagesWrittenFrom(0)) - others;
        EXPECT_EQ(bytes / double{columns} / double{rows}, separate ? 184.625 : 108.3125);
        // With one signal, the same image is bound to both.
        const auto modulate =
            std::ranges::find(graph_.passes(), std::string("svgf/compose"), &gpu::RecordedPass::name);
        ASSERT_NE(modulate, graph_.passes().end());
        EXPECT_EQ(modulate->imageBytes, uint64_t{columns} * rows * (separate ? 2 * 8 + 4 * 16 : 8 + 4 * 16));
    }
}

}  // namespace
}  // namespace limpid::test

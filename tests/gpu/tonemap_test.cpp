// Compares the tone-mapping pass with the one for files.
#include "image/tonemap.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "image/io/png/png.h"
#include "passes/tonemap/tonemap.h"
#include "tests/gpu/gpu_fixture.h"

namespace limpid::test {
namespace {

using TonemapTest = GpuTest;

TEST_F(TonemapTest, ShowsWhatFilesShow) {
    image::Image radiance(61, 47, 4);
    std::mt19937 generator(3);
    std::uniform_real_distribution<float> stops(-18.0f, 14.0f);
    for (float& value : radiance.pixels) value = std::exp2(stops(generator));
    const float special[] = {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity(), 1e38f};
    std::copy(std::begin(special), std::end(special), radiance.pixels.begin());
    using image::ToneCurve;
    for (const auto& [exposure, curve] :
         {std::pair(0.0f, ToneCurve::Standard), std::pair(-3.5f, ToneCurve::Standard),
          std::pair(6.0f, ToneCurve::Standard), std::pair(0.0f, ToneCurve::Agx),
          std::pair(1.0f, ToneCurve::None), std::pair(0.0f, ToneCurve::FalseColor)}) {
        gpu::FrameGraph graph;
        graph.beginFrame();
        const gpu::ImageHandle source = graph.transient("radiance", gpu::Format::RGBA32Float, {61, 47});
        graph.upload(source, gpu::bytesOf(radiance.pixels));
        const gpu::ImageHandle display = tonemap(graph, source, exposure, {}, curve);
        graph.execute(device());
        const std::vector<float> shown = graph.downloadFloat(device(), display);
        const image::Image expected = image::tonemap(radiance, exposure, curve);
        for (size_t i = 0; i < shown.size(); ++i)
            ASSERT_NEAR(shown[i], i % 4 == 3 ? 1.0f : expected.pixels[i], 1.0f / 255.0f)
                << i << " at " << exposure << ", " << image::nameOf(curve);
    }
}

/// Beyond paper white, up to the largest value; half floats have 11 bits.
TEST_F(TonemapTest, ExtendedShowsWhatFilesClip) {
    const std::vector<float> radiance{0.0f,  0.18f, 1.0f,   1.0f, 2.0f, 50.0f, 1000.0f,  1.0f,
                                      -1.0f, NAN,   0.002f, 1.0f, 8.0f, 0.5f,  INFINITY, 1.0f};
    gpu::FrameGraph graph;
    graph.beginFrame();
    const gpu::ImageHandle source = graph.transient("radiance", gpu::Format::RGBA32Float, {4, 1});
    graph.upload(source, gpu::bytesOf(radiance));
    const gpu::ImageHandle display = tonemapExtended(graph, source, 1.0f);
    graph.execute(device());
    EXPECT_EQ(graph.format(display), gpu::Format::RGBA16Float);
    const std::vector<float> shown = graph.downloadFloat(device(), display);
    for (size_t pixel = 0; pixel < 4; ++pixel) {
        const float* const p = &radiance[4 * pixel];
        const vec3 expected = image::extendedColor(2.0f * vec3(p[0], p[1], p[2]));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(shown[4 * pixel + static_cast<size_t>(c)], expected[c],
                        1e-3f * std::max(expected[c], 0.1f))
                << pixel << ", " << c;
    }
}

}  // namespace
}  // namespace limpid::test

// Ambient occlusion of one ray per pixel and frame under a moving camera: the denoiser of visibility is as
// near to a converged picture as SVGF, which filters the same frames as light.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/builtin/builtin.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

constexpr gpu::Extent extent{160, 90};

class VisibilityQualityTest : public SequenceTest {
  protected:
    static RenderSettings settingsOf(const char* denoiser, uint32_t seed, int rays) {
        RenderSettings settings;
        settings.extent = extent;
        settings.seed = seed;
        settings.jitter = Jitter::Off;
        settings.pipeline = parsePipeline("ao", denoiser);
        settings.ambientOcclusion.rays = rays;
        return settings;
    }

    image::Image denoised(const char* denoiser, uint64_t frame) {
        FrameRenderer renderer(device(), *gpuScene_, settingsOf(denoiser, 1, 1), 1);
        for (uint64_t number = 0; number <= frame; ++number)
            renderer.render(sequence_->moment(number, extent));
        return beautyOf(renderer.download());
    }

    image::Image converged(uint64_t frame) {
        FrameRenderer renderer(device(), *gpuScene_, settingsOf("none", 2, 256), 1);
        renderer.render(sequence_->moment(frame, extent));
        return beautyOf(renderer.download());
    }

    static double errorOf(const image::Image& picture, const image::Image& truth) {
        double squares = 0.0;
        for (size_t i = 0; i < truth.pixels.size(); ++i)
            squares +=
                (double{picture.pixels[i]} - truth.pixels[i]) * (double{picture.pixels[i]} - truth.pixels[i]);
        return std::sqrt(squares / static_cast<double>(truth.pixels.size()));
    }

    void compare(uint64_t frame) {
        const image::Image truth = converged(frame);
        const double error = errorOf(denoised("visibility", frame), truth);
        const double svgf = errorOf(denoised("svgf", frame), truth);
        const double temporal = errorOf(denoised("temporal", frame), truth);
        RecordProperty("visibility", std::to_string(error));
        RecordProperty("svgf", std::to_string(svgf));
        EXPECT_LE(error, 1.05 * svgf) << "frame " << frame;
        EXPECT_LT(error, temporal) << "frame " << frame;
    }
};

TEST_F(VisibilityQualityTest, IsThatOfSvgfUnderAMovingCamera) {
    load(scene::cornellSpheresScene(), {}, "orbit");
    compare(16);
}

TEST_F(VisibilityQualityTest, IsThatOfSvgfWhereObjectsMove) {
    load(scene::cornellMovingScene(), {}, "orbit");
    compare(12);
}

}  // namespace
}  // namespace limpid::test

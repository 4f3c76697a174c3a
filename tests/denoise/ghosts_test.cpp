// Tests for ghosts of a moving object: compares the bias of denoised frames where the object has been with
// that elsewhere on the same wall.
#include <gmock/gmock.h>

#include <cmath>
#include <map>

#include "base/log.h"
#include "scene/builtin/builtin.h"
#include "tests/denoise/sequence_fixture.h"

namespace limpid::test {
namespace {

constexpr gpu::Extent extent{160, 90};
constexpr size_t pixels = size_t{extent.width} * extent.height;
constexpr uint64_t lastFrame = 30;

/// Two sets of pixels, both showing the same wall: where the object was in an earlier frame, and where it
/// never was.
struct Regions {
    std::vector<bool> swept, elsewhere;
};

/// Networks take most of the time, and leave so little noise that few draws of it tell their bias.
uint32_t seedsFor(const denoise::Denoiser& method) {
    if (method.name == std::string_view("film")) return 3;
    return method.name == std::string_view("nano") ? 6 : 8;
}

/// Returns the mean over the region of (mean - truth)^2 minus the mean's own variance.
double squaredBias(const std::vector<std::vector<float>>& pictures, const image::Image& truth,
                   const std::vector<bool>& region) {
    const auto seeds = static_cast<double>(pictures.size());
    double sum = 0.0;
    size_t count = 0;
    for (size_t p = 0; p < pixels; ++p) {
        if (!region[p]) continue;
        for (size_t c = 0; c < 3; ++c) {
            double mean = 0.0, squares = 0.0;
            for (const auto& picture : pictures) mean += double{picture[4 * p + c]} / seeds;
            for (const auto& picture : pictures) squares += std::pow(double{picture[4 * p + c]} - mean, 2);
            const double variance = squares / (seeds - 1);
            sum += std::pow(mean - double{truth.pixels[3 * p + c]}, 2) - variance / seeds;
            ++count;
        }
    }
    return sum / static_cast<double>(count);
}

/// Returns the mean of truth^2 over the region.
double meanSquare(const image::Image& truth, const std::vector<bool>& region) {
    double sum = 0.0;
    size_t count = 0;
    for (size_t p = 0; p < pixels; ++p) {
        if (!region[p]) continue;
        for (size_t c = 0; c < 3; ++c) sum += std::pow(double{truth.pixels[3 * p + c]}, 2);
        count += 3;
    }
    return sum / static_cast<double>(count);
}

class GhostsTest : public SequenceTest {
  protected:
    void SetUp() override {
        RenderTest::SetUp();
        if (IsSkipped()) return;
        load(scene::cornellMovingScene());
    }

    RenderSettings settings(const Pipeline& pipeline, uint32_t seed) const {
        RenderSettings result;
        result.extent = extent;
        result.seed = seed;
        result.jitter = Jitter::Off;
        result.denoisers.taa.frames = taaFrames_;
        result.pipeline = pipeline;
        result.layers = true;
        return result;
    }

    /// Returns the beauty of the last frame; passes the `ids` of every frame to `look`.
    template <typename Look>
    std::vector<float> denoised(const Pipeline& pipeline, uint32_t seed, Look look) {
        FrameRenderer renderer(device(), *gpuScene_, settings(pipeline, seed), 1);
        RenderedLayers layers;
        for (uint64_t frame = 0; frame <= lastFrame; ++frame) {
            renderer.render(sequence_->moment(frame, extent));
            if (frame < lastFrame && seed > 1) continue;
            layers = renderer.download();
            look(layers.ids);
        }
        return layers.beauty;
    }

    /// The wall is the static object that moving ones uncover most.
    Regions regions() {
        std::vector<std::vector<uint32_t>> seen;
        denoised(parsePipeline("path", "temporal"), 1, [&](const std::vector<uint32_t>& ids) {
            std::vector<uint32_t> instances(pixels);
            for (size_t p = 0; p < pixels; ++p) instances[p] = ids[2 * p];
            seen.push_back(instances);
        });
        const auto moves = [&](uint32_t instance) {
            return instance < scene_.instances.size() &&
                   scene_.instances[instance].movement != scene::Movement::Still;
        };
        const std::vector<uint32_t>& now = seen.back();
        std::vector<bool> covered(pixels, false);
        std::map<uint32_t, size_t> uncovered;
        for (size_t p = 0; p < pixels; ++p) {
            for (const auto& frame : seen) covered[p] = covered[p] || moves(frame[p]);
            if (covered[p] && !moves(now[p])) ++uncovered[now[p]];
        }
        uint32_t wall = 0;
        for (const auto& [instance, count] : uncovered) {
            if (count > uncovered[wall]) wall = instance;
        }
        Regions result{std::vector<bool>(pixels), std::vector<bool>(pixels)};
        for (size_t p = 0; p < pixels; ++p) {
            result.swept[p] = now[p] == wall && covered[p];
            result.elsewhere[p] = now[p] == wall && !covered[p];
        }
        return result;
    }

    /// Expects the same error in both regions. `temporal` has 1.3 to 1.5 times as much where the object was,
    /// by sets of seeds: it has no filter, and histories are shorter there.
    void expectNoGhosts(const denoise::Denoiser& method, const image::Image& truth, const Regions& found) {
        const double margin = method.name == std::string_view("temporal") ? 1.7 : 1.3;
        std::vector<std::vector<float>> pictures;
        for (uint32_t seed = 1; seed <= seedsFor(method); ++seed)
            pictures.push_back(denoised({Integrator::Path, &method}, seed, [](const auto&) {}));
        const double swept = squaredBias(pictures, truth, found.swept);
        const double elsewhere = squaredBias(pictures, truth, found.elsewhere);
        log::info("{}: squared bias {:.3e} where the object was ({} pixels), {:.3e} elsewhere ({})",
                  method.name, swept, sizeOf(found.swept), elsewhere, sizeOf(found.elsewhere));
        EXPECT_LE(swept, margin * elsewhere) << method.name;
        EXPECT_LE(elsewhere, 0.01 * meanSquare(truth, found.elsewhere))
            << method.name << " is wrong everywhere";
    }

    static std::ptrdiff_t sizeOf(const std::vector<bool>& region) {
        return std::count(region.begin(), region.end(), true);
    }

    float taaFrames_ = 1.0f;
};

/// Removes the pixels that are not surrounded by their region, two pixels deep.
std::vector<bool> inner(const std::vector<bool>& region) {
    std::vector<bool> result(pixels);
    const auto width = static_cast<int>(extent.width), height = static_cast<int>(extent.height);
    for (int p = 0; p < static_cast<int>(pixels); ++p) {
        bool whole = true;
        for (int k = 0; k < 25 && whole; ++k) {
            const int x = p % width + k % 5 - 2, y = p / width + k / 5 - 2;
            whole = x >= 0 && y >= 0 && x < width && y < height &&
                    region[static_cast<size_t>(y) * extent.width + static_cast<size_t>(x)];
        }
        result[static_cast<size_t>(p)] = whole;
    }
    return result;
}

TEST_F(GhostsTest, WhereAnObjectHasBeenThePictureIsAsRightAsElsewhere) {
    const Regions found = regions();
    ASSERT_GT(sizeOf(found.swept), 100);
    ASSERT_GT(sizeOf(found.elsewhere), 100);
    const image::Image truth = reference(lastFrame, settings({}, 0), 2048);
    for (const denoise::Denoiser& method : denoise::denoisers()) {
        if (method.keepsHistory && !method.network && !method.oneChannel)
            expectNoGhosts(method, truth, found);
    }
    // At silhouettes, anti-aliasing shows something else than the reference, which is aliased.
    taaFrames_ = 4.0f;
    const Regions inside{inner(found.swept), inner(found.elsewhere)};
    ASSERT_GT(sizeOf(inside.swept), 50);
    expectNoGhosts(*denoise::findDenoiser("svgf"), truth, inside);
}

}  // namespace
}  // namespace limpid::test

// Tests that the error falls as one over the number of samples. Slow.
#include <filesystem>

#include "scene/builtin/builtin.h"
#include "scene/load/load.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

class ConvergenceTest : public RenderTest {
  protected:
    /// Returns the mean relative squared error per pixel and channel, without the reference's noise: for a
    /// mean of n samples and one of m, each with variance v, the squared difference is v (1/n + 1/m).
    static double relativeError(const RenderedLayers& picture, const RenderedLayers& reference) {
        double sum = 0.0;
        for (size_t i = 0; i < picture.beauty.size(); ++i) {
            if (i % 4 == 3) continue;
            const double r = double{reference.beauty[i]}, d = double{picture.beauty[i]} - r;
            sum += d * d / (r * r + 0.01);
        }
        const auto n = static_cast<double>(picture.samples), m = static_cast<double>(reference.samples);
        return sum / static_cast<double>(picture.beauty.size() / 4 * 3) * m / (n + m);
    }

    /// Rare bright samples make one picture's error a matter of chance, so short renders are repeated with
    /// other seeds.
    static constexpr uint64_t samplesPerLevel = 512;

    void check(const scene::Scene& scene, uint32_t size, uint64_t referenceSamples) {
        Renderer renderer(device(), scene);
        RenderSettings settings;
        settings.extent = {size, size};
        const auto picture = [&](uint64_t samples, uint32_t seed) {
            settings.seed = seed;
            settings.samplesPerLaunch = static_cast<uint32_t>(std::min<uint64_t>(samples, 32));
            return renderer(settings, samples).layers;
        };
        const RenderedLayers reference = picture(referenceSamples, 4242);
        double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
        std::string table;
        for (uint64_t samples = 4; samples <= 1024; samples *= 4) {
            const auto runs = static_cast<uint32_t>(std::max<uint64_t>(1, samplesPerLevel / samples));
            double error = 0.0;
            for (uint32_t run = 0; run < runs; ++run) {
                error += relativeError(picture(samples, run), reference) / runs;
            }
            const double x = std::log(static_cast<double>(samples)), y = std::log(error);
            table += fmt::format(" {}: {:.4g}", samples, error);
            sx += x;
            sy += y;
            sxx += x * x;
            sxy += x * y;
            ++count;
        }
        const double slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
        fmt::print("{}: slope {:.3f}; relMSE by samples:{}\n", scene.name, slope, table);
        EXPECT_NEAR(slope, -1.0, 0.1) << scene.name << table;
    }
};

TEST_F(ConvergenceTest, CornellSpheres) {
    check(scene::cornellSpheresScene(), 48, 1024);
}

TEST_F(ConvergenceTest, CornellBoxFromAFile) {
    const std::filesystem::path folder =
        std::filesystem::path(LIMPID_SOURCE_DIR) / "../shared/scenes/cornell_box_glb";
    std::filesystem::path file;
    if (std::filesystem::is_directory(folder)) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
                file = entry.path();
        }
    }
    if (file.empty()) GTEST_SKIP() << "NOT TESTED: there is no scene in ../shared/scenes/cornell_box_glb";
    scene::Scene scene = scene::loadScene(file.string());
    scene::prepare(scene);
    scene.name = file.filename().string();
    check(scene, 48, 1024);
}

}  // namespace
}  // namespace limpid::test

// Compares the deviation that SVGF estimates with that of an ensemble of noisy sequences.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/denoise/denoise_fixture.h"
#include "tests/denoise/svgf_fixture.h"
#include "tests/oracle/svgf/double_svgf.h"

namespace limpid::test {
namespace {

/// Statistics of one signal's pixels over an ensemble of independent sequences.
struct Ensemble {
    explicit Ensemble(size_t pixels) : sum(pixels, 0.0), squares(sum), first(sum), last(sum) {}

    std::vector<double> sum, squares;  ///< of the samples' luminance
    std::vector<double> first, last;   ///< sums of sigma^2 of the first and of the last frame
};

class SvgfVarianceTest : public DenoiseTest {
  protected:
    static constexpr uint32_t columns = 64, rows = 36, seeds = 24;
    static constexpr int frames = 40;

    void addDeviations(const std::string& signal, std::vector<double>& sums) {
        const std::vector<dvec4> color = download(withVariance(graph_, signal));
        for (size_t p = 0; p < sums.size(); ++p) sums[p] += color[p].w * color[p].w;
    }

    /// Returns the mean over pixels with a hit of E[sigma^2] / (true variance), for both frames. Both are
    /// first divided by the squared mean, so that bright pixels count as much as dark ones.
    static dvec2 ratios(const HostFrame& frame, const Ensemble& e) {
        const double samples = double{seeds} * frames;
        double variance = 0.0;
        dvec2 estimates(0.0);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const double mean = e.sum[p] / samples, square = mean * mean;
            if (!DoubleFrame(frame).hit(p) || square == 0.0) continue;
            variance += (e.squares[p] / samples - square) / square;
            estimates += dvec2(e.first[p], e.last[p]) / double{seeds} / square;
        }
        return estimates / variance;
    }
};

TEST_F(SvgfVarianceTest, TheDeviationIsThatOfTheNoise) {
    const denoise::Denoiser* const method = denoise::findDenoiser("svgf");
    ASSERT_NE(method, nullptr);
    DenoiserSettings settings;
    settings.svgf.levels = 0;     // moments are never filtered
    settings.svgf.boost = false;  // it exceeds the samples' deviation, which this test measures
    const SyntheticScene scene({});
    const std::vector<Signal> signals = signalsOf(settings.svgf);
    std::vector<Ensemble> ensembles(signals.size(), Ensemble(size_t{columns} * rows));
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        graph_.beginFrame();
        graph_.resetHistories();
        for (int number = 0; number < frames; ++number) {
            const HostFrame frame = scene.frame(number, columns, rows, seed);
            denoise(*method, frame, settings);
            for (size_t s = 0; s < signals.size(); ++s) {
                Ensemble& e = ensembles[s];
                for (size_t p = 0; p < frame.pixelCount(); ++p) {
                    const double l =
                        luminance(svgfSample(frame, signals[s].signal, p, double{settings.svgf.minAlbedo}).x);
                    e.sum[p] += l;
                    e.squares[p] += l * l;
                }
                if (number == 0) addDeviations(signals[s].name, e.first);
                if (number == frames - 1) addDeviations(signals[s].name, e.last);
            }
        }
    }
    const HostFrame frame = scene.frame(0, columns, rows, 0);
    const double alpha = double{settings.svgf.alphaMoments};
    for (size_t s = 0; s < signals.size(); ++s) {
        const dvec2 ratio = ratios(frame, ensembles[s]);
        const double steady = ratio.y / (1.0 - alpha / (2.0 - alpha));
        RecordProperty(signals[s].name + "_young", std::to_string(ratio.x));
        RecordProperty(signals[s].name + "_steady", std::to_string(steady));
        EXPECT_NEAR(steady, 1.0, 0.2) << signals[s].name;
        EXPECT_GT(ratio.x, 0.5) << signals[s].name;
        EXPECT_LT(ratio.x, 2.0) << signals[s].name;
    }
}

}  // namespace
}  // namespace limpid::test

// Tests the points of --sampler sobol: the shaders have the bits of a C++ copy, and the copy has what is
// expected of them within a pixel, over the pixels of one sample, and between draws.
#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <set>

#include "passes/sobol_points.h"
#include "shaders/common/sampler.h"
#include "sobol_test.comp.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/reference/sobol_copy.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

using Point = std::array<float, 2>;

constexpr uint32_t draws = 8;

struct SobolSettings {
    uint32_t count, width, number, seed;
    uint32_t index = 0;    ///< of the sample in its launch
    uint32_t samples = 1;  ///< of the launch
};

struct SobolTestParams {
    SobolTable points;
    uint32_t count, width, stream, seed, index;
};

class SobolTest : public GpuTest {
  protected:
    std::vector<float> numbers(const SobolSettings& settings, uint32_t sampler) {
        const SobolSamples samples{settings.number - settings.index, settings.samples};
        const SobolTestParams params{
            sobolTable(static_cast<Sampler>(sampler), settings.seed, samples),
            settings.count,
            settings.width,
            settings.number,
            settings.seed,
            settings.index,
        };
        const Job job{.shader = shaders::sobol_test_comp,
                      .constants = {{"SAMPLER", sampler}},
                      .params = gpu::paramsOf(params),
                      .count = settings.count};
        return run<float>(job, size_t{settings.count} * draws * 2);
    }
};

TEST_F(SobolTest, HasTheBitsOfTheCopy) {
    for (const SobolSettings& settings :
         {SobolSettings{512, 64, 0, 0}, SobolSettings{512, 8, 1, 1}, SobolSettings{512, 300, 77, 123456789},
          SobolSettings{70'000, 69'999, 0xfffffffe, 5}}) {
        const std::vector<float> found = numbers(settings, SAMPLER_SOBOL);
        for (uint32_t i = 0; i < settings.count; ++i) {
            SobolCopy copy(i % settings.width, i / settings.width, settings.number, settings.seed);
            for (uint32_t n = 0; n < draws; ++n) {
                const Point expected = n % 2 == 0 ? copy.next2() : Point{copy.next(), 0.0f};
                for (size_t axis = 0; axis < 2; ++axis) {
                    ASSERT_EQ(std::bit_cast<uint32_t>(found[(size_t{i} * draws + n) * 2 + axis]),
                              std::bit_cast<uint32_t>(expected[axis]))
                        << "pixel " << i << " sample " << settings.number << " draw " << n;
                }
            }
        }
    }
}

/// A sample has the same points in every place of every launch.
TEST_F(SobolTest, LaunchesMakeNoDifference) {
    const std::vector<float> known = numbers({512, 64, 1000, 6}, SAMPLER_SOBOL);
    for (const uint32_t samples : {2u, maxSobolSamplesPerLaunch, SOBOL_POINTS / draws}) {
        for (const uint32_t index : {0u, 1u, samples - 1}) {
            EXPECT_EQ(numbers({512, 64, 1000, 6, index, samples}, SAMPLER_SOBOL), known)
                << "sample " << index << " of " << samples;
        }
    }
}

/// Draws that find no room in the table come from the stream.
TEST_F(SobolTest, FurtherDrawsAreIndependentNumbers) {
    const uint32_t samples = SOBOL_POINTS / 3;
    const std::vector<float> found = numbers({64, 8, 40, 6, 5, samples}, SAMPLER_SOBOL);
    for (uint32_t i = 0; i < 64; ++i) {
        SobolCopy copy(i % 8, i / 8, 40, 6);
        uint32_t state = startStream(i, 40, 6);
        for (uint32_t n = 0; n < draws; ++n) {
            Point expected{};
            if (n < 3) {
                expected = n % 2 == 0 ? copy.next2() : Point{copy.next(), 0.0f};
            } else {
                expected[0] = pcg(state);
                if (n % 2 == 0) expected[1] = pcg(state);
            }
            EXPECT_EQ(found[(size_t{i} * draws + n) * 2], expected[0]) << "pixel " << i << " draw " << n;
            EXPECT_EQ(found[(size_t{i} * draws + n) * 2 + 1], expected[1]) << "pixel " << i << " draw " << n;
        }
    }
}

TEST(SobolTable, HasRoomForDrawsByTheNumberOfSamples) {
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = 1}).draws, SOBOL_DRAWS);
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = maxSobolSamplesPerLaunch}).draws, SOBOL_DRAWS);
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = 1, .draws = 3}).draws, 3u);
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = 64}).draws, SOBOL_POINTS / 64);
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = SOBOL_POINTS}).draws, 1u);
    EXPECT_EQ(sobolTable(Sampler::Sobol, 1, {.count = UINT32_MAX}).draws, 0u);
    EXPECT_EQ(sobolTable(Sampler::Pcg, 1, {.count = 1}).draws, 0u);
}

/// The other generators give the numbers that they gave before there was a choice.
TEST_F(SobolTest, OtherSamplersDrawFromTheirStream) {
    for (const uint32_t sampler : {SAMPLER_PCG, SAMPLER_TEA}) {
        const std::vector<float> found = numbers({64, 8, 3, 9}, sampler);
        for (uint32_t i = 0; i < 64; ++i) {
            uint32_t state = startStream(i, 3, 9);
            for (uint32_t n = 0; n < draws; ++n) {
                for (uint32_t axis = 0; axis < 2 - n % 2; ++axis) {
                    const float expected = sampler == SAMPLER_TEA ? lcg(state) : pcg(state);
                    ASSERT_EQ(found[(size_t{i} * draws + n) * 2 + axis], expected)
                        << "stream " << i << " draw " << n;
                }
            }
        }
    }
}

/// Returns point `draw` (all draws having two dimensions) of a sample of a pixel.
Point pointOf(uint32_t x, uint32_t y, uint32_t number, uint32_t seed, uint32_t draw) {
    SobolCopy copy(x, y, number, seed);
    for (uint32_t i = 0; i < draw; ++i) copy.next2();
    return copy.next2();
}

/// True if each elementary interval in base 2 of area 1 / size has one of the points: a (0, m, 2)-net.
bool isNet(const std::vector<Point>& points) {
    const auto size = static_cast<uint32_t>(points.size());
    for (uint32_t columns = 1; columns <= size; columns *= 2) {
        const uint32_t rows = size / columns;
        std::set<std::pair<uint32_t, uint32_t>> cells;
        for (const Point& p : points) {
            cells.insert({static_cast<uint32_t>(p[0] * static_cast<float>(columns)),
                          static_cast<uint32_t>(p[1] * static_cast<float>(rows))});
        }
        if (cells.size() != size) return false;
    }
    return true;
}

TEST(Sobol, CopyHasKnownPoints) {
    // From Joe and Kuo's table.
    const std::array<double, 8> first{0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875},
        second{0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875};
    for (uint32_t i = 0; i < 8; ++i) {
        EXPECT_EQ(sobolPoint(i, 0) / 4294967296.0, first[i]) << i;
        EXPECT_EQ(sobolPoint(i, 1) / 4294967296.0, second[i]) << i;
    }
}

TEST(Sobol, SamplesOfAPixelAreANet) {
    for (uint32_t draw = 0; draw < 4; ++draw) {
        for (const uint32_t size : {2u, 4u, 16u, 64u, 256u}) {
            for (const uint32_t block : {0u, 3u}) {
                for (const uint32_t x : {0u, 13u}) {
                    std::vector<Point> points;
                    for (uint32_t i = 0; i < size; ++i)
                        points.push_back(pointOf(x, 7, block * size + i, 5, draw));
                    EXPECT_TRUE(isNet(points)) << size << " samples, block " << block << ", draw " << draw;
                }
            }
        }
    }
}

TEST(Sobol, OneSampleOfTheSquaresOfPixelsIsANet) {
    for (uint32_t draw = 0; draw < 12; ++draw) {
        for (const uint32_t side : {2u, 4u, 16u}) {
            std::vector<Point> points;
            for (uint32_t y = 0; y < side; ++y)
                for (uint32_t x = 0; x < side; ++x)
                    points.push_back(pointOf(3 * side + x, side + y, 21, 8, draw));
            EXPECT_TRUE(isNet(points)) << side << " pixels, draw " << draw;
        }
    }
}

/// A pixel's points depend on the seed and on the draw, and are no copy of its neighbour's in another order:
/// with 16 samples, those of the pixels of a square have different places within their cells.
TEST(Sobol, PixelsDrawsAndSeedsHavePointsOfTheirOwn) {
    std::set<Point> points;
    for (uint32_t pixel = 0; pixel < 16; ++pixel)
        for (uint32_t number = 0; number < 16; ++number)
            points.insert(pointOf(pixel % 4, pixel / 4, number, 0, 0));
    EXPECT_EQ(points.size(), 256u);
    std::vector<double> places(16, 0.0);  // of the second four bits
    for (const Point& p : points) ++places[static_cast<size_t>(p[0] * 256.0f) % 16];
    const ChiSquare even = chiSquare(places, std::vector<double>(16, 16.0));
    EXPECT_GT(even.p, 1e-4) << even.worst;
    EXPECT_NE(pointOf(1, 2, 3, 0, 0), pointOf(1, 2, 3, 1, 0));
    EXPECT_NE(pointOf(1, 2, 3, 0, 0), pointOf(1, 2, 3, 0, 1));
}

/// Over seeds, the numbers of a sample are uniform and, between draws, independent: without that, pictures
/// would be biased.
TEST(Sobol, IsEvenOverSeedsAndDrawsAreIndependent) {
    constexpr uint32_t seeds = 1 << 14;
    for (const uint32_t number : {0u, 5u}) {
        std::vector<double> single(64, 0.0), within(256, 0.0), between(256, 0.0), pixels(256, 0.0);
        for (uint32_t seed = 0; seed < seeds; ++seed) {
            SobolCopy copy(10, 20, number, seed), neighbour(500, 20, number, seed);
            const Point a = copy.next2(), b = copy.next2(), c = neighbour.next2();
            const auto place = [](float u, float v) {
                return static_cast<size_t>(u * 16.0f) * 16 + static_cast<size_t>(v * 16.0f);
            };
            ++single[static_cast<size_t>(a[0] * 64.0f)];
            ++within[place(a[0], a[1])];
            ++between[place(a[0], b[1])];
            ++pixels[place(a[0], c[0])];
        }
        for (const auto* bins : {&single, &within, &between, &pixels}) {
            const ChiSquare even = chiSquare(
                *bins, std::vector<double>(bins->size(), seeds / static_cast<double>(bins->size())));
            EXPECT_GT(even.p, 1e-4) << "sample " << number << ", " << even.worst;
        }
    }
}

/// Samples of one pixel: draws must be independent there, too. 1,024 samples of 16 pixels.
TEST(Sobol, DrawsOfAPixelAreIndependent) {
    std::vector<double> between(256, 0.0);
    for (uint32_t pixel = 0; pixel < 16; ++pixel) {
        for (uint32_t number = 0; number < 1024; ++number) {
            SobolCopy copy(pixel * 37, pixel, number, 3);
            const float first = copy.next2()[0], second = copy.next();
            ++between[static_cast<size_t>(first * 16.0f) * 16 + static_cast<size_t>(second * 16.0f)];
        }
    }
    const ChiSquare even = chiSquare(between, std::vector<double>(256, 16 * 1024 / 256.0));
    EXPECT_GT(even.p, 1e-4) << even.worst;
}

/// The largest difference between the share of points in a box from the origin and its area. Exact: the
/// supremum is at a box that touches points.
double starDiscrepancy(const std::vector<Point>& points) {
    std::vector<double> xs{1.0}, ys{1.0};
    for (const Point& p : points) {
        xs.push_back(double{p[0]});
        ys.push_back(double{p[1]});
    }
    double worst = 0.0;
    for (const double x : xs) {
        for (const double y : ys) {
            double open = 0.0, closed = 0.0;
            for (const Point& p : points) {
                open += double{p[0]} < x && double{p[1]} < y ? 1.0 : 0.0;
                closed += double{p[0]} <= x && double{p[1]} <= y ? 1.0 : 0.0;
            }
            const auto count = static_cast<double>(points.size());
            worst = std::max({worst, x * y - open / count, closed / count - x * y});
        }
    }
    return worst;
}

TEST(Sobol, DiscrepancyIsBelowHalfOfThatOfIndependentNumbers) {
    double sobol = 0.0, independent = 0.0;
    for (uint32_t seed = 0; seed < 8; ++seed) {
        std::vector<Point> spread, scattered;
        uint32_t state = startStream(seed, 0, 0);
        for (uint32_t i = 0; i < 64; ++i) {
            spread.push_back(pointOf(9, 4, i, seed, 1));
            const float x = pcg(state);
            scattered.push_back({x, pcg(state)});
        }
        sobol += starDiscrepancy(spread);
        independent += starDiscrepancy(scattered);
    }
    EXPECT_LT(sobol, independent * 0.5);
}

/// The error of a picture of side `side` after a Gaussian of 2 pixels, around the torus: root of the mean
/// square.
double blurredError(const std::vector<double>& error, int side) {
    const auto blurred = [side](const std::vector<double>& in, int stepX, int stepY) {
        std::vector<double> out(in.size(), 0.0);
        for (int y = 0; y < side; ++y) {
            for (int x = 0; x < side; ++x) {
                double sum = 0.0, weights = 0.0;
                for (int k = -8; k <= 8; ++k) {
                    const double weight = std::exp(-k * k / 8.0);
                    const int atX = (x + k * stepX + side) % side, atY = (y + k * stepY + side) % side;
                    sum += weight * in[static_cast<size_t>(atY * side + atX)];
                    weights += weight;
                }
                out[static_cast<size_t>(y * side + x)] = sum / weights;
            }
        }
        return out;
    };
    double sum = 0.0;
    for (const double e : blurred(blurred(error, 1, 0), 0, 1)) sum += e * e;
    return std::sqrt(sum / static_cast<double>(error.size()));
}

struct Integrand {
    const char* name;
    double mean;
    std::function<double(Point)> at;
};

const std::vector<Integrand>& integrands() {
    static const std::vector<Integrand> all{
        {"product", 0.25, [](Point p) { return double{p[0]} * double{p[1]}; }},
        {"edge", 0.5, [](Point p) { return p[0] + p[1] < 1.0f ? 1.0 : 0.0; }},
        {"wave", 0.0, [](Point p) {
             return std::sin(6.283185307 * double{p[0]}) + std::cos(6.283185307 * double{p[1]});
         }}};
    return all;
}

/// One sample of each pixel: the error has less energy at low frequencies than white noise, in each of
/// several samples. Mean over draws, since a single one varies by a sixth.
TEST(Sobol, ErrorOfOneSampleIsBlueNoise) {
    constexpr uint32_t side = 64;
    for (const Integrand& f : integrands()) {
        for (const uint32_t number : {0u, 1u, 6u, 1000u}) {
            double blurredBlue = 0.0, blurredWhite = 0.0;
            for (uint32_t draw = 0; draw < 8; ++draw) {
                std::vector<double> blue, white;
                uint32_t state = startStream(draw, number, 0);
                for (uint32_t i = 0; i < side * side; ++i) {
                    blue.push_back(f.at(pointOf(i % side, i / side, number, 0, draw)) - f.mean);
                    const float x = pcg(state);
                    white.push_back(f.at({x, pcg(state)}) - f.mean);
                }
                blurredBlue += blurredError(blue, side);
                blurredWhite += blurredError(white, side);
            }
            EXPECT_LT(blurredBlue, 0.65 * blurredWhite) << f.name << ", sample " << number;
        }
    }
}

/// The mean of 16 samples has less error in each pixel, and what is left has no blots that a filter would
/// keep.
TEST(Sobol, ErrorOfMoreSamplesIsSmallerWithoutPatterns) {
    constexpr uint32_t side = 32, samples = 16;
    for (const Integrand& f : integrands()) {
        std::vector<double> spread, independent;
        uint32_t state = startStream(1, 2, 3);
        for (uint32_t i = 0; i < side * side; ++i) {
            double sums[2] = {0.0, 0.0};
            for (uint32_t n = 0; n < samples; ++n) {
                sums[0] += f.at(pointOf(i % side, i / side, n, 4, 2)) - f.mean;
                const float x = pcg(state);
                sums[1] += f.at({x, pcg(state)}) - f.mean;
            }
            spread.push_back(sums[0] / samples);
            independent.push_back(sums[1] / samples);
        }
        double squares[2] = {0.0, 0.0};
        for (size_t i = 0; i < spread.size(); ++i) {
            squares[0] += spread[i] * spread[i];
            squares[1] += independent[i] * independent[i];
        }
        EXPECT_LT(squares[0], 0.5 * squares[1]) << f.name;
        EXPECT_LT(blurredError(spread, side), blurredError(independent, side)) << f.name;
    }
}

}  // namespace
}  // namespace limpid::test

// Tests the shaders' random numbers: the same bits as a C++ copy, and no obvious non-uniformity.
#include <bit>
#include <cmath>

#include "rng_test.comp.h"
#include "shaders/common/sampler.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/reference/rng_copy.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

constexpr uint32_t numbers = 64, streams = 4096;

struct Settings {
    uint32_t count, frame, seed;
};

class RngTest : public GpuTest {
  protected:
    std::vector<uint32_t> words(const Settings& settings, bool samplerTea) {
        const Job job{.shader = shaders::rng_test_comp,
                      .constants = {{"SAMPLER", samplerTea ? SAMPLER_TEA : SAMPLER_PCG}},
                      .params = gpu::paramsOf(settings),
                      .count = settings.count};
        return run<uint32_t>(job, size_t{settings.count} * (numbers + 2));
    }

    void expectSameBits(const Settings& settings, bool samplerTea) {
        const std::vector<uint32_t> all = words(settings, samplerTea);
        for (uint32_t i = 0; i < settings.count; ++i) {
            const uint32_t* stream = &all[size_t{i} * (numbers + 2)];
            uint32_t state = startStream(i, settings.frame, settings.seed);
            ASSERT_EQ(stream[0], tea(i, settings.frame)) << "stream " << i << " frame " << settings.frame;
            ASSERT_EQ(stream[1], state)
                << "stream " << i << " frame " << settings.frame << " seed " << settings.seed;
            for (uint32_t n = 0; n < numbers; ++n) {
                const float expected = samplerTea ? lcg(state) : pcg(state);
                ASSERT_EQ(stream[2 + n], std::bit_cast<uint32_t>(expected))
                    << "stream " << i << " number " << n;
            }
        }
    }

    /// Returns the numbers of all streams, one stream after the other.
    std::vector<float> values(const Settings& settings, bool samplerTea) {
        const std::vector<uint32_t> all = words(settings, samplerTea);
        std::vector<float> result;
        for (uint32_t i = 0; i < settings.count; ++i) {
            for (uint32_t n = 0; n < numbers; ++n) {
                result.push_back(std::bit_cast<float>(all[size_t{i} * (numbers + 2) + 2 + n]));
            }
        }
        return result;
    }
};

TEST_F(RngTest, HasTheBitsOfTheCopy) {
    for (const bool samplerTea : {false, true}) {
        for (const uint32_t frame : {0u, 1u, 77u, 0xfffffffeu}) {
            for (const uint32_t seed : {0u, 1u, 123456789u}) expectSameBits({256, frame, seed}, samplerTea);
        }
    }
}

TEST(Tea, CopyHasKnownValues) {
    // Computed with a separate program (Python integers).
    EXPECT_EQ(tea(0, 0), 0x741c187du);
    EXPECT_EQ(tea(1, 2), 0x0ca5550fu);
}

TEST_F(RngTest, IsEvenInOneAndTwoDimensions) {
    for (const bool samplerTea : {false, true}) {
        const std::vector<float> u = values({streams, 3, 5}, samplerTea);
        std::vector<double> single(64, 0.0), pairs(64 * 64, 0.0);
        for (size_t i = 0; i < u.size(); ++i) {
            ASSERT_GE(u[i], 0.0f);
            ASSERT_LT(u[i], 1.0f);
            ++single[static_cast<size_t>(u[i] * 64.0f)];
            if (i % 2 == 1) {
                ++pairs[static_cast<size_t>(u[i - 1] * 64.0f) * 64 + static_cast<size_t>(u[i] * 64.0f)];
            }
        }
        const auto count = static_cast<double>(u.size());
        const ChiSquare one = chiSquare(single, std::vector<double>(64, count / 64));
        const ChiSquare two = chiSquare(pairs, std::vector<double>(64 * 64, count / 2 / 4096));
        EXPECT_GT(one.p, 1e-4) << "sampler_tea " << samplerTea << ", " << one.worst;
        EXPECT_GT(two.p, 1e-4) << "sampler_tea " << samplerTea << ", " << two.worst;
    }
}

/// Neighbouring pixels and frames must be independent: the n-th numbers of all streams are uniform and
/// uncorrelated too.
TEST_F(RngTest, StreamsAreIndependent) {
    const std::vector<float> u = values({streams, 9, 0}, false);
    for (uint32_t n = 0; n < 8; ++n) {
        std::vector<double> bins(64, 0.0);
        double correlation = 0.0;
        for (uint32_t i = 0; i < streams; ++i) {
            ++bins[static_cast<size_t>(u[size_t{i} * numbers + n] * 64.0f)];
            if (i > 0)
                correlation += (u[size_t{i} * numbers + n] - 0.5) * (u[size_t{i - 1} * numbers + n] - 0.5);
        }
        const ChiSquare even = chiSquare(bins, std::vector<double>(64, streams / 64.0));
        EXPECT_GT(even.p, 1e-4) << "number " << n << ", " << even.worst;
        // Each product has variance 1/144.
        EXPECT_LT(std::abs(correlation * 12.0 / std::sqrt(static_cast<double>(streams))), 4.5)
            << "number " << n;
    }
}

}  // namespace
}  // namespace limpid::test

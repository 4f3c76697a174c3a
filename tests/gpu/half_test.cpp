// Tests how filters round to halves (shaders/common/filter_image.glsl).
#include <algorithm>
#include <cmath>
#include <random>

#include "half_test.comp.h"
#include "tests/gpu/gpu_fixture.h"

namespace limpid::test {
namespace {

struct Rounded {
    vec4 nearest, unpacked;
};

using HalfTest = GpuTest;

float nearestHalf(float value) {
    if (value == 0.0f) return value;
    const float unit = std::ldexp(1.0f, std::max(std::ilogb(value), -14) - 10);
    return std::nearbyint(value / unit) * unit;
}

/// Also below 2^-14, where halves are multiples of 2^-24, and halfway between two of them.
TEST_F(HalfTest, IsTheNearestOne) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-26.0f, 15.9f);
    std::vector<float> numbers{0.0f, 65504.0f, std::ldexp(1.0f, -14), std::ldexp(0.9999f, -14)};
    for (int i = 0; i < 64; ++i) numbers.push_back(std::ldexp(0.5f * static_cast<float>(i), -24));
    while (numbers.size() < 4000) numbers.push_back(std::exp2(exponent(random)));
    std::vector<vec4> values;
    for (size_t i = 0; i < numbers.size(); i += 2)
        values.emplace_back(numbers[i], -numbers[i], numbers[i + 1], -numbers[i + 1]);
    const auto count = static_cast<uint32_t>(values.size());
    const gpu::Buffer buffer = upload("values", values);
    const Job job{.shader = shaders::half_test_comp,
                  .buffers = {{"values", &buffer}},
                  .params = gpu::paramsOf(count),
                  .count = count};
    const std::vector<Rounded> results = run<Rounded>(job, count);
    for (size_t i = 0; i < count; ++i) {
        for (int c = 0; c < 4; ++c) {
            const float expected = nearestHalf(values[i][c]);
            ASSERT_EQ(results[i].nearest[c], expected) << values[i][c];
            ASSERT_EQ(results[i].unpacked[c], expected) << values[i][c];
        }
    }
}

}  // namespace
}  // namespace limpid::test

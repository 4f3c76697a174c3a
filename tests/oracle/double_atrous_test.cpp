// Tests the oracle of the a-trous filter with answers known independently.
#include "tests/oracle/double_atrous.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

std::vector<dvec4> randomLight(size_t count) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(0.0, 4.0);
    std::vector<dvec4> light;
    for (size_t i = 0; i < count; ++i)
        light.emplace_back(uniform(generator), uniform(generator), uniform(generator), 1.0);
    return light;
}

/// Applies one row or column of the B3 spline with holes, to neighbours `stride` pixels apart.
dvec3 splineAt(const std::vector<dvec4>& light, size_t p, size_t stride) {
    constexpr double weights[5] = {0.0625, 0.25, 0.375, 0.25, 0.0625};
    dvec3 sum(0.0);
    for (size_t j = 0; j < 5; ++j) sum += weights[j] * dvec3(light[p + j * stride - 2 * stride]);
    return sum;
}

TEST(DoubleAtrous, AConstantImageStaysConstant) {
    const HostFrame frame = SyntheticScene({}).frame(0, width, height, 1);
    const DoubleFrame pixels(frame);
    const DoubleAtrousParams params{.levels = 4, .sampleTarget = 0.0};
    Demodulated d = demodulate(frame, scatteredLight(frame), params);
    d.light.assign(frame.pixelCount(), dvec4(0.25, 1.0, 7.0, 1.0));
    const std::vector<dvec4> constant = d.light;
    for (uint32_t i = 0; i < params.levels; ++i) d.light = level(frame, d.light, d.geometry, i, params);
    for (size_t p = 0; p < frame.pixelCount(); ++p)
        ASSERT_LT(glm::distance(d.light[p], constant[p]), 1e-12) << p;
    const std::vector<dvec4> result = modulate(frame, d.light, params);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const dvec3 scattered =
            pixels.hit(p) ? dvec3(constant[p]) * glm::max(pixels.albedo(p), 0.1) : pixels.scattered(p);
        ASSERT_LT(glm::distance(dvec3(result[p]), scattered + pixels.emission(p)), 1e-9);
    }
}

TEST(DoubleAtrous, FlatGeometryGivesTheSplineConvolution) {
    const HostFrame frame = frontalPlane(width, height);
    const std::vector<dvec4> light = randomLight(frame.pixelCount());
    for (const bool plane : {false, true}) {
        const DoubleAtrousParams params{.sampleTarget = 0.0, .plane = plane};
        AtrousGeometry geometry = demodulate(frame, light, params).geometry;
        // On the plane, distances along `forward` are equal; with `plane` off, distances are from the eye.
        if (plane) geometry.distance.assign(frame.pixelCount(), 2.0);
        for (uint32_t i = 0; i < 3; ++i) {
            const size_t step = size_t{1} << i;
            const std::vector<dvec4> filtered = level(frame, light, geometry, i, params);
            std::vector<dvec4> rows = light;
            for (size_t p = 2 * step; p + 2 * step < light.size(); ++p)
                rows[p] = dvec4(splineAt(light, p, step), 1.0);
            const auto border = static_cast<int>(2 * step);
            for (size_t p = 0; p < light.size(); ++p) {
                if (!allAround(p, border, [](size_t) { return true; })) continue;
                ASSERT_LT(largest(dvec3(filtered[p]) - splineAt(rows, p, step * width)), 1e-12) << p;
            }
        }
    }
}

TEST(DoubleAtrous, APlaneAtAGrazingAngleIsOnePlane) {
    for (const bool orthographic : {false, true}) {
        const HostFrame frame =
            SyntheticScene({.orthographic = orthographic, .scale = 30.0}).frame(0, width, height, 1);
        const std::vector<dvec4> light = randomLight(frame.pixelCount());
        const AtrousGeometry geometry = demodulate(frame, light, {}).geometry;
        // A distance of 1e-4 from the plane, relative to that from the eye, makes a weight vanish.
        const std::vector<dvec4> filtered = level(
            frame, light, geometry, 0, {.normalFactor = 0.1, .depthFactor = 1e-10, .sampleTarget = 0.0});
        std::vector<dvec4> rows = light;
        for (size_t p = 2; p + 2 < light.size(); ++p) rows[p] = dvec4(splineAt(light, p, 1), 1.0);
        size_t compared = 0;
        for (size_t p = 0; p < light.size(); ++p) {
            if (!allAround(p, 2, [&](size_t q) { return isFloor(frame, q); })) continue;
            ++compared;
            ASSERT_LT(largest(dvec3(filtered[p]) - splineAt(rows, p, width)), 1e-3) << p;
        }
        EXPECT_GT(compared, 2000u);
    }
}

TEST(DoubleAtrous, WeightsByHand) {
    // Three pixels in a row, with the rays (-2/3, 0, -1), (0, 0, -1) and (2/3, 0, -1).
    const HostFrame frame = frontalPlane(3, 1);
    const std::vector<dvec4> light{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}};
    AtrousGeometry geometry{{{0, 0, 1}, {0, 0, 1}, {0.6, 0, 0.8}}, {2.0, 2.0, 2.5}};
    DoubleAtrousParams params{.normalFactor = 0.5, .depthFactor = 0.1, .sampleTarget = 0.0};
    // From the middle pixel: |n - n'|^2 = 0.36 + 0.04; the right point is (5/3, 0, -2.5), 0.5 off the plane.
    const double right = std::exp(-0.4 / 0.5) * std::exp(-0.25 * 0.25 / 0.1);
    dvec3 expected = dvec3(4, 6, 4 * right) / (10 + 4 * right);
    EXPECT_LT(largest(dvec3(level(frame, light, geometry, 0, params)[1]) - expected), 1e-6);
    // From the left pixel, two pixels apart; its distance is 2 |v|.
    const double z2 = 4.0 * (1.0 + 4.0 / 9.0);
    const double far = std::exp(-0.4 / (4 * 0.5)) * std::exp(-0.25 / z2 / 0.1);
    expected = dvec3(6, 0, 4 * far) / (6 + 4 * far);
    EXPECT_LT(largest(dvec3(level(frame, light, geometry, 1, params)[0]) - expected), 1e-6);
    params.sampleTarget = 8.0;  // the left pixel has one sample, at a step of two pixels: half as much again
    expected = dvec3(6 * 1.5, 0, 4 * far) / (6 * 1.5 + 4 * far);
    EXPECT_LT(largest(dvec3(level(frame, light, geometry, 1, params)[0]) - expected), 1e-6);
    params.sampleTarget = 0.0;
    params.plane = false;
    const double plain = std::exp(-0.4 / (4 * 0.5)) * std::exp(-0.25 / 0.1);
    expected = dvec3(6, 0, 4 * plain) / (6 + 4 * plain);
    EXPECT_LT(largest(dvec3(level(frame, light, geometry, 1, params)[0]) - expected), 1e-12);
    geometry.distance[2] = 0.0;  // the sky
    EXPECT_EQ(level(frame, light, geometry, 1, params)[0], light[0]);
    EXPECT_EQ(level(frame, light, geometry, 0, params)[2], light[2]);
}

TEST(DoubleAtrous, OctahedralNormals) {
    EXPECT_EQ(decodeOctahedral(0x00000000u), dvec3(0, 0, 1));
    EXPECT_EQ(decodeOctahedral(0x00007fffu), dvec3(1, 0, 0));
    EXPECT_EQ(decodeOctahedral(0x80010000u), dvec3(0, -1, 0));
    EXPECT_EQ(decodeOctahedral(0x80000000u), dvec3(0, -1, 0));  // -32768 is -1 as well
    EXPECT_EQ(decodeOctahedral(0x7fff7fffu), dvec3(0, 0, -1));
    const AtrousGeometry geometry = decodeGeometry({0x00007fffu, 0x40490000u, 0u, 0u});
    EXPECT_EQ(geometry.normal[0], dvec3(1, 0, 0));
    EXPECT_EQ(geometry.distance, (std::vector<double>{3.140625, 0.0}));
}

}  // namespace
}  // namespace limpid::test

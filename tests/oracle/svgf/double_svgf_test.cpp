// Tests properties of the oracle of SVGF that any correct implementation has.
#include "tests/oracle/svgf/double_svgf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/oracle/double_denoise_fixture.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;

constexpr SvgfSignal joint = SvgfSignal::Joint;

/// Processes the frames of one sequence, feeding the first level back.
class Sequence {
  public:
    explicit Sequence(const DoubleSvgfParams& params = {}, SvgfSignal signal = joint)
        : params_(params), signal_(signal) {}

    /// Runs the temporal steps without the filter.
    SvgfAccumulated accumulate(const HostFrame& frame) {
        SvgfAccumulated result = svgfAccumulate(frame, signal_, history, params_);
        tiles = svgfTiles(frame, result.moments, params_).tiles;
        svgfShorten(frame, signal_, tiles, params_, result);
        history = {frame.width,  frame.height,   svgfSurfaces(frame),
                   result.color, result.moments, {result.color.begin(), result.color.end()}};
        return result;
    }
    SvgfAccumulated next(const HostFrame& frame) {
        SvgfAccumulated result = accumulate(frame);
        const SvgfVariance young =
            svgfYoungVariance(frame, signal_, history.surfaces, result.color, result.moments, params_);
        history.color = svgfLevel(frame, signal_, history.surfaces, young.color, 0, params_);
        return result;
    }

    SvgfHistory history;
    std::vector<double> tiles;  ///< of the last frame

  private:
    DoubleSvgfParams params_;
    SvgfSignal signal_;
};

/// A plane in light of mean `mean`, uniform from 0 to twice that.
class NoisyPlane {
  public:
    explicit NoisyPlane(uint32_t columns = width, uint32_t rows = height)
        : plane_(frontalPlane(columns, rows)) {}

    HostFrame frame(double mean) {
        HostFrame frame = plane_;
        std::uniform_real_distribution<double> uniform(0.0, 2.0 * mean * 0.5);  // for an albedo of 0.5
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const auto light = static_cast<float>(uniform(generator_));
            for (size_t i = 0; i < 3; ++i) frame.diffuse[4 * p + i] = light;
        }
        return frame;
    }

  private:
    HostFrame plane_;
    std::mt19937 generator_{1};
};

TEST(DoubleSvgf, AConstantImageStaysConstant) {
    HostFrame frame = frontalPlane(width, height);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        for (size_t c = 0; c < 3; ++c) frame.diffuse[4 * p + c] = 0.25f * static_cast<float>(c + 1);
    }
    Sequence sequence;
    for (int number = 0; number < 7; ++number) {
        const SvgfAccumulated result = sequence.next(frame);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            ASSERT_LT(glm::distance(result.color[p], dvec4(0.5, 1.0, 1.5, 0.0)), 1e-6);
            ASSERT_LT(glm::distance(sequence.history.color[p], dvec4(0.5, 1.0, 1.5, 0.0)), 1e-6);
            ASSERT_EQ(result.moments[p].w, std::min(number + 1.0, 5.0));
        }
        for (const double lag : sequence.tiles) ASSERT_LT(lag, 1e-12);
    }
}

TEST(DoubleSvgf, TheSteadyShareIsThatOfTheNoise) {
    NoisyPlane plane(64, 48);
    for (const auto& [slow, fast] : {std::pair{0.2, 0.5}, {0.05, 0.4}, {0.3, 0.9}}) {
        const DoubleSvgfParams params{.alphaMoments = slow, .alphaFast = fast, .antilag = 0.0};
        Sequence sequence(params);
        double lag = 0.0, variance = 0.0;
        for (int number = 0; number < 120; ++number) {
            const SvgfAccumulated result = sequence.accumulate(plane.frame(1.0));
            if (number < 80 || number % 5 != 0) continue;
            for (const dvec4& m : result.moments) {
                lag += (m.z - m.x) * (m.z - m.x);
                variance += m.y - m.x * m.x;
            }
        }
        EXPECT_NEAR(lag / variance / svgfSteadyShare(params), 1.0, 0.03) << slow << ' ' << fast;
    }
}

TEST(DoubleSvgf, LagFollowsAbruptChangesOnly) {
    NoisyPlane plane;
    Sequence sequence;
    const auto meanLag = [&] {
        double sum = 0.0;
        for (const double lag : sequence.tiles) sum += lag;
        return sum / static_cast<double>(sequence.tiles.size());
    };
    for (int number = 0; number < 12; ++number) {
        sequence.next(plane.frame(1.0));
        EXPECT_LT(meanLag(), 0.005) << number;
    }
    double length = 0.0;
    for (const dvec4& m : sequence.next(plane.frame(3.0)).moments) length += m.w / (width * height);
    EXPECT_GT(meanLag(), 0.3);
    EXPECT_LT(length, 4.0) << "in the same frame";
    for (int number = 0; number < 12; ++number) sequence.next(plane.frame(3.0));
    EXPECT_LT(meanLag(), 0.005);
    sequence.next(plane.frame(0.0));
    EXPECT_GT(meanLag(), 0.3) << "of light that goes out too";
}

TEST(DoubleSvgf, YoungPixelsHaveTheVarianceOfTheirNoise) {
    NoisyPlane plane;
    const HostFrame frame = plane.frame(1.0);
    const SvgfSurfaces surfaces = svgfSurfaces(frame);
    const SvgfAccumulated first = svgfAccumulate(frame, joint, {}, {});
    const SvgfVariance young =
        svgfYoungVariance(frame, joint, surfaces, first.color, first.moments, {.boost = false});
    double sum = 0.0, count = 0.0;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        if (!allAround(p, 3, [](size_t) { return true; })) continue;
        sum += young.color[p].w * young.color[p].w;
        count += 1.0;
    }
    // Uniform from 0 to 2; the mean of the same 49 pixels is subtracted.
    EXPECT_NEAR(sum / count, (1.0 / 3.0) * 48.0 / 49.0, 0.01);
}

/// Returns the distance to the plane dot(n, X) = offset along a ray `pixels` away from p's centre.
double planeDistance(const HostFrame& frame, size_t p, const dvec3& n, double offset, const dvec2& pixels) {
    const CameraParams& camera = frame.camera;
    const dvec2 at =
        DoubleFrame(frame).screen(p) + 2.0 * pixels * dvec2(1.0 / frame.width, -1.0 / frame.height);
    const dvec3 across = at.x * dvec3(camera.right) + at.y * dvec3(camera.up), forward(camera.forward);
    if (camera.orthographic != 0) return (offset - glm::dot(n, across)) / glm::dot(n, forward);
    return offset / glm::dot(n, glm::normalize(forward + across));
}

TEST(DoubleSvgf, SlopesAreThoseOfPlanes) {
    for (const bool orthographic : {false, true}) {
        const HostFrame frame =
            SyntheticScene({.orthographic = orthographic, .scale = 3.0}).frame(0, width, height, 1);
        for (const dvec3& direction : {dvec3(0, 1, 0), dvec3(0.2, 0.3, 1), dvec3(-2, 1, 1.5)}) {
            const dvec3 n = glm::normalize(direction);
            for (size_t p = 0; p < frame.pixelCount(); p += 997) {
                const dvec3 v = orthographic ? dvec3(frame.camera.forward) : DoubleFrame(frame).ray(p);
                if (std::abs(glm::dot(n, v)) < 0.06 * glm::length(v)) continue;
                const double offset = 5.0 * glm::dot(n, glm::normalize(v)), h = 1e-4;
                const double z = planeDistance(frame, p, n, offset, dvec2(0.0));
                const dvec2 slope = svgfSlope(frame, p, n, z);
                for (int axis = 0; axis < 2; ++axis) {
                    dvec2 step(0.0);
                    step[axis] = h;
                    const double difference = (planeDistance(frame, p, n, offset, step) -
                                               planeDistance(frame, p, n, offset, -step)) /
                                              (2.0 * h);
                    ASSERT_NEAR(slope[axis], difference, 1e-5 * (1.0 + std::abs(difference))) << p;
                }
            }
        }
    }
}

TEST(DoubleSvgf, GrazingAnglesHaveTheSlopeOfTheLeastCosine) {
    HostFrame frame = frontalPlane(3, 3);  // the middle pixel looks along (0, 0, -1)
    for (const bool orthographic : {false, true}) {
        frame.camera.orthographic = orthographic;
        const double scale = (2.0 / 3.0) / 0.05 * (orthographic ? 1.0 : 4.0);
        EXPECT_NEAR(svgfSlope(frame, 4, {1, 0, 0}, 4.0).x, -scale, 1e-5 * scale) << "0 is positive";
        EXPECT_NEAR(svgfSlope(frame, 4, {0.9999, 0, 0.01}, 4.0).x, 0.9999 * scale, 1e-5 * scale);
        EXPECT_NEAR(svgfSlope(frame, 4, {0.9999, 0, -0.01}, 4.0).x, -0.9999 * scale, 1e-5 * scale);
    }
}

TEST(DoubleSvgf, APlaneAtAGrazingAngleIsFilteredAlongIt) {
    for (const bool orthographic : {false, true}) {
        const HostFrame frame =
            SyntheticScene({.orthographic = orthographic, .scale = 30.0}).frame(0, width, height, 1);
        std::vector<dvec4> color(frame.pixelCount(), dvec4(1, 1, 1, 1));
        const SvgfSurfaces surfaces = svgfSurfaces(frame);
        const std::vector<dvec4> filtered = svgfLevel(frame, joint, surfaces, color, 0, {});
        size_t compared = 0;
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            if (!allAround(p, 2, [&](size_t q) { return isFloor(frame, q); })) continue;
            ++compared;
            // The weight is exp(-1) where z differs as on the plane: the mean has at most 0.6 of the
            // deviation.
            ASSERT_LT(filtered[p].w, 0.6) << p;
            ASSERT_GT(filtered[p].w, 70.0 / 256.0 - 1e-9) << "the spline's, with no weight less than 1";
        }
        EXPECT_GT(compared, 2000u);
    }
}

TEST(DoubleSvgf, TheScaleOfTheSceneDoesNotMatter) {
    const SyntheticOptions moving{.cameraMoves = true, .objectMoves = true};
    SyntheticOptions large = moving;
    large.scale = 1024.0;
    Sequence a, b;
    for (int number = 0; number < 4; ++number) {
        const SvgfAccumulated is = a.next(SyntheticScene(moving).frame(number, width, height, 1));
        const SvgfAccumulated was = b.next(SyntheticScene(large).frame(number, width, height, 1));
        size_t differ = 0;
        for (size_t p = 0; p < is.color.size(); ++p)
            differ += glm::distance(is.color[p], was.color[p]) > 1e-3 * (1.0 + glm::length(is.color[p]));
        EXPECT_LT(differ, is.color.size() / 50) << number;
    }
}

/// Moves both motions by `error` pixels.
HostFrame displaced(HostFrame frame, float error) {
    for (auto* layer : {&frame.motion, &frame.reflectionMotion}) {
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            (*layer)[4 * p] += error * (*layer)[4 * p + 3];
            (*layer)[4 * p + 1] -= error * (*layer)[4 * p + 3];
        }
    }
    return frame;
}

/// The second parameter enables anti-lag.
class DoubleSvgfSignal : public testing::TestWithParam<std::tuple<SvgfSignal, bool>> {};

TEST_P(DoubleSvgfSignal, SlopeAndDoubtCoverErrorsOfPosition) {
    const SyntheticScene scene({.cameraMoves = true, .objectMoves = true});
    const auto [signal, shortens] = GetParam();
    const DoubleSvgfParams params{.antilag = 4.0};
    Sequence sequence(params, signal);
    for (int number = 0; number < 5; ++number) sequence.next(scene.frame(number, width, height, 1));
    const HostFrame frame = scene.frame(5, width, height, 1), off = displaced(frame, 2e-4f);
    SvgfAccumulated a = svgfAccumulate(frame, signal, sequence.history, params);
    SvgfAccumulated b = svgfAccumulate(off, signal, sequence.history, params);
    if (shortens) {
        const std::vector<double> tiles(size_t{width / 8} * ((height + 7) / 8), 0.6);
        svgfShorten(frame, signal, tiles, params, a);
        svgfShorten(off, signal, tiles, params, b);
    }
    size_t compared = 0, outside = 0;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const SvgfPixel& pixel = a.pixels[p];
        if (pixel.doubtful) continue;
        ++compared;
        ASSERT_EQ(pixel.failure, b.pixels[p].failure);
        ASSERT_EQ(pixel.reflected, b.pixels[p].reflected);
        const auto exceeds = [](const dvec4& x, const dvec4& y, const dvec4& slope) {
            return glm::any(glm::greaterThan(glm::abs(x - y), 1.1 * 2e-4 * slope + 1e-9));
        };
        outside += exceeds(dvec4(dvec3(a.color[p]), 0.0), dvec4(dvec3(b.color[p]), 0.0), pixel.colorSlope) ||
                   exceeds(a.moments[p], b.moments[p], pixel.momentsSlope) ||
                   exceeds(dvec4(a.stablePast[p], 0.0), dvec4(b.stablePast[p], 0.0),
                           dvec4(pixel.stablePastSlope, 0.0));
    }
    EXPECT_GT(compared, frame.pixelCount() * 9 / 10);
    // If s passes a pixel's centre, other taps are used, which the slope does not include.
    EXPECT_LT(outside, compared / 500);
}

INSTANTIATE_TEST_SUITE_P(Signals, DoubleSvgfSignal,
                         testing::Combine(testing::Values(joint, SvgfSignal::Specular), testing::Bool()));

/// Otherwise the comparison with the shaders would prove little.
TEST(DoubleSvgf, SyntheticFramesLeadToReflectionsAndBack) {
    for (const SyntheticOptions& options :
         {SyntheticOptions{}, SyntheticOptions{.cameraMoves = true, .objectMoves = true},
          SyntheticOptions{.cameraMoves = true, .orthographic = true, .scale = 1024.0}}) {
        const SyntheticScene scene(options);
        Sequence sequence({}, SvgfSignal::Specular);
        sequence.accumulate(scene.frame(0, width, height, 1));
        const HostFrame frame = scene.frame(1, width, height, 1);
        double hits = 0.0, reflected = 0.0, fellBack = 0.0, doubtful = 0.0;
        const SvgfAccumulated result = sequence.accumulate(frame);
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const SvgfPixel& pixel = result.pixels[p];
            hits += pixel.failure != 1;
            reflected += pixel.reflected;
            fellBack += isFloor(frame, p) && pixel.failure == 0 && !pixel.reflected;
            doubtful += pixel.doubtful;
        }
        EXPECT_GT(reflected, 0.2 * hits);
        EXPECT_GT(fellBack, 0.01 * hits);
        EXPECT_LT(doubtful, 0.001 * hits);
    }
}

}  // namespace
}  // namespace limpid::test

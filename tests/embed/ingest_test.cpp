// Tests the ingest pass: frames in all encodings are converted to the same internal layers.
#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "denoise/api/instance.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/embed/synthetic_camera.h"

namespace limpid::test {
namespace {

using testing::HasSubstr;

constexpr uint32_t width = 24, height = 16;
constexpr gpu::Extent extent{width, height};
constexpr float half = 0x1p-11f;  ///< relative error of rounding to half precision

/// Inputs in the default encoding, and the layers that the ingest pass must convert them to.
struct Given {
    HostFrame frame;  ///< the expected layers
    CameraParams before{};
    std::vector<float> normal, depth, motion;  ///< the inputs, four floats per pixel
};

class IngestTest : public DenoiseTest {
  protected:
    static Given still(bool orthographic = false) {
        const SyntheticScene scene({.cameraMoves = true, .noise = false, .orthographic = orthographic});
        Given given{.frame = scene.frame(3, width, height, 1)};
        given.before = scene.frame(2, width, height, 1).camera;
        given.normal = given.frame.normal;
        given.motion = given.frame.motion;
        given.depth.assign(4 * given.frame.pixelCount(), 0.0f);
        for (size_t p = 0; p < given.frame.pixelCount(); ++p)
            if (given.frame.depth[4 * p + 1] > 0.0f) given.depth[4 * p] = given.frame.depth[4 * p];
        return given;
    }

    struct Result {
        std::vector<float> normal, depth, motion;  ///< depth: two floats per pixel, the others four
    };

    Result run(const Given& given, const limpid_denoiser_desc& conventions, bool withMotion = true,
               const limpid_camera* camera = nullptr) {
        limpid_denoiser_desc desc = conventions;
        desc.width = width;
        desc.height = height;
        graph_.beginFrame();
        const auto image = [&](const char* name, const std::vector<float>& pixels) {
            return uploaded(name, pixels, extent);
        };
        denoise::IngestImages images;
        images.radiance = image("radiance", given.frame.diffuse);
        images.normal = image("normal", given.normal);
        images.depth = image("depth", given.depth);
        if (withMotion) images.motion = image("motion", given.motion);
        const limpid_camera matrices = camera ? *camera : matricesOf(given.frame.camera, given.before);
        const denoise::DenoiserInput input =
            denoise::ingest(graph_, images, denoise::ingestParams(desc, matrices, true), {.layers = true});
        graph_.execute(device());
        return {graph_.downloadFloat(device(), input.normal), graph_.downloadFloat(device(), input.depth),
                graph_.downloadFloat(device(), input.motion)};
    }

    /// `tolerance`: relative for distances, absolute for normals (in halves). Motion must match within 0.02
    /// pixels.
    void expectSame(const Result& result, const HostFrame& frame, float tolerance, bool motionToo = true) {
        for (size_t p = 0; p < frame.pixelCount(); ++p) {
            const bool seen = frame.depth[4 * p + 1] > 0.0f;
            ASSERT_EQ(result.depth[2 * p + 1], seen ? 1.0f : 0.0f) << "pixel " << p;
            if (!seen) continue;
            ASSERT_NEAR(result.depth[2 * p], frame.depth[4 * p], tolerance * frame.depth[4 * p])
                << "pixel " << p;
            for (size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(result.normal[4 * p + c], frame.normal[4 * p + c], tolerance + half)
                    << "pixel " << p;
            if (!motionToo || frame.motion[4 * p + 3] == 0.0f) continue;
            for (size_t c = 0; c < 2; ++c)
                ASSERT_NEAR(result.motion[4 * p + c], frame.motion[4 * p + c], 0.02f) << "pixel " << p;
            ASSERT_NEAR(result.motion[4 * p + 2], frame.motion[4 * p + 2],
                        5e-3f * frame.depth[4 * p] * std::max(tolerance * 1000.0f, 1.0f))
                << "pixel " << p;
        }
    }
};

std::string faultOf(const limpid_camera& camera) {
    limpid_denoiser_desc desc = {};
    desc.width = width;
    desc.height = height;
    try {
        denoise::ingestParams(desc, camera, true);
    } catch (const UsageError& fault) {
        return fault.what();
    }
    return "";
}

TEST(IngestParams, RefuseCamerasThatCannotBeUsed) {
    for (const bool orthographic : {false, true}) {
        CameraParams camera{
            .origin = {0, 2, 0}, .forward = {0, -1, 0}, .right = {1.5f, 0, 0}, .up = {0, 0, -1}};
        camera.orthographic = orthographic ? 1u : 0u;
        const limpid_camera good = matricesOf(camera, camera);
        EXPECT_EQ(faultOf(good), "");
        for (const float jitter : {0.6f, -0.6f, NAN}) {
            limpid_camera bad = good;
            bad.jitter[1] = jitter;
            EXPECT_THAT(faultOf(bad), HasSubstr("jitter")) << jitter;
        }
        limpid_camera bad = good;
        for (size_t column = 0; column < 3; ++column) bad.view[4 * column] *= 1.01f;
        EXPECT_THAT(faultOf(bad), HasSubstr("'view' is not rigid"));
        bad = good;
        bad.view[12] = NAN;
        EXPECT_THAT(faultOf(bad), HasSubstr("'view' is singular, or not finite"));
        bad = good;
        bad.previous_projection[2] = 0.1f;
        EXPECT_THAT(faultOf(bad), HasSubstr("'previous_projection' is oblique"));
        bad = good;
        bad.projection[8] = 0.2f;  // off-centre if it is perspective
        EXPECT_THAT(faultOf(bad), HasSubstr(orthographic ? "'projection' is oblique" : ""));
        EXPECT_EQ(faultOf(bad).empty(), !orthographic);
    }
}

/// Whether depth is reversed, and so where the camera looks, could not be told.
TEST(IngestParams, RefuseParallelViewsFromBehindTheEye) {
    const CameraParams camera{
        .origin = {0, 2, 0}, .forward = {0, -1, 0}, .right = {1.5f, 0, 0}, .up = {0, 0, -1}};
    limpid_camera given = matricesOf(camera, camera);
    for (const auto& [near, far] : {std::pair{0.0, 10.0}, {10.0, 0.0}, {5.0, 1000.0}}) {
        copyMatrix(glm::orthoRH_ZO(-1.0, 1.0, -1.0, 1.0, near, far), given.projection);
        EXPECT_EQ(faultOf(given), "") << near;
    }
    for (const auto& [near, far] : {std::pair{-10.0, 1000.0}, {-10.0, 10.0}, {-1000.0, 10.0}}) {
        copyMatrix(glm::orthoRH_ZO(-1.0, 1.0, -1.0, 1.0, near, far), given.projection);
        EXPECT_THAT(faultOf(given), HasSubstr("begins behind the eye")) << near;
    }
}

TEST_F(IngestTest, DistancesAndSignedNormals) {
    const Given given = still();
    limpid_denoiser_desc desc = {};
    desc.motion_depth = LIMPID_MOTION_DISTANCE;
    expectSame(run(given, desc), given.frame, 1e-6f);
}

TEST_F(IngestTest, MotionOfTheCameraFollowsFromItsMatrices) {
    for (const bool orthographic : {false, true}) {
        const Given given = still(orthographic);
        expectSame(run(given, {}, false), given.frame, 1e-5f);
        expectSame(run(given, {}, true), given.frame, 1e-5f);  // xy from the image, z from the matrices
    }
}

/// Rays through another point of each pixel see other points of a floor, which move as those in the centres
/// do.
TEST_F(IngestTest, MotionHasNoJitter) {
    CameraParams now{.origin = {0, 2, 0}, .forward = {0, -1, 0}, .right = {1.5f, 0, 0}, .up = {0, 0, -1}};
    Given given;
    given.frame.width = width;
    given.frame.height = height;
    given.frame.camera = given.before = now;
    given.frame.diffuse.assign(size_t{4} * width * height, 0.5f);
    given.normal = given.depth = given.frame.diffuse;
    limpid_camera camera = matricesOf(now, now);
    camera.jitter[0] = 0.375f;
    camera.jitter[1] = -0.25f;
    const auto distanceTo = [&](double x, double y) {
        const double sx = 2 * (x + 0.5) / width - 1, sy = 1 - 2 * (y + 0.5) / height;
        return 2.0 * std::sqrt(1.0 + 2.25 * sx * sx + sy * sy);
    };
    for (size_t p = 0; p < size_t{width} * height; ++p) {
        const auto x = static_cast<double>(p % width), y = static_cast<double>(p / width);
        given.normal[4 * p] = given.normal[4 * p + 2] = 0.0f;
        given.normal[4 * p + 1] = 1.0f;
        given.depth[4 * p] = static_cast<float>(distanceTo(x + 0.375, y - 0.25));
    }
    for (const float shift : {0.0f, 0.2f}) {
        const CameraParams before{
            .origin = {shift, 2, 0}, .forward = now.forward, .right = now.right, .up = now.up};
        copyMatrix(viewOf(before), camera.previous_view);
        const std::vector<float> motion = run(given, {}, false, &camera).motion;
        const double expected = -0.5 * shift / (2.0 * 1.5) * width;  // of a plane at a distance of 2
        for (size_t p = 0; p < size_t{width} * height; ++p) {
            ASSERT_NEAR(motion[4 * p], expected, 2e-3) << "pixel " << p;
            ASSERT_NEAR(motion[4 * p + 1], 0.0, 2e-3) << "pixel " << p;
        }
    }
}

/// Where nothing is hit, motion is that of a sky at infinity, which anti-aliasing follows.
TEST_F(IngestTest, TheSkyMovesAsTheCameraTurns) {
    Given given = still();
    std::fill(given.depth.begin(), given.depth.end(), 0.0f);
    given.before.forward = glm::normalize(given.before.forward + 0.1f * given.before.right);
    const glm::dmat4 toClip = projectionOf(given.before) * viewOf(given.before);
    const CameraParams& c = given.frame.camera;
    const std::vector<float> motion = run(given, {}, false).motion, asGiven = run(given, {}, true).motion;
    for (size_t p = 0; p < given.frame.pixelCount(); ++p) {
        const double px = static_cast<double>(p % width) + 0.5, py = static_cast<double>(p / width) + 0.5;
        const glm::dvec3 v = glm::dvec3(c.forward) + (2 * px / width - 1) * glm::dvec3(c.right) +
                             (1 - 2 * py / height) * glm::dvec3(c.up);
        const glm::dvec4 before = toClip * glm::dvec4(v, 0.0);
        ASSERT_NEAR(motion[4 * p], (0.5 * before.x / before.w + 0.5) * width - px, 0.02) << "pixel " << p;
        ASSERT_NEAR(motion[4 * p + 1], (0.5 * before.y / before.w + 0.5) * height - py, 0.02)
            << "pixel " << p;
        ASSERT_EQ(motion[4 * p + 2], 0.0f);
        ASSERT_EQ(motion[4 * p + 3], 1.0f);
        for (size_t i = 0; i < 2; ++i)
            ASSERT_NEAR(asGiven[4 * p + i], given.motion[4 * p + i],
                        half * std::abs(given.motion[4 * p + i]));
    }
}

TEST_F(IngestTest, LinearAndDeviceDepth) {
    for (const bool reversed : {false, true}) {
        for (const bool device : {false, true}) {
            Given given = still();
            limpid_camera camera = matricesOf(given.frame.camera, given.before);
            if (reversed)
                for (size_t column = 0; column < 4; ++column)
                    camera.projection[4 * column + 2] =
                        camera.projection[4 * column + 3] - camera.projection[4 * column + 2];
            const CameraParams& c = given.frame.camera;
            for (size_t p = 0; p < given.frame.pixelCount(); ++p) {
                const double x = (static_cast<double>(p % width) + 0.5) / width * 2 - 1;
                const double y = 1 - (static_cast<double>(p / width) + 0.5) / height * 2;
                const glm::dvec3 v = glm::dvec3(c.forward) + x * glm::dvec3(c.right) + y * glm::dvec3(c.up);
                const bool seen = given.depth[4 * p] > 0.0f;
                const double along = given.depth[4 * p] / glm::length(v);
                const float* m = camera.projection;
                const double ndc = (m[10] * -along + m[14]) / (m[11] * -along + m[15]);
                given.depth[4 * p] = static_cast<float>(!device    ? (seen ? -along : 0)
                                                        : seen     ? ndc
                                                        : reversed ? 0
                                                                   : 1);
            }
            limpid_denoiser_desc desc = {};
            desc.depth = device ? LIMPID_DEPTH_DEVICE : LIMPID_DEPTH_LINEAR;
            desc.motion_depth = LIMPID_MOTION_DISTANCE;
            // Depth buffers that are not reversed are imprecise for distant points.
            expectSame(run(given, desc, true, &camera), given.frame,
                       !device    ? 1e-5f
                       : reversed ? 1e-4f
                                  : 2e-2f);
        }
    }
}

TEST_F(IngestTest, NormalsInEveryEncoding) {
    const Given plain = still();
    const glm::dmat3 toView(viewOf(plain.frame.camera));
    for (const limpid_normal_encoding encoding :
         {LIMPID_NORMAL_SIGNED, LIMPID_NORMAL_UNORM, LIMPID_NORMAL_OCTAHEDRAL_SIGNED,
          LIMPID_NORMAL_OCTAHEDRAL_UNORM}) {
        for (const bool inView : {false, true}) {
            Given given = plain;
            for (size_t p = 0; p < given.frame.pixelCount(); ++p) {
                glm::dvec3 n(given.normal[4 * p], given.normal[4 * p + 1], given.normal[4 * p + 2]);
                if (inView) n = toView * n;
                if (encoding >= LIMPID_NORMAL_OCTAHEDRAL_SIGNED) {
                    const double sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
                    if (sum > 0) n /= sum;
                    const glm::dvec2 sign(n.x >= 0 ? 1 : -1, n.y >= 0 ? 1 : -1);
                    if (n.z < 0) n = {(1 - std::abs(n.y)) * sign.x, (1 - std::abs(n.x)) * sign.y, 0};
                }
                if (encoding == LIMPID_NORMAL_UNORM || encoding == LIMPID_NORMAL_OCTAHEDRAL_UNORM)
                    n = 0.5 * n + 0.5;
                for (int c = 0; c < 3; ++c)
                    given.normal[4 * p + static_cast<size_t>(c)] = static_cast<float>(n[c]);
            }
            limpid_denoiser_desc desc = {};
            desc.normal_encoding = encoding;
            desc.normal_space = inView ? LIMPID_SPACE_VIEW : LIMPID_SPACE_WORLD;
            expectSame(run(given, desc), given.frame, 1e-5f);
        }
    }
}

TEST_F(IngestTest, MotionInEveryUnitAndDirection) {
    const Given plain = still();
    for (const limpid_motion_unit unit : {LIMPID_MOTION_PIXELS, LIMPID_MOTION_UV, LIMPID_MOTION_NDC}) {
        for (const limpid_motion_direction direction :
             {LIMPID_MOTION_TO_PREVIOUS, LIMPID_MOTION_FROM_PREVIOUS}) {
            for (const bool yUp : {false, true}) {
                Given given = plain;
                const float sign = direction == LIMPID_MOTION_TO_PREVIOUS ? 1.0f : -1.0f;
                float x = sign, y = sign;
                if (unit == LIMPID_MOTION_UV) x /= width, y /= height;
                if (unit == LIMPID_MOTION_NDC) x *= 2.0f / width, y *= (yUp ? -2.0f : 2.0f) / height;
                for (size_t p = 0; p < given.frame.pixelCount(); ++p) {
                    given.motion[4 * p] *= x;
                    given.motion[4 * p + 1] *= y;
                    given.motion[4 * p + 2] *= sign;
                }
                limpid_camera camera = matricesOf(given.frame.camera, given.before);
                for (size_t column = 0; yUp && column < 4; ++column) {
                    camera.projection[4 * column + 1] *= -1;
                    camera.previous_projection[4 * column + 1] *= -1;
                }
                limpid_denoiser_desc desc = {};
                desc.motion_unit = unit;
                desc.motion_direction = direction;
                desc.motion_depth = LIMPID_MOTION_DISTANCE;
                desc.clip_y = yUp ? LIMPID_CLIP_Y_UP : LIMPID_CLIP_Y_DOWN;
                expectSame(run(given, desc, true, &camera), given.frame, 1e-5f);
            }
        }
    }
}

}  // namespace
}  // namespace limpid::test

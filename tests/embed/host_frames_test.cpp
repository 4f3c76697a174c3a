// Tests the C interface with frames in host memory: it gives the same picture as the internal denoisers, and
// refuses invalid arguments.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>

#include "denoise/api/denoiser.h"
#include "limpid/denoise.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/embed/synthetic_camera.h"

namespace limpid::test {
namespace {

using testing::HasSubstr;

constexpr uint32_t width = 48, height = 27;

class HostFramesTest : public DenoiseTest {
  protected:
    void SetUp() override {
        DenoiseTest::SetUp();
        if (IsSkipped() || device_) return;
        const std::string select = wantedDevice();
        limpid_device_desc desc = {sizeof desc};
        desc.select = select.c_str();
        ASSERT_EQ(limpid_device_create(&desc, &device_), LIMPID_OK) << limpid_last_error();
    }
    void TearDown() override {
        limpid_denoiser_destroy(denoiser_);
        DenoiseTest::TearDown();
    }
    static void TearDownTestSuite() { limpid_device_destroy(std::exchange(device_, nullptr)); }

    void create(limpid_method method, uint32_t signals = 2,
                limpid_motion_depth motionDepth = LIMPID_MOTION_DISTANCE, uint32_t samples = 0) {
        limpid_denoiser_desc desc = {sizeof desc};
        desc.method = method;
        desc.width = width;
        desc.height = height;
        desc.signals = signals;
        desc.motion_depth = motionDepth;
        desc.samples = samples;
        ASSERT_EQ(limpid_denoiser_create(device_, &desc, &denoiser_), LIMPID_OK) << limpid_last_error();
    }

    inline static limpid_device* device_ =
        nullptr;  ///< shared by all tests, so that each shader is compiled once
    limpid_denoiser* denoiser_ = nullptr;
};

limpid_host_image imageOf(const std::vector<float>& pixels) {
    return {pixels.data(), 3, 4 * sizeof(float), 0};
}

/// Describes a SyntheticScene's frame as the C interface takes it. `depths`, `ids` and `result` hold its
/// distances, ids and output, and must outlive it.
limpid_host_frame hostFrame(const HostFrame& frame, std::vector<float>& depths, std::vector<float>& ids,
                            std::vector<float>& result) {
    limpid_host_frame given = {sizeof given};
    given.inputs[LIMPID_INPUT_RADIANCE] = imageOf(frame.diffuse);
    given.inputs[LIMPID_INPUT_SPECULAR] = imageOf(frame.specular);
    given.inputs[LIMPID_INPUT_EMISSION] = imageOf(frame.emission);
    given.inputs[LIMPID_INPUT_ALBEDO] = imageOf(frame.albedo);
    given.inputs[LIMPID_INPUT_ALBEDO_SPECULAR] = imageOf(frame.albedoSpecular);
    given.inputs[LIMPID_INPUT_NORMAL] = imageOf(frame.normal);
    given.inputs[LIMPID_INPUT_MOTION] = imageOf(frame.motion);
    given.inputs[LIMPID_INPUT_PREVIOUS_NORMAL] = imageOf(frame.previousNormal);
    given.inputs[LIMPID_INPUT_ROUGHNESS] = {frame.roughness.data(), 1, 4 * sizeof(float), 0};
    depths.resize(frame.pixelCount());
    ids.resize(frame.pixelCount());
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        depths[p] = frame.depth[4 * p + 1] > 0.0f ? frame.depth[4 * p] / frame.depth[4 * p + 1] : 0.0f;
        ids[p] = static_cast<float>(frame.ids[2 * p] == UINT32_MAX ? 0 : frame.ids[2 * p]);
    }
    given.inputs[LIMPID_INPUT_DEPTH] = {depths.data(), 1, 0, 0};
    given.inputs[LIMPID_INPUT_ID] = {ids.data(), 1, 0, 0};
    result.assign(4 * frame.pixelCount(), -1.0f);
    given.outputs[LIMPID_OUTPUT_COLOR] = {result.data(), 4, 0, 0};
    given.camera = matricesOf(frame.camera, frame.camera);
    return given;
}

/// Returns a frame without reflection motion, which hostFrame() does not pass on.
HostFrame embeddable(const SyntheticScene& scene, int number) {
    HostFrame frame = scene.frame(number, width, height, 1);
    std::fill(frame.reflectionMotion.begin(), frame.reflectionMotion.end(), 0.0f);
    return frame;
}

double rmsDifference(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST_F(HostFramesTest, SvgfAndNetworksAreTheSameInsideAndOutside) {
    for (const auto& [method, name] : {std::pair{LIMPID_METHOD_SVGF, "svgf"},
                                       {LIMPID_METHOD_NANO, "nano"},
                                       {LIMPID_METHOD_FILM, "film"}}) {
        SCOPED_TRACE(name);
        create(method);
        const SyntheticScene scene({.objectMoves = true});
        std::vector<float> depths, ids, result, inside;
        graph_.resetHistories();
        for (int number = 0; number < 6; ++number) {
            const HostFrame frame = embeddable(scene, number);
            const limpid_host_frame given = hostFrame(frame, depths, ids, result);
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            filters_ = gpu::filterChoice(device()).backing;
            matrices_ = gpu::filterChoice(device()).matrices;
            inside = denoise(*denoise::findDenoiser(name), frame);
        }
        // Not equal bit for bit: cameras are converted to matrices and back, which rounds, and pixels without
        // a hit hold other values.
        EXPECT_LT(rmsDifference(result, inside), 2e-3);
        const std::vector<float> truth = scene.truth(5, width, height);
        EXPECT_LT(rmsDifference(result, truth), 0.5 * rmsDifference(embeddable(scene, 5).diffuse, truth));
        limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    }
}

/// Of jittered frames, edges are smoothed before they are averaged.
TEST_F(HostFramesTest, JitteredFramesAreTheSameInsideAndOutside) {
    const SyntheticScene scene({.objectMoves = true});
    DenoiserSettings settings;
    settings.taa.frames = 2.0f;
    std::vector<float> depths, ids, result, withEdges, inside;
    for (const int edges : {8, 0}) {
        SCOPED_TRACE(edges);
        create(LIMPID_METHOD_SVGF);
        ASSERT_EQ(limpid_denoiser_set(denoiser_, "taa.frames", 2.0), LIMPID_OK) << limpid_last_error();
        ASSERT_EQ(limpid_denoiser_set(denoiser_, "taa.edges", edges), LIMPID_OK) << limpid_last_error();
        settings.taa.edges = edges;
        graph_.resetHistories();
        for (int number = 0; number < 4; ++number) {
            HostFrame frame = embeddable(scene, number);
            frame.jitter = vec2(0.25f, number % 2 == 0 ? 0.125f : -0.25f);
            limpid_host_frame given = hostFrame(frame, depths, ids, result);
            given.camera.jitter[0] = frame.jitter->x;
            given.camera.jitter[1] = frame.jitter->y;
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            filters_ = gpu::filterChoice(device()).backing;
            inside = denoise(*denoise::findDenoiser("svgf"), frame, settings);
        }
        EXPECT_LT(rmsDifference(result, inside), 2e-3);
        if (edges > 0) withEdges = result;
        limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    }
    EXPECT_GT(rmsDifference(result, withEdges), 1e-3) << "the edges make no difference";
}

/// Light of 4 samples a pixel and the variances of its means, as the interface takes them.
struct SampledFrame {
    static constexpr uint32_t samples = 4;

    explicit SampledFrame(HostFrame of) : frame(std::move(of)) {
        addVariances(frame, samples);
        for (size_t i = 3; i < frame.diffuse.size(); i += 4) {
            radiance.push_back(frame.diffuse[i] / (samples - 1));
            specular.push_back(frame.specular[i] / (samples - 1));
        }
    }
    limpid_host_frame given() {
        limpid_host_frame result = hostFrame(frame, depths, ids, color);
        result.inputs[LIMPID_INPUT_RADIANCE_VARIANCE] = {radiance.data(), 1, 0, 0};
        result.inputs[LIMPID_INPUT_SPECULAR_VARIANCE] = {specular.data(), 1, 0, 0};
        return result;
    }

    HostFrame frame;
    std::vector<float> radiance, specular, depths, ids, color;
};

TEST_F(HostFramesTest, VariancesAreTheSameInsideAndOutside) {
    const SyntheticScene scene({.objectMoves = true});
    for (const uint32_t signals : {1u, 2u}) {
        SCOPED_TRACE(signals);
        create(LIMPID_METHOD_SVGF, signals, LIMPID_MOTION_DISTANCE, SampledFrame::samples);
        DenoiserSettings settings;
        settings.svgf.separate = signals == 2;
        graph_.resetHistories();
        for (int number = 0; number < 2; ++number) {
            SampledFrame sampled(embeddable(scene, number));
            limpid_host_frame given = sampled.given();
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            filters_ = gpu::filterChoice(device()).backing;
            const auto inside = denoise(*denoise::findDenoiser("svgf"), sampled.frame, settings);
            EXPECT_LT(rmsDifference(sampled.color, inside), 2e-3);
            if (number > 0) continue;
            const std::vector<float> known = sampled.color;
            given.reset = 1;
            given.inputs[LIMPID_INPUT_RADIANCE_VARIANCE] = given.inputs[LIMPID_INPUT_SPECULAR_VARIANCE] = {};
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            EXPECT_GT(rmsDifference(sampled.color, known), 1e-2) << "they matter";
            given = sampled.given();
            given.reset = 1;
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            EXPECT_EQ(sampled.color, known);
        }
        limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    }
}

TEST_F(HostFramesTest, VariancesThatAreNoNumbersCountAsNone) {
    create(LIMPID_METHOD_SVGF, 2, LIMPID_MOTION_DISTANCE, SampledFrame::samples);
    SampledFrame sampled(embeddable(SyntheticScene({}), 0));
    const float bad[] = {0.0f, -1.0f, NAN, INFINITY};
    std::vector<float> none;
    for (const float value : bad) {
        std::ranges::fill(sampled.radiance, value);
        std::ranges::fill(sampled.specular, value);
        limpid_host_frame given = sampled.given();
        given.reset = 1;
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
        if (none.empty()) none = sampled.color;
        EXPECT_EQ(sampled.color, none) << value;
    }
}

TEST_F(HostFramesTest, SaysWhatVariancesLack) {
    SampledFrame sampled(embeddable(SyntheticScene({}), 0));
    create(LIMPID_METHOD_SVGF);
    limpid_host_frame given = sampled.given();
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("samples of 2 or more, not 0"));
    limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    create(LIMPID_METHOD_SVGF, 2, LIMPID_MOTION_DISTANCE, SampledFrame::samples);
    given.inputs[LIMPID_INPUT_SPECULAR_VARIANCE] = {};
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("'specular_variance' is missing"));
    limpid_denoiser_desc desc = {sizeof desc};
    desc.width = desc.height = 8;
    desc.samples = 65537;
    limpid_denoiser* denoiser = nullptr;
    EXPECT_EQ(limpid_denoiser_create(device_, &desc, &denoiser), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("samples: at most 65536, not 65537"));
}

/// One float a pixel in and out, and no albedo.
TEST_F(HostFramesTest, AMaskIsTheSameInsideAndOutside) {
    create(LIMPID_METHOD_VISIBILITY, 1);
    const SyntheticScene scene({.objectMoves = true});
    std::vector<float> depths, ids, color, mask(size_t{width} * height), clean(mask.size()), inside;
    for (int number = 0; number < 6; ++number) {
        HostFrame frame = embeddable(scene, number);
        std::fill(frame.emission.begin(), frame.emission.end(), 0.0f);
        for (size_t p = 0; p < mask.size(); ++p)
            mask[p] = frame.diffuse[4 * p] = std::min(0.5f * frame.diffuse[4 * p], 1.0f);
        limpid_host_frame given = hostFrame(frame, depths, ids, color);
        for (const limpid_input unread : {LIMPID_INPUT_SPECULAR, LIMPID_INPUT_EMISSION, LIMPID_INPUT_ALBEDO,
                                          LIMPID_INPUT_ALBEDO_SPECULAR})
            given.inputs[unread] = {};
        given.inputs[LIMPID_INPUT_RADIANCE] = {mask.data(), 1, 0, 0};
        given.outputs[LIMPID_OUTPUT_COLOR] = {clean.data(), 1, 0, 0};
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
        filters_ = gpu::filterChoice(device()).backing;
        inside = denoise(*denoise::findDenoiser("visibility"), frame);
    }
    std::vector<float> grey;
    for (size_t p = 0; p < mask.size(); ++p) grey.push_back(inside[4 * p]);
    EXPECT_LT(rmsDifference(clean, grey), 2e-3);  // see above
    EXPECT_GT(rmsDifference(clean, mask), 0.05);
}

TEST_F(HostFramesTest, SignalsAddUpToThePicture) {
    const SyntheticScene scene({});
    const HostFrame frame = embeddable(scene, 0);
    for (const limpid_method method : {LIMPID_METHOD_SVGF, LIMPID_METHOD_NANO}) {
        for (const uint32_t signals : {1u, 2u}) {
            create(method, signals);
            std::vector<float> depths, ids, color, alone;
            std::vector<float> radiance(3 * width * height), specular(4 * width * height, 0.0f);
            limpid_host_frame given = hostFrame(frame, depths, ids, alone);
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            given = hostFrame(frame, depths, ids, color);
            given.reset = 1;
            given.outputs[LIMPID_OUTPUT_RADIANCE] = {radiance.data(), 3, 0, 0};
            if (signals == 2) given.outputs[LIMPID_OUTPUT_SPECULAR] = {specular.data(), 4, 0, 0};
            ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
            EXPECT_EQ(color, alone) << "the picture does not depend on what else is wanted";
            for (size_t p = 0; p < frame.pixelCount(); ++p)
                for (size_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(color[4 * p + c],
                                radiance[3 * p + c] + specular[4 * p + c] + frame.emission[4 * p + c],
                                1e-4f * (1.0f + color[4 * p + c]))
                        << method;
            if (signals == 1) {
                given.outputs[LIMPID_OUTPUT_SPECULAR] = {specular.data(), 4, 0, 0};
                EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
            }
            limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
        }
    }
}

TEST_F(HostFramesTest, AResetForgetsThePast) {
    create(LIMPID_METHOD_TEMPORAL);
    const SyntheticScene scene({});
    std::vector<float> depths, ids, first, later;
    const HostFrame frame = embeddable(scene, 0);
    limpid_host_frame given = hostFrame(frame, depths, ids, first);
    ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
    const HostFrame other = scene.frame(0, width, height, 2);
    given = hostFrame(other, depths, ids, later);
    ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK);
    given = hostFrame(frame, depths, ids, later);
    given.reset = 1;
    ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK);
    EXPECT_EQ(first, later);
}

TEST_F(HostFramesTest, EveryMethodRunsAndListsItsParameters) {
    for (const limpid_method method : {LIMPID_METHOD_SVGF, LIMPID_METHOD_ATROUS, LIMPID_METHOD_TEMPORAL,
                                       LIMPID_METHOD_VISIBILITY, LIMPID_METHOD_NANO}) {
        create(method, 1);
        limpid_parameter p;
        uint32_t count = 0;
        for (; limpid_method_parameter(method, count, &p) == LIMPID_OK; ++count) {
            double value = -1;
            EXPECT_EQ(limpid_denoiser_get(denoiser_, p.name, &value), LIMPID_OK) << p.name;
            EXPECT_NEAR(value, p.default_value, 1e-6 * std::abs(p.default_value)) << p.name;
            EXPECT_EQ(limpid_denoiser_set(denoiser_, p.name, p.default_value), LIMPID_OK)
                << limpid_last_error();
            EXPECT_EQ(limpid_denoiser_set(denoiser_, p.name, p.maximum * 2 + 1),
                      LIMPID_ERROR_INVALID_ARGUMENT);
            if (p.type != LIMPID_PARAMETER_FLOAT) {
                EXPECT_EQ(limpid_denoiser_set(denoiser_, p.name, p.minimum + 0.5),
                          LIMPID_ERROR_INVALID_ARGUMENT)
                    << p.name;
            }
            EXPECT_GT(std::strlen(p.help), 0u);
        }
        EXPECT_GT(count, 5u);
        const SyntheticScene scene({});
        std::vector<float> depths, ids, result;
        const HostFrame frame = embeddable(scene, 0);
        const limpid_host_frame given = hostFrame(frame, depths, ids, result);
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
        for (const float value : result) ASSERT_TRUE(std::isfinite(value));
        limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    }
}

TEST_F(HostFramesTest, SaysWhatIsMissing) {
    create(LIMPID_METHOD_SVGF);
    const SyntheticScene scene({});
    std::vector<float> depths, ids, result;
    const HostFrame frame = embeddable(scene, 0);
    limpid_host_frame given = hostFrame(frame, depths, ids, result);
    given.inputs[LIMPID_INPUT_SPECULAR].data = nullptr;
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("'specular' is missing"));
    given = hostFrame(frame, depths, ids, result);
    given.camera.projection[0] = NAN;
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("matrix of the camera"));
    given.size = 3;
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_denoise_host(nullptr, &given), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(limpid_denoise_host(denoiser_, nullptr), LIMPID_ERROR_INVALID_ARGUMENT);
    for (const auto& [input, few] : {std::pair{LIMPID_INPUT_ALBEDO, 1u},
                                     {LIMPID_INPUT_NORMAL, 2u},
                                     {LIMPID_INPUT_MOTION, 2u},
                                     {LIMPID_INPUT_DEPTH, 0u}}) {
        given = hostFrame(frame, depths, ids, result);
        given.inputs[input].components = few;
        EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT) << input;
        EXPECT_THAT(limpid_last_error(), HasSubstr("components"));
    }
    EXPECT_EQ(limpid_denoiser_set(denoiser_, "svgf.nothing", 1), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("svgf.nothing"));
    given = hostFrame(frame, depths, ids, result);
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
    given.outputs[LIMPID_OUTPUT_COLOR] = {};
    EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << "a frame for the history alone";
}

/// The camera approaches a mirror. Motion has no depth, and that of the surface is unknown: the history of
/// the specular light is only found if the mirror's distance in the previous frame is known.
TEST_F(HostFramesTest, ReflectionsAreFollowedWithoutDepthOfMotion) {
    create(LIMPID_METHOD_SVGF, 2, LIMPID_MOTION_2D);
    for (const auto& [name, value] : {std::pair{"svgf.antilag", 0.0}, {"svgf.levels", 0.0}})
        ASSERT_EQ(limpid_denoiser_set(denoiser_, name, value), LIMPID_OK) << limpid_last_error();
    constexpr size_t count = size_t{width} * height;
    const std::vector<float> radiance(3 * count, 0.5f), unknown(2 * count, NAN);
    std::vector<float> normals(3 * count, 0.0f), distances(count), moved(3 * count, NAN), clean(3 * count);
    for (size_t p = 0; p < count; ++p) {
        normals[3 * p + 2] = 1.0f;
        moved[3 * p] = 0.01f, moved[3 * p + 1] = 0.0f;
    }
    CameraParams before{};
    for (const float away : {2.0f, 1.6f}) {
        const CameraParams camera{
            .origin = {0, 0, away}, .forward = {0, 0, -1}, .right = {0.5f, 0, 0}, .up = {0, 0.3f, 0}};
        for (size_t p = 0; p < count; ++p) {
            const float x = (static_cast<float>(p % width) + 0.5f) / width - 0.5f;
            const float y = (static_cast<float>(p / width) + 0.5f) / height - 0.5f;
            distances[p] = away * std::sqrt(x * x + 0.36f * y * y + 1.0f);
        }
        const std::vector<float> specular(3 * count, away == 2.0f ? 1.0f : 0.0f);
        limpid_host_frame given = {sizeof given};
        given.inputs[LIMPID_INPUT_RADIANCE] = {radiance.data(), 3, 0, 0};
        given.inputs[LIMPID_INPUT_SPECULAR] = {specular.data(), 3, 0, 0};
        given.inputs[LIMPID_INPUT_NORMAL] = {normals.data(), 3, 0, 0};
        given.inputs[LIMPID_INPUT_DEPTH] = {distances.data(), 1, 0, 0};
        given.inputs[LIMPID_INPUT_MOTION] = {unknown.data(), 2, 0, 0};
        given.inputs[LIMPID_INPUT_REFLECTION_MOTION] = {moved.data(), 3, 0, 0};  // z is not read
        given.outputs[LIMPID_OUTPUT_SPECULAR] = {clean.data(), 3, 0, 0};
        given.camera = matricesOf(camera, away == 2.0f ? camera : before);
        before = camera;
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
    }
    EXPECT_GT(clean[3 * (height / 2 * width + width / 2)], 0.3f) << "half of the previous frame's light";
}

TEST_F(HostFramesTest, ARefusedOutputChangesNothing) {
    create(LIMPID_METHOD_TEMPORAL);
    const SyntheticScene scene({});
    std::vector<float> depths, ids, result, expected;
    for (const bool refuses : {false, true}) {
        const HostFrame first = embeddable(scene, 0), second = embeddable(scene, 1);
        limpid_host_frame given = hostFrame(first, depths, ids, result);
        given.reset = 1;
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
        given = hostFrame(second, depths, ids, result);
        if (refuses) {
            given.outputs[LIMPID_OUTPUT_COLOR].components = 2;
            EXPECT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_ERROR_INVALID_ARGUMENT);
            EXPECT_THAT(limpid_last_error(), HasSubstr("'color' has 2 components"));
            EXPECT_EQ(result, std::vector<float>(result.size(), -1.0f));
            given.outputs[LIMPID_OUTPUT_COLOR].components = 4;
        }
        ASSERT_EQ(limpid_denoise_host(denoiser_, &given), LIMPID_OK) << limpid_last_error();
        if (!refuses) expected = result;
    }
    EXPECT_EQ(result, expected);
}

TEST_F(HostFramesTest, RefusesImpossibleDescriptions) {
    limpid_denoiser_desc desc = {sizeof desc};
    EXPECT_EQ(limpid_denoiser_create(device_, &desc, &denoiser_), LIMPID_ERROR_INVALID_ARGUMENT);
    desc.width = desc.height = 8;
    desc.method = static_cast<limpid_method>(77);
    EXPECT_EQ(limpid_denoiser_create(device_, &desc, &denoiser_), LIMPID_ERROR_INVALID_ARGUMENT);
    desc.method = LIMPID_METHOD_SVGF;
    for (const float farDepth : {-1.0f, NAN}) {
        desc.far_depth = farDepth;
        EXPECT_EQ(limpid_denoiser_create(device_, &desc, &denoiser_), LIMPID_ERROR_INVALID_ARGUMENT);
        EXPECT_THAT(limpid_last_error(), HasSubstr("far_depth"));
    }
    desc.far_depth = 0.0f;
    desc.method = LIMPID_METHOD_VISIBILITY;
    desc.signals = 2;
    EXPECT_EQ(limpid_denoiser_create(device_, &desc, &denoiser_), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(denoiser_, nullptr);
    limpid_device_desc none = {sizeof none};
    none.select = "no such device";
    limpid_device* device = nullptr;
    EXPECT_EQ(limpid_device_create(&none, &device), LIMPID_ERROR_UNSUPPORTED);
    EXPECT_THAT(limpid_last_error(), HasSubstr("no such device"));
}

/// A struct of a later version is longer. It is accepted if the unknown members are 0.
TEST_F(HostFramesTest, StructsMayGrow) {
    struct Later {
        limpid_denoiser_desc desc;
        uint64_t more;
    } later = {};
    later.desc.size = sizeof later;
    later.desc.width = later.desc.height = 8;
    ASSERT_EQ(limpid_denoiser_create(device_, &later.desc, &denoiser_), LIMPID_OK) << limpid_last_error();
    limpid_denoiser_destroy(std::exchange(denoiser_, nullptr));
    later.more = 1;
    EXPECT_EQ(limpid_denoiser_create(device_, &later.desc, &denoiser_), LIMPID_ERROR_INVALID_ARGUMENT);
    EXPECT_THAT(limpid_last_error(), HasSubstr("later version"));
}

TEST_F(HostFramesTest, MemoryIsKnownBeforehand) {
    limpid_denoiser_desc desc = {sizeof desc};
    desc.width = 640;
    desc.height = 360;
    uint64_t one = 0, two = 0;
    ASSERT_EQ(limpid_denoiser_memory(&desc, 1, &one), LIMPID_OK);
    desc.signals = 2;
    ASSERT_EQ(limpid_denoiser_memory(&desc, 1, &two), LIMPID_OK);
    // docs/embedding.md, "Memory"
    const uint64_t pixels = uint64_t{640} * 360, tiles = uint64_t{80} * 45, largeTiles = uint64_t{40} * 23;
    constexpr uint64_t standIn = 8;       // one pixel of motion that nothing reads
    constexpr uint64_t noSecond = 8 + 4;  // one pixel of light and of stable light that nothing writes
    EXPECT_EQ(one, pixels * 56 + tiles * 20 + largeTiles * 4 + standIn + noSecond);
    EXPECT_EQ(two, pixels * 112 + tiles * 40 + largeTiles * 8 + standIn);
    uint64_t sampled = 0;
    desc.samples = 2;
    ASSERT_EQ(limpid_denoiser_memory(&desc, 1, &sampled), LIMPID_OK);
    EXPECT_EQ(sampled, two + pixels * 2 * 16);
    desc.samples = 0;
    uint64_t nano = 0;
    desc.method = LIMPID_METHOD_NANO;
    ASSERT_EQ(limpid_denoiser_memory(&desc, 1, &nano), LIMPID_OK);
    EXPECT_GT(nano, two);
    uint64_t film = 0;
    desc.method = LIMPID_METHOD_FILM;
    ASSERT_EQ(limpid_denoiser_memory(&desc, 1, &film), LIMPID_OK);
    EXPECT_GT(film, nano);
}

}  // namespace
}  // namespace limpid::test

// Tests that the library in a Vulkan program gives the same pictures, bit for bit, as `limpid denoise` for
// the same frames, which `limpid render` has written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "denoise/api/camera_matrices.h"
#include "image/io/exr/exr.h"
#include "renderer/frame/camera_text.h"
#include "tests/cli/cli_fixture.h"
#include "tests/embed/vulkan_program.h"

namespace limpid::test {
namespace {

using image::LayeredImage;

constexpr int frameCount = 4;
constexpr gpu::Extent extent{64, 36};

struct Difference {
    size_t values = 0;  ///< number of values that differ
    float largest = 0;
    double mean = 0.0;
};

CameraParams cameraOf(const LayeredImage& file) {
    return parseCameraText(file.metadata.at(cameraAttribute)).value();
}

/// Converts a camera to the interface's matrices and back, as the library does. The result differs by
/// rounding.
CameraParams roundedCamera(const CameraParams& camera) {
    const limpid_camera matrices = matricesOf(camera, camera);
    return denoise::cameraFromMatrices(matrices.view, matrices.projection, false, extent.height).params;
}

/// A denoiser's settings, as options of the program and as values of the library.
struct Variant {
    std::string options;
    limpid_method method = LIMPID_METHOD_SVGF;
    uint32_t signals = 1;
    std::map<const char*, double> parameters;
};
using Pictures = std::vector<std::vector<float>>;

const std::set<std::string_view> guides{"normal", "prevNormal", "motion", "reflectionMotion"};

/// Larger values, which mark missing motion, stay what they are.
float nearestHalf(float value) {
    if (value == 0.0f || std::abs(value) > 65504.0f) return value;
    const float unit = std::ldexp(1.0f, std::max(std::ilogb(value), -14) - 10);
    return std::nearbyint(value / unit) * unit;
}

class EmbedFilesTest : public ProgramTest<VulkanProgramTest> {
  protected:
    std::string name(const char* kind, int frame) const {
        return path(kind + std::to_string(frame) + ".exr");
    }
    std::string pattern(const char* kind) const { return path(kind + std::string("%d.exr")); }

    void runs(const std::string& arguments) {
        const Result result = ProgramTest::run(arguments + " --device " + wantedDevice());
        ASSERT_EQ(result.code, 0) << arguments << "\n" << result.output;
    }

    /// Renders frames in which objects and the camera move.
    void SetUp() override {
        ProgramTest::SetUp();
        if (IsSkipped()) return;
        runs("render builtin:cornell-moving -o " + pattern("noisy") +
             " --width 64 --height 36 --spp 1 --jitter off " +
             "--float --aov all --camera-path shake --frames " + std::to_string(frameCount));
        for (int frame = 0; frame < frameCount; ++frame)
            cameras_.push_back(cameraOf(image::readExr(name("noisy", frame))));
    }

    /// Rounds the guides in each file to halves, in which the library keeps them.
    void roundGuides() {
        for (int frame = 0; frame < frameCount; ++frame) {
            LayeredImage file = image::readExr(name("noisy", frame));
            for (image::Channel& channel : file.channels) {
                const std::string_view layer(channel.name.data(), channel.name.find('.'));
                if (!guides.contains(layer)) continue;
                for (float& value : channel.values) value = nearestHalf(value);
            }
            image::writeExr(name("noisy", frame), file);
        }
    }

    /// Replaces the camera in each file by roundedCamera(). Returns the number of cameras that changed.
    int roundCameras() {
        int changed = 0;
        for (int frame = 0; frame < frameCount; ++frame) {
            LayeredImage file = image::readExr(name("noisy", frame));
            std::string& text = file.metadata.at(cameraAttribute);
            const std::string rounded = cameraText(roundedCamera(cameraOf(file)));
            changed += std::exchange(text, rounded) != rounded;
            image::writeExr(name("noisy", frame), file);
        }
        return changed;
    }

    Pictures byProgram(const std::string& options) {
        runs("denoise " + pattern("noisy") + " -o " + pattern("clean") + " " + options);
        Pictures pictures;
        for (int frame = 0; frame < frameCount; ++frame)
            pictures.push_back(image::readExr(name("clean", frame)).get("", "RGBA").pixels);
        return pictures;
    }

    /// Uploads a file's layers as images with four floats per pixel (few devices support images with three).
    std::unique_ptr<ProgramFrame> uploadFile(const LayeredImage& file) {
        std::map<limpid_input, std::vector<float>> layers;
        const auto add = [&](limpid_input input, const char* layer, const char* suffixes) {
            const image::Image picture = file.get(layer, suffixes);
            std::vector<float>& texels = layers[input];
            texels.assign(4 * picture.pixels.size() / picture.components, 0.0f);
            for (size_t i = 0; i < picture.pixels.size(); ++i)
                texels[4 * (i / picture.components) + i % picture.components] = picture.pixels[i];
        };
        add(LIMPID_INPUT_RADIANCE, "diffuse", "RGB");
        add(LIMPID_INPUT_SPECULAR, "specular", "RGB");
        add(LIMPID_INPUT_EMISSION, "emission", "RGB");
        add(LIMPID_INPUT_ALBEDO, "albedo", "RGB");
        add(LIMPID_INPUT_ALBEDO_SPECULAR, "albedoSpecular", "RGB");
        add(LIMPID_INPUT_NORMAL, "normal", "XYZ");
        add(LIMPID_INPUT_PREVIOUS_NORMAL, "prevNormal", "XYZ");
        add(LIMPID_INPUT_DEPTH, "depth", "Z");
        add(LIMPID_INPUT_MOTION, "motion", "XYZ");
        add(LIMPID_INPUT_REFLECTION_MOTION, "reflectionMotion", "XYZ");
        // Files have 1e10 where there is no reflection motion; the library's interface has 0.
        for (float& value : layers[LIMPID_INPUT_REFLECTION_MOTION])
            if (value > 1e9f) value = 0.0f;
        const std::vector<float> numbers = file.get("id", "I").pixels;
        const std::vector<uint32_t> ids(numbers.begin(), numbers.end());
        Pixels inputs;
        for (const auto& [input, texels] : layers)
            inputs[input] = {gpu::Format::RGBA32Float, gpu::bytesOf(texels)};
        inputs[LIMPID_INPUT_ID] = {gpu::Format::R32Uint, gpu::bytesOf(ids)};
        return upload(inputs, extent);
    }

    Pictures byLibrary(const Variant& variant) {
        limpid_denoiser_desc desc = {};
        desc.width = extent.width, desc.height = extent.height;
        desc.method = variant.method;
        desc.signals = variant.signals;
        limpid_denoiser* denoiser = create(desc);
        for (const auto& [parameter, value] : variant.parameters)
            EXPECT_EQ(limpid_denoiser_set(denoiser, parameter, value), LIMPID_OK) << limpid_last_error();
        Pictures pictures;
        for (int number = 0; number < frameCount; ++number) {
            const auto f = uploadFile(image::readExr(name("noisy", number)));
            f->frame.camera = matricesOf(cameras_[number], cameras_[std::max(number - 1, 0)]);
            VulkanProgramTest::run([&](VkCommandBuffer commands) {
                EXPECT_EQ(limpid_record(denoiser, commands, &f->frame), LIMPID_OK) << limpid_last_error();
            });
            pictures.push_back(pixels(*f));
        }
        return pictures;
    }

    Difference differenceOf(const Variant& variant) {
        const Pictures ours = byLibrary(variant), theirs = byProgram(variant.options);
        Difference result;
        for (size_t frame = 0; frame < theirs.size(); ++frame) {
            EXPECT_EQ(ours[frame].size(), theirs[frame].size());
            for (size_t i = 0; i < theirs[frame].size(); ++i) {
                if (ours[frame][i] == theirs[frame][i]) continue;
                ++result.values;
                const float difference = std::abs(ours[frame][i] - theirs[frame][i]);
                result.largest = std::max(result.largest, difference);
                result.mean += double{difference};
            }
        }
        result.mean /= double{frameCount} * 4.0 * extent.width * extent.height;
        return result;
    }

    std::vector<CameraParams> cameras_;  ///< the cameras of the rendered frames
};

const Variant oneSignal{"--denoiser svgf --set svgf.separate=off", LIMPID_METHOD_SVGF, 1, {}},
    twoSignals{"--denoiser svgf", LIMPID_METHOD_SVGF, 2, {}},
    otherParameters{"--denoiser svgf --set svgf.alpha=0.3 --set taa.frames=8",
                    LIMPID_METHOD_SVGF,
                    2,
                    {{"svgf.alpha", 0.3}, {"taa.frames", 8}}},
    atrous{"--denoiser atrous", LIMPID_METHOD_ATROUS, 1, {}},
    temporal{"--denoiser temporal", LIMPID_METHOD_TEMPORAL, 1, {}},
    bilateral{"--denoiser bilateral", LIMPID_METHOD_BILATERAL, 1, {}},
    nano{"--denoiser nano", LIMPID_METHOD_NANO, 2, {}},
    nanoOfOne{"--denoiser nano --set svgf.separate=off --set nano.strength=0.5",
              LIMPID_METHOD_NANO,
              1,
              {{"nano.strength", 0.5}}},
    film{"--denoiser film", LIMPID_METHOD_FILM, 2, {}};

TEST_F(EmbedFilesTest, GivesThePicturesOfTheProgramBitForBit) {
    roundCameras();
    roundGuides();
    // Not bilateral: it reads normals that have been packed once more.
    for (const Variant& variant :
         {oneSignal, twoSignals, otherParameters, atrous, temporal, nano, nanoOfOne, film}) {
        const Difference difference = differenceOf(variant);
        // The program multiplies matrices where the device can, and on CPUs uses oneDNN; the library does
        // neither on a device of the caller's.
        const bool network = variant.method == LIMPID_METHOD_NANO || variant.method == LIMPID_METHOD_FILM;
        const bool otherSums = network && (device().info().cooperativeMatrices || device().isCpu());
        if (otherSums)
            EXPECT_LT(difference.largest, device().isCpu() ? 0.01 : 0.05) << variant.options;
        else
            EXPECT_EQ(difference.values, 0u) << variant.options << ": at most " << difference.largest;
    }
}

TEST_F(EmbedFilesTest, GuidesInHalvesChangeLittle) {
    roundCameras();
    for (const Variant& variant : {oneSignal, twoSignals})
        EXPECT_EQ(differenceOf(variant).values, 0u) << variant.options << " reads them as they are given";
    for (const Variant& variant : {atrous, bilateral}) {
        const Difference difference = differenceOf(variant);
        fmt::print("guides in halves, {}: mean {:.2g}, at most {:.2g}\n", variant.options, difference.mean,
                   difference.largest);
        EXPECT_GT(difference.values, 0u) << "proves nothing";
        EXPECT_LT(difference.mean, 1e-4) << variant.options;
        EXPECT_LT(difference.largest, 0.02f) << variant.options;
    }
}

/// Files hold the renderer's exact camera; float matrices round it. Then a pixel whose history is barely
/// accepted may be rejected, and vice versa. This bounds the resulting difference.
TEST_F(EmbedFilesTest, MatricesLoseTheLastBitsOfACamera) {
    roundGuides();
    const Difference difference = differenceOf(twoSignals);
    constexpr size_t all = size_t{4} * frameCount * extent.width * extent.height;
    RecordProperty("values", static_cast<int>(difference.values));
    RecordProperty("largest", std::to_string(difference.largest));
    EXPECT_LT(difference.values, all / 100) << difference.largest;
    EXPECT_LT(difference.largest, 0.02f);
    EXPECT_GT(roundCameras(), 0) << "the camera of this path is exact: the test needs another one";
}

}  // namespace
}  // namespace limpid::test

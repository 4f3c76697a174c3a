// The methods `nano` and `film`: their light against the version in double precision, which is given what the
// device stored of SVGF's stages in the same frame, and what their users rely on.
#include "denoise/methods/nano/nano.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "base/divide_up.h"
#include "base/half.h"
#include "denoise/methods/film/film_network.h"
#include "denoise/methods/nano/nano_network.h"
#include "denoise/nano_host/network_host.h"
#include "denoise/stages/ingest/ingest.h"
#include "tests/denoise/denoise_fixture.h"
#include "tests/denoise/svgf_fixture.h"
#include "tests/oracle/double_nano.h"

namespace limpid::test {
namespace {

using denoise::SvgfSettings;

/// Light is rounded to halves at each level and in the result, by at most 5e-4 each time. Two of these
/// roundings explain what is left of errors here.
constexpr double lightRounding = 1e-3, minHalf = 1e-6;
/// Channels are rounded to halves in each of 20 layers. In what is compared here, that moves the light as far
/// as an error of 0.0017 in all logits would (NanoLight::spread). Other weights may need more.
constexpr double logitError = 5e-3;
/// Of whole pictures, relative to their root mean square: up to 8.4e-4 where a few bright pixels make most of
/// it, else up to 4e-4.
constexpr double rmsError = 2e-3;

enum class Change {
    None,
    Nans,      ///< and infinities, in every layer
    Bright,    ///< a few pixels as bright as halves can be, and beyond
    Black,     ///< all light from the third frame on
    Negative,  ///< in places
    Smaller,   ///< pictures from the third frame on
};

struct Case {
    const char* name = "";
    std::string method = "nano";
    SyntheticOptions options{.cameraMoves = true, .objectMoves = true};
    uint32_t columns = 37, rows = 23;
    bool separate = true;
    Change change = Change::None;
    SvgfSettings svgf{};
    float strength = 1.0f;
};

/// Sets two components of every `step`th pixel, beginning with the pixel `at`.
void spoil(std::vector<float>& layer, size_t at, size_t step, float value) {
    for (size_t i = 4 * at; i < layer.size(); i += 4 * step) layer[i] = layer[i + 1] = value;
}

void addNans(HostFrame& frame, int number) {
    constexpr float infinity = std::numeric_limits<float>::infinity(),
                    most = std::numeric_limits<float>::max();
    size_t at = static_cast<size_t>(number) + 1;
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, most}) {
        for (const LayerInfo& layer : frameLayers) {
            if (!layer.isMean()) continue;
            std::vector<float>& pixels = frame[layer];
            if (&pixels == &frame.emission && bad == most) continue;  // emission is not filtered
            spoil(pixels, at, 151, bad);
            at += 7;
        }
    }
}

void changeLight(std::vector<float>& layer, Change change, size_t at) {
    if (change == Change::Bright) {
        spoil(layer, at + 11, 97, 65504.0f);
        spoil(layer, at + 27, 97, 1e30f);
    }
    for (size_t i = 0; change == Change::Negative && i < layer.size(); ++i)
        if (i / 4 % 7 < 2) layer[i] *= -1.0f;
    if (change == Change::Black && at >= 2) std::ranges::fill(layer, 0.0f);
}

HostFrame frameOf(const Case& c, int number) {
    const bool small = c.change == Change::Smaller && number >= 2;
    HostFrame frame = SyntheticScene(c.options).frame(number, c.columns - (small ? 9 : 0), c.rows, 7);
    if (c.change == Change::Nans) addNans(frame, number);
    changeLight(frame.diffuse, c.change, static_cast<size_t>(number));
    changeLight(frame.specular, c.change, static_cast<size_t>(number));
    return frame;
}

/// The albedo that light of this signal is divided by.
std::vector<dvec3> albedoOf(const HostFrame& frame, SvgfSignal signal) {
    const DoubleFrame pixels(frame);
    std::vector<dvec3> result;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        const dvec3 albedo = signal == SvgfSignal::Specular ? pixels.albedoSpecular(p) : pixels.albedo(p);
        result.push_back(isFiniteInFloat(albedo) ? albedo : dvec3(1.0));
    }
    return result;
}

/// Light that is averaged: the least and the most of each component.
struct Range {
    dvec3 least{HUGE_VAL}, most{-HUGE_VAL};

    explicit Range(const NanoFrame& frame, const NanoSignal& signal) {
        for (size_t p = 0; p < signal.filtered.size(); ++p) {
            if (frame.surfaces.distance[p] <= 0.0) continue;
            add(dvec3(signal.filtered[p]));
            add(glm::max(dvec3(signal.accumulated[p]), dvec3(0.0)));
        }
    }
    void add(const dvec3& light) {
        least = glm::min(least, light);
        most = glm::max(most, light);
    }
};

/// The root mean square of what is added.
struct Rms {
    double sum = 0.0;
    size_t count = 0;

    void add(const dvec3& v) {
        sum += glm::dot(v, v);
        count += 3;
    }
    double get() const { return std::sqrt(sum / static_cast<double>(count)); }
};

/// What a layer computed.
struct Layer {
    std::string pass;
    std::vector<float> channels;
};

class NanoTest : public DenoiseTest {
  protected:
    NanoTest() { cpu_ = false; }

    const denoise::Denoiser& method() { return *denoise::findDenoiser(method_); }
    bool isFilm() const { return method_ == "film"; }
    std::string pass(const std::string& name) const { return method_ + "/" + name; }

    std::vector<dvec3> stable(const std::string& pass, const std::string& nameEnd) {
        std::vector<dvec3> result;
        for (const uint32_t word : graph_.downloadUint(device(), written(pass, nameEnd)))
            result.push_back(decodeStable(word));
        return result;
    }
    /// The light of a signal.
    std::vector<dvec4> result(size_t signal) {
        return download(pass("filter 0"), pass(signal == 0 ? "diffuse" : "specular"));
    }

    bool hasMatrices() { return device().info().cooperativeMatrices; }
    std::string withoutMatrices() {
        return "NOT TESTED: " + device().info().name +
               " has no cooperative matrices (VK_NV_cooperative_matrix)";
    }
    bool computesOnCpu() { return device().isCpu() && denoise::networkHost() != nullptr; }
    std::string notOnCpu() {
        return "NOT TESTED: " + device().info().name + " is not the CPU, or Limpid was built without oneDNN";
    }
    std::vector<Layer> layers(const Case& c);
    void compareTiles(const Case& c);

    NanoSignal stages(const Signal& signal, const HostFrame& frame, const SvgfSettings& settings);
    NanoFrame stages(const HostFrame& frame, const DenoiserSettings& settings);
    void compare(const HostFrame& frame, const DenoiserSettings& settings);
    void compareLight(const NanoFrame& frame, const NanoLight& expected, size_t number);
    void compareStable(const NanoFrame& frame, const std::string& signal, size_t number);
    void comparePicture(const HostFrame& frame, const DenoiserSettings& settings);

    std::string method_ = "nano";
    Rms changes_, lights_;  ///< of all frames: how far the light is from SVGF's, and the light
};

NanoSignal NanoTest::stages(const Signal& signal, const HostFrame& frame, const SvgfSettings& settings) {
    const auto level = [&](int number) {
        const bool fedBack = number == std::min(settings.historyLevel, settings.levels);
        return download("svgf/level " + std::to_string(number), signal.name + (fedBack ? " color" : ""));
    };
    NanoSignal result;
    result.accumulated = download(withVariance(graph_, signal.name));
    result.first = settings.levels > 0 ? level(1) : result.accumulated;
    result.filtered = settings.levels > 0 ? level(settings.levels) : result.accumulated;
    for (const dvec4& moments : download("svgf/reproject " + signal.name, "moments"))
        result.frames.push_back(moments.w);
    result.albedo = albedoOf(frame, signal.signal);
    if (settings.stabilisationAlpha < 1.0f && settings.levels > 0)
        result.past = stable("svgf/reproject " + signal.name, "stable past");
    return result;
}

/// What the device stored of the last frame's stages.
NanoFrame NanoTest::stages(const HostFrame& frame, const DenoiserSettings& settings) {
    const std::string surfaces = graph_.imagesWrittenBy("ingest").empty() ? "surfaces" : "ingest";
    NanoFrame result{.width = frame.width,
                     .height = frame.height,
                     .camera = frame.camera,
                     .surfaces = decodeSurfaces(graph_.downloadUint(device(), written(surfaces, "surfaces"))),
                     .signals = {},
                     .strength = double{isFilm() ? settings.film.strength : settings.nano.strength}};
    for (const Signal& signal : signalsOf(settings.svgf))
        result.signals.push_back(stages(signal, frame, settings.svgf));
    return result;
}

void NanoTest::compareLight(const NanoFrame& frame, const NanoLight& expected, size_t number) {
    const std::vector<dvec4> is = result(number);
    const NanoSignal& signal = frame.signals[number];
    const Range range(frame, signal);
    Rms errors, lights;
    ASSERT_EQ(is.size(), expected.light.size());
    for (size_t p = 0; p < is.size(); ++p) {
        const dvec3 light = expected.light[p], svgf(signal.filtered[p]), difference = dvec3(is[p]) - light;
        ASSERT_EQ(is[p].w, signal.filtered[p].w) << p << ": the deviation is SVGF's";
        for (int c = 0; c < 3; ++c) {
            const double rounding = lightRounding * std::abs(light[c]) + minHalf;
            ASSERT_LE(std::abs(difference[c]), rounding + logitError * expected.spread[p][c]) << p;
            if (frame.surfaces.distance[p] <= 0.0) continue;
            ASSERT_GE(is[p][c], range.least[c] - rounding) << p << ": a mean with positive weights";
            ASSERT_LE(is[p][c], range.most[c] + rounding) << p << ": a mean with positive weights";
        }
        errors.add(difference);
        lights.add(light);
        lights_.add(light);
        changes_.add(light - svgf);
    }
    EXPECT_LE(errors.get(), rmsError * lights.get() + minHalf);
}

/// The next frame is stabilised by what `nano` made, not by what SVGF did.
void NanoTest::compareStable(const NanoFrame& frame, const std::string& signal, size_t number) {
    if (frame.signals[number].past.empty()) return;
    const std::vector<dvec4> light = result(number);
    const std::vector<dvec3> kept = stable(pass("filter 0"), signal + " stable");
    for (size_t p = 0; p < light.size(); ++p) {
        const dvec3 size = glm::abs(dvec3(light[p]));
        const double tolerance = std::max({size.x, size.y, size.z}) / 255.0 + 0x1p-24;
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(kept[p][c], light[p][c], tolerance) << p;
    }
}

void NanoTest::comparePicture(const HostFrame& frame, const DenoiserSettings& settings) {
    HostFrame finite = frame;
    for (size_t i = 0; i < finite.emission.size(); i += 4)
        if (!isFiniteInFloat({finite.emission[i], finite.emission[i + 1], finite.emission[i + 2]}))
            std::fill_n(&finite.emission[i], 3, 0.0f);
    std::vector<SvgfFiltered> light;
    for (const Signal& signal : signalsOf(settings.svgf))
        light.push_back({signal.signal, result(light.size())});
    const std::vector<dvec4> expected = svgfModulate(finite, light, double{settings.svgf.minAlbedo});
    const std::vector<dvec4> picture = download(output_.beauty);
    for (size_t p = 0; p < picture.size(); ++p) {
        for (int c = 0; c < 4; ++c) {
            ASSERT_TRUE(std::isfinite(picture[p][c])) << p;
            ASSERT_NEAR(picture[p][c], expected[p][c], 1e-5 * std::abs(expected[p][c]) + minHalf) << p;
        }
    }
}

/// Compares the last frame. With NaN in the light of any stage, the comparisons fail.
void NanoTest::compare(const HostFrame& frame, const DenoiserSettings& settings) {
    const NanoFrame is = stages(frame, settings);
    const auto expected = isFilm() ? nanoFilter(is, shapeOfFilm, denoise::filmNetwork().weights)
                                   : nanoFilter(is, shapeOfNano, denoise::nanoNetwork().weights);
    const std::vector<Signal> signals = signalsOf(settings.svgf);
    for (size_t s = 0; s < signals.size() && !HasFatalFailure(); ++s) {
        SCOPED_TRACE(signals[s].name);
        compareLight(is, expected[s], s);
        if (!HasFatalFailure()) compareStable(is, signals[s].name, s);
    }
    if (!HasFatalFailure()) comparePicture(frame, settings);
}

using CaseParam = std::tuple<Case, gpu::FilterChoice>;

std::string nameOf(const testing::TestParamInfo<CaseParam>& info) {
    const auto& [c, choice] = info.param;
    const bool images = choice.backing == gpu::Backing::Image;
    return std::string(c.name) + (choice.cpu        ? "OnCpu"
                                  : choice.matrices ? "Matrices"
                                  : images          ? "Images"
                                                    : "Buffers");
}

class NanoCaseTest : public NanoTest, public testing::WithParamInterface<CaseParam> {};

TEST_P(NanoCaseTest, TheLightAgreesWithTheFormulasInDouble) {
    const auto& [c, choice] = GetParam();
    if (choice.matrices && !hasMatrices()) GTEST_SKIP() << withoutMatrices();
    if (choice.cpu && !computesOnCpu()) GTEST_SKIP() << notOnCpu();
    method_ = c.method;
    cpu_ = choice.cpu;
    filters_ = choice.backing;
    matrices_ = choice.matrices;
    DenoiserSettings settings;
    settings.svgf = c.svgf;
    settings.svgf.separate = c.separate;
    settings.nano.strength = settings.film.strength = c.strength;
    for (int number = 0; number < 4 && !HasFatalFailure(); ++number) {
        SCOPED_TRACE("frame " + std::to_string(number));
        const HostFrame frame = frameOf(c, number);
        denoise(method(), frame, settings);
        compare(frame, settings);
    }
    EXPECT_GT(changes_.get(), 0.01 * lights_.get()) << "else there is nothing to compare";
}

constexpr gpu::FilterChoice inImages{}, inBuffers{.backing = gpu::Backing::Buffer},
    withMatrices{.backing = gpu::Backing::Buffer, .matrices = true}, onCpu{.cpu = true};

/// Filters in buffers differ in where they load and store: cases of sizes, signals and histories tell.
INSTANTIATE_TEST_SUITE_P(
    All, NanoCaseTest,
    testing::Combine(testing::Values(Case{.name = "Odd"}, Case{.name = "Tiny", .columns = 5, .rows = 3},
                                     Case{.name = "Joint", .separate = false},
                                     Case{.name = "Nans", .change = Change::Nans},
                                     Case{.name = "Smaller", .change = Change::Smaller},
                                     Case{.name = "NoPast",
                                          .svgf = {.stabilisationAlpha = 1.0f, .levels = 1}}),
                     testing::Values(inImages, inBuffers, withMatrices, onCpu)),
    nameOf);
/// What is not of the network is the same as with nano.
INSTANTIATE_TEST_SUITE_P(Film, NanoCaseTest,
                         testing::Combine(testing::Values(Case{.name = "FilmOdd", .method = "film"},
                                                          Case{.name = "FilmJointNans",
                                                               .method = "film",
                                                               .separate = false,
                                                               .change = Change::Nans}),
                                          testing::Values(inImages, inBuffers, withMatrices, onCpu)),
                         nameOf);
INSTANTIATE_TEST_SUITE_P(
    NotInBuffers, NanoCaseTest,
    testing::Combine(
        testing::Values(Case{.name = "Even", .columns = 48, .rows = 48},
                        Case{.name = "Large", .columns = 83, .rows = 50},
                        Case{.name = "Thin", .columns = 3, .rows = 40},
                        Case{.name = "LargeScale", .options = {.objectMoves = true, .scale = 1024}},
                        Case{.name = "Bright", .change = Change::Bright},
                        Case{.name = "Black", .change = Change::Black},
                        Case{.name = "Negative", .change = Change::Negative},
                        Case{.name = "JointNans", .separate = false, .change = Change::Nans},
                        Case{.name = "NoLevels", .svgf = {.levels = 0}},
                        Case{.name = "OneLevelFedBack", .svgf = {.levels = 1, .historyLevel = 1}},
                        Case{.name = "HalfStrength", .strength = 0.5f}),
        testing::Values(inImages, withMatrices, onCpu)),
    nameOf);

TEST_F(NanoTest, WithoutStrengthItIsSvgf) {
    const Case c{};
    DenoiserSettings settings;
    settings.nano.strength = 0.0f;
    std::vector<std::vector<float>> pictures;
    for (int number = 0; number < 4; ++number)
        pictures.push_back(denoise(method(), frameOf(c, number), settings));
    graph_.beginFrame();
    graph_.resetHistories();
    for (int number = 0; number < 4; ++number) {
        const std::vector<float> svgf = denoise(*denoise::findDenoiser("svgf"), frameOf(c, number), settings);
        EXPECT_EQ(pictures[static_cast<size_t>(number)], svgf) << number;
    }
}

/// Tiles overlap as far as anything in them matters.
void NanoTest::compareTiles(const Case& c) {
    method_ = c.method;
    const uint64_t bytesOfPixel = isFilm() ? 96 : 32;
    const auto padded = [](uint32_t size) { return uint64_t{16} * divideUp(size, 16); };
    std::vector<std::vector<float>> pictures;
    // Three quarters of the longer side.
    for (const uint64_t pixels : {UINT64_MAX / bytesOfPixel, padded(c.columns) * padded(c.rows) * 3 / 4}) {
        largestBuffer_ = pixels * bytesOfPixel;
        graph_.beginFrame();
        graph_.resetHistories();
        for (int number = 0; number < 3; ++number) pictures.push_back(denoise(method(), frameOf(c, number)));
    }
    EXPECT_THAT(graph_.passes(),
                testing::Contains(testing::Field(&gpu::RecordedPass::name, pass("filter 0, 2 of 4"))));
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(pictures[i], pictures[i + 3]) << c.method << ", frame " << i;
}

TEST_F(NanoTest, TilesMakeTheSamePicture) {
    compareTiles({.columns = 700, .rows = 20});
    compareTiles({.method = "film", .columns = 20, .rows = 724});
}

/// The whole picture has several bands (host_filter.cpp), the last of which overlaps the one before.
TEST_F(NanoTest, TilesAndBandsOnTheCpuMakeTheSamePicture) {
    if (!computesOnCpu()) GTEST_SKIP() << notOnCpu();
    cpu_ = true;
    compareTiles({.columns = 700, .rows = 100});
    compareTiles({.method = "film", .columns = 100, .rows = 724});
}

/// The layers of the first frame.
std::vector<Layer> NanoTest::layers(const Case& c) {
    graph_.beginFrame();
    graph_.resetHistories();
    denoise(method(), frameOf(c, 0));
    std::vector<Layer> result;
    for (const gpu::RecordedPass& pass : graph_.passes()) {
        if (pass.shader.find("nano_convolve") == std::string::npos &&
            pass.shader.find("_matrix") == std::string::npos)
            continue;
        Layer layer{.pass = pass.name, .channels = {}};
        for (const uint32_t word : graph_.downloadUint(device(), graph_.imagesWrittenBy(pass.name).at(0)))
            for (const uint32_t half : {word & 0xffffu, word >> 16u})
                layer.channels.push_back(halfToFloat(static_cast<uint16_t>(half)));
        result.push_back(std::move(layer));
    }
    return result;
}

/// Layer by layer: sums are in another order, which may round a channel to another half.
TEST_F(NanoTest, MatricesComputeTheSameChannels) {
    if (!hasMatrices()) GTEST_SKIP() << withoutMatrices();
    constexpr double rounding = 2e-3;
    for (const Case& c :
         {Case{.columns = 83, .rows = 50}, Case{.columns = 5, .rows = 3}, Case{.columns = 17, .rows = 300},
          Case{.columns = 300, .rows = 150}, Case{.method = "film", .columns = 83, .rows = 50},
          Case{.method = "film", .columns = 300, .rows = 150}}) {
        method_ = c.method;
        matrices_ = false;
        const std::vector<Layer> expected = layers(c);
        matrices_ = true;
        const std::vector<Layer> is = layers(c);
        ASSERT_EQ(is.size(), expected.size());
        for (size_t i = 0; i < is.size(); ++i) {
            SCOPED_TRACE(is[i].pass + ", " + std::to_string(c.columns) + "x" + std::to_string(c.rows));
            ASSERT_EQ(is[i].channels.size(), expected[i].channels.size());
            Rms errors, channels;
            for (size_t k = 0; k < is[i].channels.size(); ++k) {
                errors.add(dvec3(double{is[i].channels[k]} - double{expected[i].channels[k]}, 0.0, 0.0));
                channels.add(dvec3(expected[i].channels[k], 0.0, 0.0));
            }
            EXPECT_LE(errors.get(), rounding * channels.get());
        }
    }
}

/// Every weight is positive, and together they are 1.
TEST_F(NanoTest, ConstantLightStays) {
    const Case c{};
    for (const bool separate : {true, false}) {
        DenoiserSettings settings;
        settings.svgf.separate = separate;
        for (int number = 0; number < 4; ++number) {
            HostFrame frame = frameOf(c, number);
            for (size_t i = 0; i < frame.diffuse.size(); ++i) {
                const float albedo = frame.albedo[i], other = frame.albedoSpecular[i];
                frame.diffuse[i] = 0.5f * std::max(separate ? albedo : albedo + other, 0.01f);
                frame.specular[i] = separate ? 0.25f * std::max(other, 0.01f) : 0.0f;
            }
            denoise(method(), frame, settings);
            for (size_t s = 0; s < (separate ? 2 : 1); ++s) {
                const double light = s == 0 ? 0.5 : 0.25;
                for (const dvec4& texel : result(s))
                    for (int k = 0; k < 3 && texel.w >= 0.0; ++k)
                        ASSERT_NEAR(texel[k], light, lightRounding * light) << number;
            }
        }
    }
}

/// An input that a frame may lack, and the settings without it.
struct Optional {
    const char* name;
    gpu::ImageHandle denoise::DenoiserInput::*image;
    bool separate = true;
};

TEST_F(NanoTest, DoesWithoutEachOptionalInput) {
    using Input = denoise::DenoiserInput;
    const Case c{};
    for (const Optional& lacking :
         {Optional{"roughness", &Input::roughness}, Optional{"hit distance", &Input::hitDistance},
          Optional{"emission", &Input::emission}, Optional{"ids", &Input::ids},
          Optional{"previous normals", &Input::previousNormal},
          Optional{"reflections' motion", &Input::reflectionMotion},
          Optional{"specular light", &Input::specular, false},
          Optional{"specular albedo", &Input::albedoSpecular, false}}) {
        SCOPED_TRACE(lacking.name);
        graph_.beginFrame();
        graph_.resetHistories();
        DenoiserSettings settings;
        settings.svgf.separate = lacking.separate;
        for (int number = 0; number < 3; ++number) {
            HostFrame frame = frameOf(c, number);
            graph_.beginFrame();
            Input input = denoise::upload(graph_, frame);
            input.*lacking.image = {};
            output_ = method().record(graph_, input, settings, networks_);
            graph_.execute(device());
            if (lacking.image == &Input::emission) std::ranges::fill(frame.emission, 0.0f);
            if (lacking.image == &Input::albedoSpecular) frame.albedoSpecular.clear();
            compare(frame, settings);
            if (HasFatalFailure()) return;
        }
    }
}

/// Through the library, frames may have light, normals and distances alone; one white pixel is then the
/// albedo. The motion of reflections may follow from the lengths of rays.
TEST_F(NanoTest, TakesWhatTheLibraryGives) {
    const Case c{};
    const gpu::Extent extent{c.columns, c.rows};
    for (const bool raysAreGiven : {false, true}) {
        HostFrame frame = frameOf(c, 0);
        const std::vector<float> lengths(frame.diffuse.size(), 2.0f);
        graph_.beginFrame();
        denoise::IngestImages images{.radiance = uploaded("radiance", frame.diffuse, extent),
                                     .specular = uploaded("specular", frame.specular, extent),
                                     .normal = uploaded("normal", frame.normal, extent),
                                     .depth = uploaded("depth", frame.depth, extent)};
        if (raysAreGiven) {
            images.roughness = uploaded("roughness", frame.roughness, extent);
            images.hitDistance = uploaded("hit distance", lengths, extent);
        }
        denoise::IngestParams params{};
        params.camera = frame.camera;
        params.width = extent.width;
        params.height = extent.height;
        params.farDepth = 1e9f;
        output_ = method().record(graph_, denoise::ingest(graph_, images, params, {.twoSignals = true}), {},
                                  networks_);
        graph_.execute(device());
        std::ranges::fill(frame.albedo, 1.0f);
        std::ranges::fill(frame.albedoSpecular, 1.0f);
        std::ranges::fill(frame.emission, 0.0f);
        compare(frame, {});
    }
}

/// Programs that use the library let images share memory.
TEST_F(NanoTest, SharedMemoryChangesNothing) {
    const Case c{};
    gpu::FrameGraph shared({.shareMemory = true});
    for (int number = 0; number < 3; ++number) {
        const HostFrame frame = frameOf(c, number);
        const std::vector<float> alone = denoise(method(), frame);
        shared.beginFrame();
        const gpu::ImageHandle beauty =
            method().record(shared, denoise::upload(shared, frame), {}, networks_).beauty;
        shared.execute(device());
        EXPECT_EQ(shared.downloadFloat(device(), beauty), alone) << number;
        EXPECT_LT(shared.imageBytes(), graph_.imageBytes()) << number;
    }
}

TEST_F(NanoTest, MemoryStaysTheSame) {
    const HostFrame frame = frameOf({.columns = 17, .rows = 15}, 1);
    uint64_t bytes = 0;
    for (int number = 0; number < 50; ++number) {
        denoise(method(), frame);
        if (number == 0) bytes = graph_.imageBytes();
        ASSERT_EQ(graph_.imageBytes(), bytes) << number;
    }
}

}  // namespace
}  // namespace limpid::test

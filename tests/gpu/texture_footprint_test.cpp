// Tests that ray footprints do not change what a picture converges to: checkerboards seen directly and in
// glossy reflections keep the contrast they have without mip levels, and the light of a textured emitter is
// that of its texels.
#include <cmath>
#include <cstdint>
#include <functional>

#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::MipFilter;

scene::TextureRef addTexture(scene::Scene& scene, uint32_t width, uint32_t height, MipFilter mip,
                             const std::function<uint8_t(uint32_t, uint32_t)>& grey) {
    scene::Texture texture;
    texture.width = width;
    texture.height = height;
    texture.sampler.mip = mip;
    for (uint32_t y = 0; y < height; ++y) {
        for (uint32_t x = 0; x < width; ++x) {
            const uint8_t value = grey(x, y);
            texture.rgba.insert(texture.rgba.end(), {value, value, value, 255});
        }
    }
    scene.textures.push_back(std::move(texture));
    scene::TextureRef ref;
    ref.texture = static_cast<int>(scene.textures.size() - 1);
    return ref;
}

/// Two by two squares of 16 by 16 texels, so that there are levels in which contrast could be lost.
scene::Material unlitCheckerboard(scene::Scene& scene, MipFilter mip) {
    scene::Material material;
    material.unlit = true;  // no light, no noise
    material.doubleSided = true;
    material.baseColorTexture = addTexture(
        scene, 32, 32, mip, [](uint32_t x, uint32_t y) -> uint8_t { return x / 16 == y / 16 ? 255 : 0; });
    return material;
}

scene::Material emittingCheckerboard(scene::Scene& scene, MipFilter mip) {
    scene::Material material = unlitCheckerboard(scene, mip);
    material.unlit = false;
    std::swap(material.emissionTexture, material.baseColorTexture);
    material.baseColor = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    material.emission = vec3(1.0f);
    return material;
}

/// Light and dark stripes along u, constant along v.
scene::Material stripes(scene::Scene& scene, MipFilter mip) {
    scene::Material material = unlitCheckerboard(scene, mip);
    material.baseColorTexture =
        addTexture(scene, 32, 32, mip, [](uint32_t x, uint32_t) -> uint8_t { return x < 16 ? 255 : 0; });
    return material;
}

/// A wave along u. (The levels of the stripes are as sharp as they are.)
scene::Material waves(scene::Scene& scene, MipFilter mip) {
    scene::Material material = unlitCheckerboard(scene, mip);
    material.baseColorTexture = addTexture(scene, 32, 32, mip, [](uint32_t x, uint32_t) {
        return static_cast<uint8_t>(std::lround(128.0 + 120.0 * std::sin(glm::two_pi<double>() * x / 32.0)));
    });
    return material;
}

// Pictures have a column for each case, each two world units wide, since compiling for a scene takes longer
// than rendering it.
constexpr uint32_t columnPixels = 40;
constexpr float pixel = 2.0f / columnPixels;

float leftOf(size_t column, size_t columns) {
    return 2.0f * static_cast<float>(column) - static_cast<float>(columns);
}

/// Adds a strip as wide as a column, from `low` to `high`, which are (y, z). The texture repeats every
/// (period.x, period.y) along x and along the strip.
void addStrip(scene::Scene& scene, float left, const vec2& low, const vec2& high, const vec2& period,
              const scene::Material& material) {
    scene::MeshBuilder builder("strip");
    const float right = left + 2.0f, length = glm::length(high - low);
    builder.quad({left, low.x, low.y}, {right, low.x, low.y}, {right, high.x, high.y},
                 {left, high.x, high.y});
    scene::Mesh mesh = builder.take();
    const float u0 = left / period.x, u1 = right / period.x, v = length / period.y;
    mesh.uv0 = {{u0, v}, {u1, v}, {u1, 0}, {u0, 0}};
    addMesh(scene, std::move(mesh), material);
}

/// Looks from `from` towards the origin, orthographic, two world units high.
scene::Camera cameraAt(const vec3& from, const vec3& up) {
    scene::Camera camera;
    camera.orthographic = true;
    camera.toWorld = glm::inverse(glm::lookAt(from, vec3(0.0f), up));
    return camera;
}

/// A metal floor that reflects, at 45 degrees, boards that stand on it. The boards themselves are not
/// visible.
struct Reflection {
    float roughness, period;
};
scene::Scene reflectedBoards(const std::vector<Reflection>& columns,
                             scene::Material (*board)(scene::Scene&, MipFilter), MipFilter mip) {
    scene::Scene scene;
    const scene::Material boardMaterial = board(scene, mip);
    for (size_t i = 0; i < columns.size(); ++i) {
        const float left = leftOf(i, columns.size());
        scene::Material metal;
        metal.roughness = columns[i].roughness;
        addStrip(scene, left, {0, 3}, {0, -3}, vec2(1.0f), metal);
        addStrip(scene, left, {-40, -1.6f}, {40, -1.6f}, vec2(columns[i].period), boardMaterial);
    }
    scene.cameras = {cameraAt({0, 2, 2}, {0, 1, -1})};
    return scene;
}

/// Strips that are tilted away by these angles; their pattern has a period of eight pixels in both
/// directions.
constexpr float tilts[] = {0.0f, 60.0f, 80.0f};
scene::Scene tiltedBoards(MipFilter mip) {
    scene::Scene scene;
    const scene::Material board = unlitCheckerboard(scene, mip);
    for (size_t i = 0; i < std::size(tilts); ++i) {
        const float angle = glm::radians(tilts[i]);
        const vec2 high(1.1f, -1.1f * std::tan(angle));
        const vec2 period = 8.0f * pixel * vec2(1.0f, 1.0f / std::cos(angle));
        addStrip(scene, leftOf(i, std::size(tilts)), -high, high, period, board);
    }
    scene.cameras = {cameraAt({0, 0, 20}, {0, 1, 0})};
    return scene;
}

/// Tilted by 80 degrees, with stripes of four pixels along the view.
scene::Scene grazedStripes(MipFilter mip) {
    scene::Scene scene;
    const vec2 high(1.1f, -1.1f * std::tan(glm::radians(80.0f)));
    addStrip(scene, -1.0f, -high, high, vec2(8.0f * pixel), stripes(scene, mip));
    scene.cameras = {cameraAt({0, 0, 20}, {0, 1, 0})};
    return scene;
}

/// Waves of five pixels, seen straight on.
scene::Scene facedWaves(MipFilter mip) {
    scene::Scene scene;
    addStrip(scene, -1.0f, {-1.1f, 0}, {1.1f, 0}, vec2(5.0f * pixel), waves(scene, mip));
    scene.cameras = {cameraAt({0, 0, 20}, {0, 1, 0})};
    return scene;
}

double meanOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

/// Returns the amplitude of `pattern` in the picture, by least squares.
double contrastOf(const std::vector<double>& picture, const std::vector<double>& pattern) {
    const double a = meanOf(picture), b = meanOf(pattern);
    double product = 0.0, square = 0.0;
    for (size_t i = 0; i < picture.size(); ++i) {
        product += (picture[i] - a) * (pattern[i] - b);
        square += (pattern[i] - b) * (pattern[i] - b);
    }
    return product / square;
}

class TextureFootprintTest : public RenderTest {
  protected:
    using Columns = std::vector<std::vector<double>>;

    /// Returns the red channel of each column.
    Columns columnsOf(const scene::Scene& scene, size_t count, RenderSettings settings, uint64_t samples) {
        settings.extent = {columnPixels * static_cast<uint32_t>(count), columnPixels};
        const Rendered picture = render(scene, settings, samples);
        Columns columns(count);
        for (size_t i = 0; i < picture.pixelCount(); ++i)
            columns[i % settings.extent.width / columnPixels].push_back(double{picture.beauty(i).r});
        return columns;
    }

    static RenderSettings jittered(uint32_t samplesPerLaunch) {
        RenderSettings settings;
        settings.samplesPerLaunch = samplesPerLaunch;
        settings.pathtrace.maxDepth = 1;
        return settings;
    }
};

TEST_F(TextureFootprintTest, CheckerboardSeenDirectlyKeepsItsContrast) {
    constexpr size_t count = std::size(tilts);
    const Columns with = columnsOf(tiltedBoards(MipFilter::Linear), count, jittered(4), 128);
    const Columns without = columnsOf(tiltedBoards(MipFilter::None), count, jittered(4), 128);
    for (size_t i = 0; i < count; ++i) {
        const double kept = contrastOf(with[i], without[i]);
        fmt::print("{} degrees: {:.4f} of the contrast\n", tilts[i], kept);
        EXPECT_NEAR(kept, 1.0, 0.02) << tilts[i] << " degrees";
        EXPECT_NEAR(meanOf(with[i]), meanOf(without[i]), 0.005) << tilts[i] << " degrees";
    }
}

/// A picture of one sample is as sharp as the mean over the pixels.
TEST_F(TextureFootprintTest, TheFirstSampleIsBlurredLikeAPixel) {
    RenderSettings centres = jittered(1);
    centres.jitter = Jitter::Frame;
    const Columns with = columnsOf(facedWaves(MipFilter::Linear), 1, centres, 1);
    const Columns without = columnsOf(facedWaves(MipFilter::None), 1, jittered(4), 256);
    const double kept = contrastOf(with[0], without[0]);
    fmt::print("waves seen straight on, one sample: {:.4f} of the contrast\n", kept);
    EXPECT_NEAR(kept, 1.0, 0.02);
}

/// The footprint is the only filter of a pixel's first sample. With jitter, which will average later, it is
/// short across the view. With rays through the centres it is wide, so that frames for denoisers do not
/// shimmer.
TEST_F(TextureFootprintTest, GrazingViewIsBlurredAlongTheViewOnlyUnlessNothingElseFilters) {
    const auto keptOf = [&](const RenderSettings& settings) {
        const Columns with = columnsOf(grazedStripes(MipFilter::Linear), 1, settings, 1);
        const Columns without = columnsOf(grazedStripes(MipFilter::None), 1, settings, 1);
        return contrastOf(with[0], without[0]);
    };
    const double narrow = keptOf(jittered(1)), wide = keptOf(centred(1, 1, 0));
    fmt::print("stripes at 80 degrees, one sample: {:.4f} of the contrast, and {:.4f}\n", narrow, wide);
    EXPECT_GT(narrow, 0.75);
    EXPECT_LT(wide, 0.5);
}

/// With the same random numbers, both pictures have the same noise. Each board's pattern is as fine as the
/// lobe, some alpha wide, can show, with squares of at least four pixels.
TEST_F(TextureFootprintTest, CheckerboardInGlossyReflectionsKeepsItsContrast) {
    std::vector<Reflection> glossy, smooth;
    for (const float roughness : {0.0f, 0.05f, 0.1f, 0.2f, 0.5f}) {
        const float period = std::max(8.0f * pixel, 10.0f * roughness * roughness);
        glossy.push_back({roughness, period});
        smooth.push_back({0.0f, period});
    }
    const auto picture = [&](const std::vector<Reflection>& columns, MipFilter mip, uint64_t samples) {
        const scene::Scene scene = reflectedBoards(columns, unlitCheckerboard, mip);
        return columnsOf(scene, columns.size(), jittered(4), samples);
    };
    const Columns pattern = picture(smooth, MipFilter::None, 16);
    const Columns with = picture(glossy, MipFilter::Linear, 256);
    const Columns without = picture(glossy, MipFilter::None, 256);
    for (size_t i = 0; i < glossy.size(); ++i) {
        const double wanted = contrastOf(without[i], pattern[i]), found = contrastOf(with[i], pattern[i]);
        fmt::print("roughness {}: contrast {:.4f}, without mip levels {:.4f}\n", glossy[i].roughness, found,
                   wanted);
        EXPECT_GT(wanted, 0.08) << glossy[i].roughness << ": nothing to lose";
        EXPECT_NEAR(found / wanted, 1.0, 0.02) << glossy[i].roughness;
    }
}

/// Next-event estimation reads emission at points. Scattered rays must see the same light: with the same
/// random numbers, mip levels change nothing, even with the widest footprints. A mirror uses only one
/// strategy, so its emission is filtered.
TEST_F(TextureFootprintTest, BothStrategiesSeeTheSameTexturedEmitter) {
    const std::vector<Reflection> boards{{0.0f, 8.0f * pixel}, {0.2f, 8.0f * pixel}, {0.6f, 8.0f * pixel}};
    const auto picture = [&](MipFilter mip) {
        return columnsOf(reflectedBoards(boards, emittingCheckerboard, mip), boards.size(), jittered(1), 1);
    };
    const Columns with = picture(MipFilter::Linear), without = picture(MipFilter::None);
    for (size_t i = 0; i < boards.size(); ++i) {
        EXPECT_GT(meanOf(without[i]), 0.1) << boards[i].roughness;
        EXPECT_EQ(with[i] == without[i], boards[i].roughness > 0.0f) << boards[i].roughness;
    }
}

}  // namespace
}  // namespace limpid::test

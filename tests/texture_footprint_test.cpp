// Footprints of rays must not change what a picture converges to: checkerboards seen directly and in glossy
// reflections keep the contrast that they have without mip levels, and light of a textured emitter is that of
// its texels.
#include <functional>

#include "render_fixture.h"

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

/// Two by two fields of 16 by 16 texels, so that there are levels to lose the contrast in.
scene::Material checkerboard(scene::Scene& scene, MipFilter mip) {
    scene::Material material;
    material.unlit = true;  // no light, no noise
    material.doubleSided = true;
    material.baseColorTexture = addTexture(
        scene, 32, 32, mip, [](uint32_t x, uint32_t y) -> uint8_t { return x / 16 == y / 16 ? 255 : 0; });
    return material;
}

/// From `from` towards the origin, orthographic: two units of the world high.
scene::Camera cameraAt(const vec3& from, const vec3& up) {
    scene::Camera camera;
    camera.orthographic = true;
    camera.toWorld = glm::inverse(glm::lookAt(from, vec3(0.0f), up));
    return camera;
}

/// A square in the plane y = 0; its texture repeats every (period.x, period.y) units of x and z.
void addFloor(scene::Scene& scene, float half, const vec2& period, const scene::Material& material) {
    scene::MeshBuilder builder("floor");
    builder.quad({-half, 0, half}, {half, 0, half}, {half, 0, -half}, {-half, 0, -half});
    scene::Mesh mesh = builder.take();
    const vec2 n = half / period;
    mesh.uv0 = {{-n.x, n.y}, {n.x, n.y}, {n.x, -n.y}, {-n.x, -n.y}};
    addMesh(scene, std::move(mesh), material);
}

scene::Material emittingCheckerboard(scene::Scene& scene, MipFilter mip) {
    scene::Material material = checkerboard(scene, mip);
    material.unlit = false;
    std::swap(material.emissionTexture, material.baseColorTexture);
    material.baseColor = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    material.emission = vec3(1.0f);
    return material;
}

/// A metal floor that shows, at 45 degrees, a board which stands on it. The board itself is out of sight.
scene::Scene reflectedBoard(float roughness, float period,
                            scene::Material (*boardMaterial)(scene::Scene&, MipFilter), MipFilter mip) {
    scene::Scene scene;
    scene::Material metal;
    metal.roughness = roughness;
    scene::MeshBuilder floor("metal");
    floor.quad({-3, 0, 3}, {3, 0, 3}, {3, 0, -3}, {-3, 0, -3});
    addMesh(scene, floor.take(), metal);
    scene::MeshBuilder board("board");
    board.quad({-40, -40, -1.6f}, {40, -40, -1.6f}, {40, 40, -1.6f}, {-40, 40, -1.6f});
    scene::Mesh mesh = board.take();
    const float n = 40.0f / period;
    mesh.uv0 = {{-n, n}, {n, n}, {n, -n}, {-n, -n}};
    addMesh(scene, std::move(mesh), boardMaterial(scene, mip));
    scene.cameras = {cameraAt({0, 2, 2}, {0, 1, -1})};
    return scene;
}

double meanOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

/// How much of `pattern` is in the picture.
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
    static RenderSettings jittered(uint32_t size, uint32_t samplesPerLaunch) {
        RenderSettings settings;
        settings.extent = {size, size};
        settings.samplesPerLaunch = samplesPerLaunch;
        return settings;
    }

    std::vector<double> reds(const scene::Scene& scene, const RenderSettings& settings, uint64_t samples) {
        const Rendered picture = render(scene, settings, samples);
        std::vector<double> values;
        for (size_t i = 0; i < picture.pixelCount(); ++i) values.push_back(double{picture.beauty(i).r});
        return values;
    }
};

/// Fields of four pixels each way in the picture, whatever the angle.
TEST_F(TextureFootprintTest, CheckerboardSeenDirectlyKeepsItsContrast) {
    constexpr uint32_t size = 40;
    for (const float degrees : {0.0f, 60.0f, 80.0f}) {
        const auto board = [&](MipFilter mip) {
            scene::Scene scene;
            const float angle = glm::radians(degrees), period = 8.0f * 2.0f / size;
            addFloor(scene, 20.0f, {period, period / std::cos(angle)}, checkerboard(scene, mip));
            scene.cameras = {cameraAt({0, 20 * std::cos(angle), 20 * std::sin(angle)},
                                      {0, std::sin(angle), -std::cos(angle)})};
            return scene;
        };
        const auto with = reds(board(MipFilter::Linear), jittered(size, 4), 128);
        const auto without = reds(board(MipFilter::None), jittered(size, 4), 128);
        const double kept = contrastOf(with, without);
        RecordProperty(fmt::format("kept_at_{}", degrees), fmt::format("{:.4f}", kept));
        EXPECT_NEAR(kept, 1.0, 0.02) << degrees << " degrees";
        EXPECT_NEAR(meanOf(with), meanOf(without), 0.005) << degrees << " degrees";
    }
}

/// One sample a pixel through the centres has no other filter than the footprint: fields as wide as the long
/// axis must not be blurred along the short one. Stripes along the view at 80 degrees.
TEST_F(TextureFootprintTest, GrazingViewIsBlurredAlongTheViewOnly) {
    constexpr uint32_t size = 40;
    const float angle = glm::radians(80.0f), period = 8.0f * 2.0f / size;
    const auto stripes = [&](MipFilter mip) {
        scene::Scene scene;
        scene::Material material;
        material.unlit = true;
        material.baseColorTexture =
            addTexture(scene, 32, 32, mip, [](uint32_t x, uint32_t) -> uint8_t { return x < 16 ? 255 : 0; });
        addFloor(scene, 20.0f, vec2(period), material);
        scene.cameras = {cameraAt({0, 20 * std::cos(angle), 20 * std::sin(angle)},
                                  {0, std::sin(angle), -std::cos(angle)})};
        return scene;
    };
    const RenderSettings settings = centred(size, size, 0);
    const auto with = reds(stripes(MipFilter::Linear), settings, 1);
    const double kept = contrastOf(with, reds(stripes(MipFilter::None), settings, 1));
    EXPECT_GT(kept, 0.85) << "a pixel's width across is an eighth of the period";
}

/// A metal floor shows a board that hangs over it, at 45 degrees. With the same random numbers both pictures
/// have the same noise.
TEST_F(TextureFootprintTest, CheckerboardInGlossyReflectionsKeepsItsContrast) {
    constexpr uint32_t size = 48;
    for (const float roughness : {0.0f, 0.05f, 0.1f, 0.2f, 0.5f}) {
        // As fine as the lobe, some alpha wide, lets through, and fields of four pixels at least.
        const float period = std::max(0.35f, 10.0f * roughness * roughness);
        const auto reflected = [&](float floorRoughness, MipFilter mip) {
            return reflectedBoard(floorRoughness, period, checkerboard, mip);
        };
        RenderSettings settings = jittered(size, 4);
        settings.pathtrace.maxDepth = 1;
        const auto pattern = reds(reflected(0.0f, MipFilter::None), settings, 64);
        const double with = contrastOf(reds(reflected(roughness, MipFilter::Linear), settings, 64), pattern);
        const double without = contrastOf(reds(reflected(roughness, MipFilter::None), settings, 64), pattern);
        RecordProperty(fmt::format("contrast_at_{}", roughness), fmt::format("{:.4f} {:.4f}", with, without));
        EXPECT_GT(without, 0.08) << roughness << ": nothing to lose";
        EXPECT_NEAR(with / without, 1.0, 0.02) << roughness;
    }
}

/// Next-event estimation reads emission at points. What scattered rays find must be the same light: with the
/// same random numbers, mip levels change nothing, even where footprints are widest. In a mirror there is one
/// strategy only, and emission is filtered.
TEST_F(TextureFootprintTest, BothStrategiesSeeTheSameTexturedEmitter) {
    RenderSettings settings = jittered(48, 1);
    settings.pathtrace.maxDepth = 1;
    for (const float roughness : {0.0f, 0.2f, 0.6f}) {
        const auto lit = [&](MipFilter mip) {
            return reds(reflectedBoard(roughness, 0.35f, emittingCheckerboard, mip), settings, 1);
        };
        const auto with = lit(MipFilter::Linear), without = lit(MipFilter::None);
        EXPECT_GT(meanOf(without), 0.1) << roughness;
        EXPECT_EQ(with == without, roughness > 0.0f) << roughness;
    }
}

}  // namespace
}  // namespace limpid::test

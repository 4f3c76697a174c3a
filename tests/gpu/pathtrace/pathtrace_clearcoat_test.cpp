// Tests the clear coat and textured specular in pictures: normal maps, textures, and light emitted below the
// coat.
#include <numbers>

#include "scene/lights/environment.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;

double coatFresnel(double cosine) {
    return 0.04 + 0.96 * std::pow(1.0 - cosine, 5.0);
}

/// Adds a texture of one texel.
scene::TextureRef addTexture(scene::Scene& scene, std::array<uint8_t, 4> rgba, bool srgb = false) {
    scene::Texture texture;
    texture.width = texture.height = 1;
    texture.rgba.assign(rgba.begin(), rgba.end());
    texture.srgb = srgb;
    scene.textures.push_back(texture);
    scene::TextureRef ref;
    ref.texture = static_cast<int>(scene.textures.size()) - 1;
    return ref;
}

/// A square facing +Z with coordinates and tangents along +X.
scene::Mesh mappedSquare() {
    scene::Mesh mesh =
        scene::MeshBuilder("square", true).quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}).take();
    for (const vec3& p : mesh.positions) mesh.uv0.emplace_back(0.5f + 0.5f * p.x, 0.5f - 0.5f * p.y);
    mesh.tangents.assign(mesh.positions.size(), vec4(1, 0, 0, 1));
    return mesh;
}

vec3 skyRadiance(const vec3& d) {
    return {1.5f + d.x, 1.5f + d.y, 1.5f + d.z};
}

void addSmoothSky(scene::Scene& scene) {
    scene.environment = {256, 128, {}};
    for (uint32_t i = 0; i < 256 * 128; ++i) {
        const vec2 uv((static_cast<float>(i % 256) + 0.5f) / 256, (static_cast<float>(i / 256) + 0.5f) / 128);
        scene.environment.radiance.push_back(skyRadiance(scene::uvToDirection(uv)));
    }
}

class ClearcoatPictureTest : public RenderTest {
  protected:
    static dvec3 directionOf(const CameraParams& view, uint32_t size, uint32_t i) {
        const double x = 2.0 * (i % size + 0.5) / size - 1.0, y = 1.0 - 2.0 * (i / size + 0.5) / size;
        return glm::normalize(dvec3(view.forward) + x * dvec3(view.right) + y * dvec3(view.up));
    }
};

/// Over black, a smooth coat is a mirror that reflects its Fresnel term. It follows its own normal map, not
/// the base's.
TEST_F(ClearcoatPictureTest, FollowsItsOwnNormalMap) {
    for (const bool mapped : {false, true}) {
        scene::Scene scene;
        scene::Material material = lambertian(vec3(0.0f));
        material.clearcoat = 0.8f;
        material.normalTexture = addTexture(scene, {40, 200, 200, 255});
        if (mapped) material.clearcoatNormalTexture = addTexture(scene, {150, 110, 250, 255});
        addMesh(scene, mappedSquare(), material);
        addSmoothSky(scene);
        scene.cameras = {scene::lookAt({0.4f, -0.3f, 3}, {0, 0, 0}, {0, 1, 0}, 0.3f)};
        RenderSettings settings = centred(16, 16, 1);
        settings.samplesPerLaunch = 16;
        const Rendered picture = render(scene, settings, 64);
        const CameraParams view = camera(scene, settings);
        const dvec3 texel = dvec3(150, 110, 250) / 255.0 * 2.0 - 1.0;
        const dvec3 normal = mapped ? glm::normalize(texel) : dvec3(0, 0, 1);
        double worst = 0.0;
        for (uint32_t i = 0; i < 256; ++i) {
            const dvec3 d = directionOf(view, 16, i);
            const double reflectance = double{0.8f} * coatFresnel(-glm::dot(d, normal));
            const dvec3 expected = reflectance * dvec3(skyRadiance(vec3(glm::reflect(d, normal))));
            for (int c = 0; c < 3; ++c) {
                worst = std::max(worst, std::abs(picture.beauty(i)[c] / expected[c] - 1.0));
                ASSERT_NEAR(picture.beauty(i)[c] / expected[c], 1.0, 5e-3) << i << " mapped " << mapped;
            }
        }
        fmt::print("coat with{} normal map: within {:.2g}\n", mapped ? "" : "out", worst);
    }
}

/// Emission is below the coat: however the light is found, it is reduced by the coat's reflection.
TEST_F(ClearcoatPictureTest, DimsEmission) {
    const double x0 = -0.6, x1 = 0.8, z0 = -0.7, z1 = 0.5, height = 1.1;
    scene::Scene scene = floorScene(vec3(0.6f));
    scene::Material light = lambertian(vec3(0.0f));
    light.emission = vec3(5.0f);
    light.clearcoat = 1.0f;
    scene::MeshBuilder builder("light");
    builder.quad(vec3(x0, height, z0), vec3(x1, height, z0), vec3(x1, height, z1), vec3(x0, height, z1));
    addMesh(scene, builder.take(), light);
    scene.cameras = {scene::lookAt({0.2f, 0.9f, 1.6f}, {0, 0, -0.2f}, {0, 1, 0}, 0.3f)};
    RenderSettings settings = centred(8, 8, 1);
    settings.samplesPerLaunch = 128;
    const Rendered picture = render(scene, settings, 8192);
    const CameraParams view = camera(scene, settings);
    double sum = 0.0, expectedSum = 0.0;
    for (uint32_t i = 0; i < 64; ++i) {
        const dvec3 point = floorPoint(view, settings.extent, i % 8, i / 8);
        double irradiance = 0.0;
        constexpr int steps = 128;
        for (int k = 0; k < steps * steps; ++k) {
            const double sizeX = (x1 - x0) / steps, sizeZ = (z1 - z0) / steps;
            const dvec3 d =
                dvec3(x0 + (k % steps + 0.5) * sizeX, height, z0 + (k / steps + 0.5) * sizeZ) - point;
            const double d2 = glm::dot(d, d), cosine = d.y / std::sqrt(d2);
            irradiance += 5.0 * (1.0 - coatFresnel(cosine)) * cosine * cosine / d2 * sizeX * sizeZ;
        }
        sum += double{picture.beauty(i).r};
        expectedSum += double{0.6f} / pi64 * irradiance;
        ASSERT_NEAR(double{picture.beauty(i).r} / (double{0.6f} / pi64 * irradiance), 1.0, 0.05) << i;
    }
    fmt::print("floor below a coated light: {:.5f}, exactly {:.5f}\n", sum, expectedSum);
    EXPECT_NEAR(sum / expectedSum, 1.0, 5e-3);
    // Seen directly, at each pixel's own angle.
    scene.cameras = {scene::lookAt({0.1f, -3, 0.3f}, {0, 1.1f, 0}, {0, 0, 1}, 0.05f)};
    scene.instances.erase(scene.instances.begin());
    const Rendered seen = render(scene, centred(8, 8, 0), 1);
    for (uint32_t i = 0; i < 64; ++i) {
        const double cosine = directionOf(camera(scene, centred(8, 8, 0)), 8, i).y;
        EXPECT_NEAR(double{seen.beauty(i).r}, 5.0 * (1.0 - coatFresnel(cosine)), 1e-4) << i;
    }
}

/// Textures of one texel act as factors: the picture equals that with the factors alone. Channels that must
/// not matter have other values.
TEST_F(ClearcoatPictureTest, TexturesAreFactors) {
    const auto decoded = [](double encoded) { return std::pow((encoded / 255.0 + 0.055) / 1.055, 2.4); };
    scene::Scene textured;
    scene::Material material;
    material.baseColor = vec4(0.3f, 0.2f, 0.1f, 1.0f);
    material.metallic = 0.0f;
    material.roughness = 0.3f;
    material.specular = 0.9f;
    material.specularColor = vec3(1.0f, 0.8f, 2.0f);
    material.clearcoat = 0.9f;
    material.clearcoatRoughness = 0.5f;
    scene::Scene plain;
    scene::Material factors = material;
    factors.specular *= 153.0f / 255.0f;
    factors.specularColor *= vec3(decoded(200), decoded(100), decoded(60));
    factors.clearcoat *= 102.0f / 255.0f;
    factors.clearcoatRoughness *= 204.0f / 255.0f;
    material.specularTexture = addTexture(textured, {10, 20, 30, 153});
    material.specularColorTexture = addTexture(textured, {200, 100, 60, 40}, true);
    material.clearcoatTexture = addTexture(textured, {102, 33, 44, 55});
    material.clearcoatRoughnessTexture = addTexture(textured, {11, 204, 22, 33});
    // A texture without effect, so that both scenes run the same code except for the tested textures.
    factors.baseColorTexture = addTexture(plain, {255, 255, 255, 255});
    std::vector<Rendered> pictures;
    for (auto* pair : {&textured, &plain}) {
        addMesh(*pair, mappedSquare(), pair == &textured ? material : factors);
        addSmoothSky(*pair);
        pair->cameras = {scene::lookAt({0.8f, -0.6f, 2}, {0, 0, 0}, {0, 1, 0}, 0.5f)};
        RenderSettings settings = centred(16, 16, 1);
        settings.samplesPerLaunch = 16;
        pictures.push_back(render(*pair, settings, 64));
    }
    size_t different = 0;
    for (size_t i = 0; i < 256; ++i) {
        const vec3 a = pictures[0].beauty(i), b = pictures[1].beauty(i);
        different += glm::any(glm::greaterThan(glm::abs(a - b), 1e-3f * b)) ? 1 : 0;
    }
    // The same random numbers, but rounding changes about one decision in a thousand.
    EXPECT_LE(different, 12u);
    fmt::print("textures and factors: {} of 256 pixels differ\n", different);
}

}  // namespace
}  // namespace limpid::test

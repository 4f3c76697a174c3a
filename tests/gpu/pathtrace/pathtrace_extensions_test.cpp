// Tests pictures of dispersion, diffuse transmission and textures of material extensions against known
// answers.
#include <algorithm>

#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

class PathtraceExtensionsTest : public RenderTest {};

double fresnel(double cosine, double eta) {
    const double transmitted = std::sqrt(1.0 - (1.0 - cosine * cosine) / (eta * eta));
    const double s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const double p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return 0.5 * (s * s + p * p);
}

constexpr double wedge = 0.4;  // angle between the prism's faces, radians

/// A prism: its front is the plane z = 0, its back is tilted about Y.
scene::Mesh prism() {
    const float deep = 0.2f + 2.0f * std::tan(static_cast<float>(wedge));
    const vec3 p[8] = {{-1, -1, 0},     {1, -1, 0},     {1, 1, 0},     {-1, 1, 0},
                       {-1, -1, -0.2f}, {1, -1, -deep}, {1, 1, -deep}, {-1, 1, -0.2f}};
    scene::MeshBuilder builder("prism");
    for (const auto& f : {std::array{0, 1, 2, 3}, std::array{5, 4, 7, 6}, std::array{4, 0, 3, 7},
                          std::array{1, 5, 6, 2}, std::array{3, 2, 6, 7}, std::array{4, 5, 1, 0}})
        builder.quad(p[f[0]], p[f[1]], p[f[2]], p[f[3]]);
    return builder.take();
}

/// Radiance by longitude, and only where light leaves the prism's back straight: not after a reflection.
double rampAt(double u) {
    const double angle = (u - 0.5) * 2.0 * std::numbers::pi;
    return angle > 0.12 && angle < 0.32 ? 1.0 + 15.0 * (angle - 0.12) : 0.0;
}

/// The prism's back refracts each colour by Snell's law with its own index, so each sees another part of a
/// ramp.
TEST_F(PathtraceExtensionsTest, APrismSpreadsColours) {
    scene::Scene scene;
    scene::Material glass;
    glass.metallic = glass.roughness = 0.0f;
    glass.transmission = 1.0f;
    glass.thin = false;
    glass.dispersion = 2.0f;
    addMesh(scene, prism(), glass);
    scene.environment.width = 8192;
    scene.environment.height = 4;
    for (uint32_t i = 0; i < 4 * 8192; ++i)
        scene.environment.radiance.emplace_back(static_cast<float>(rampAt((i % 8192 + 0.5) / 8192)));
    scene.cameras = {scene::lookAt({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
    scene.cameras[0].orthographic = true;
    scene.cameras[0].halfHeight = 0.3f;
    RenderSettings settings = centred(32, 32, 2);
    settings.samplesPerLaunch = 4;
    Renderer renderer(device(), scene);
    for (const bool layers : {false, true}) {
        settings.layers = layers;
        const Rendered picture = renderer(settings, 256);
        const std::vector<float> beauty = beautyOf(picture.layers).pixels;
        glm::dvec3 mean(0.0);
        for (size_t i = 0; i < beauty.size(); ++i) mean[static_cast<int>(i % 3)] += double{beauty[i]};
        mean /= static_cast<double>(beauty.size() / 3);
        for (int c = 0; c < 3; ++c) {
            const double n = 1.5 + (c - 1) * 0.5 * 0.025 * 2.0;  // KHR_materials_dispersion
            const double left = std::sin(wedge) * n;
            const double angle = std::asin(left) - wedge;
            const double expected = (1.0 - fresnel(1.0, n)) * (1.0 - fresnel(std::cos(wedge), 1.0 / n)) *
                                    rampAt(angle / (2.0 * std::numbers::pi) + 0.5);
            fmt::print("prism, channel {}: {:.4f}, exactly {:.4f}\n", c, mean[c], expected);
            EXPECT_NEAR(mean[c] / expected, 1.0, 0.02) << "layers " << layers << ", channel " << c;
        }
    }
}

/// A translucent floor between a lamp below and the camera above.
TEST_F(PathtraceExtensionsTest, ALampShinesThroughATranslucentFloor) {
    scene::Scene scene = floorScene(vec3(0.6f));
    scene::Material& floor = scene.materials[0];
    floor.diffuseTransmission = 0.8f;
    floor.diffuseTransmissionColor = {0.5f, 0.9f, 0.2f};
    scene::PunctualLight light;
    light.position = {0.2f, -1.5f, 0.1f};
    light.intensity = vec3(7.0f);
    scene.lights = {light};
    scene.cameras = {scene::lookAt({0.5f, 4, 4}, {0, 0, 0}, {0, 1, 0}, 0.3f)};
    for (const float share : {1.0f, 0.5f}) {
        // A texture halves the share; its colour channels must not matter.
        if (share < 1.0f) {
            scene.textures.push_back({.name = "half", .width = 1, .height = 1, .rgba = {9, 99, 200, 128}});
            floor.diffuseTransmissionTexture.texture = 0;
            scene.meshes[0].uv0.assign(scene.meshes[0].positions.size(), vec2(0.5f));
        }
        const RenderSettings settings = centred(12, 12, 1);
        const Rendered picture = render(scene, settings, 1);
        const CameraParams view = camera(scene, settings);
        const double factor = share < 1.0f ? 128.0 / 255.0 : 1.0;
        for (uint32_t i = 0; i < picture.pixelCount(); ++i) {
            const dvec3 p = floorPoint(view, settings.extent, i % 12, i / 12), d = dvec3(light.position) - p;
            const double d2 = glm::dot(d, d), lit = 7.0 * -d.y / std::sqrt(d2) / d2 / std::numbers::pi;
            for (int c = 0; c < 3; ++c) {
                const double expected = lit * 0.8 * factor * double{floor.diffuseTransmissionColor[c]};
                EXPECT_NEAR(double{picture.beauty(i)[c]} / expected, 1.0, 5e-3) << "pixel " << i;
            }
        }
    }
}

/// A texture turns the rougher direction by a quarter, as the material's rotation does.
TEST_F(PathtraceExtensionsTest, AnisotropyFollowsTexture) {
    scene::Scene scene = floorScene(vec3(0.8f));
    scene::Mesh& mesh = scene.meshes[0];
    mesh.uv0.assign(mesh.positions.size(), vec2(0.5f));
    mesh.normals.assign(mesh.positions.size(), vec3(0, 1, 0));
    mesh.tangents.assign(mesh.positions.size(), vec4(1, 0, 0, 1));
    scene::Material& floor = scene.materials[0];
    floor.metallic = 1.0f;
    floor.roughness = 0.3f;
    floor.anisotropy = 179.0f / 255.0f;
    scene::PunctualLight light;
    light.position = {0.7f, 1.5f, -1.0f};
    light.intensity = vec3(7.0f);
    scene.lights = {light};
    scene.cameras = {scene::lookAt({0.5f, 3, 3}, {0, 0, 0}, {0, 1, 0}, 0.5f)};
    const RenderSettings settings = centred(16, 16, 1);
    const Rendered along = render(scene, settings, 1);
    floor.anisotropyRotation = std::atan2(1.0f, 1.0f / 255.0f);  // no byte is exactly 0 in [-1, 1]
    const Rendered turned = render(scene, settings, 1);
    floor.anisotropyRotation = 0.0f;
    floor.anisotropy = 1.0f;
    scene.textures.push_back({.name = "turn", .width = 1, .height = 1, .rgba = {128, 255, 179, 0}});
    floor.anisotropyTexture.texture = 0;
    const Rendered textured = render(scene, settings, 1);
    double differs = 0.0;
    for (size_t i = 0; i < along.pixelCount(); ++i) {
        const double a = double{along.beauty(i).r}, t = double{turned.beauty(i).r},
                     x = double{textured.beauty(i).r};
        EXPECT_NEAR(x, t, 2e-3 * t + 1e-4) << i;
        differs = std::max(differs, std::abs(a - t) / (t + 1e-3));
    }
    EXPECT_GT(differs, 0.5);
}

/// Textures of sheen: sRGB colour, and roughness in alpha.
TEST_F(PathtraceExtensionsTest, SheenFollowsTextures) {
    scene::Scene scene = floorScene(vec3(0.2f));
    scene::Material& floor = scene.materials[0];
    scene.environment = {.width = 4, .height = 2, .radiance = std::vector<vec3>(8, vec3(1.0f))};
    scene.cameras = {scene::lookAt({0, 0.4f, 4}, {0, 0, 0}, {0, 1, 0}, 0.2f)};
    floor.sheenColor = vec3(0.5f, 0.25f, 1.0f);
    floor.sheenRoughness = 0.5f;
    RenderSettings settings = centred(8, 8, 1);
    settings.samplesPerLaunch = 4;
    const Rendered plain = render(scene, settings, 64);
    scene.textures.push_back(
        {.name = "color", .width = 1, .height = 1, .rgba = {188, 137, 255, 7}, .srgb = true});
    scene.textures.push_back({.name = "rough", .width = 1, .height = 1, .rgba = {9, 9, 9, 128}});
    floor.sheenColor = vec3(1.0f);
    floor.sheenRoughness = 1.0f;
    floor.sheenColorTexture.texture = 0;
    floor.sheenRoughnessTexture.texture = 1;
    scene.meshes[0].uv0.assign(scene.meshes[0].positions.size(), vec2(0.5f));
    const Rendered textured = render(scene, settings, 64);
    for (size_t i = 0; i < plain.pixelCount(); ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(textured.beauty(i)[c] / plain.beauty(i)[c], 1.0f, 0.02f) << i << " channel " << c;
    }
    EXPECT_GT(plain.beauty(20).b, 1.2f * plain.beauty(20).g);
}

/// Green of the texture goes from the least to the greatest thickness of the film; red is a share of the
/// effect.
TEST_F(PathtraceExtensionsTest, FilmFollowsTextures) {
    scene::Scene scene = floorScene(vec3(0.9f, 0.8f, 0.7f));
    scene::Material& floor = scene.materials[0];
    floor.metallic = 1.0f;
    floor.roughness = 0.3f;
    scene.environment = {.width = 4, .height = 2, .radiance = std::vector<vec3>(8, vec3(1.0f))};
    scene.cameras = {scene::lookAt({0, 3, 4}, {0, 0, 0}, {0, 1, 0}, 0.2f)};
    RenderSettings settings = centred(8, 8, 1);
    settings.samplesPerLaunch = 4;
    const Rendered bare = render(scene, settings, 64);
    floor.iridescence = 0.6f;
    floor.iridescenceIor = 1.8f;
    floor.iridescenceThicknessMax = 200.0f + 0.4f * 500.0f;
    const Rendered plain = render(scene, settings, 64);
    scene.textures.push_back({.name = "film", .width = 1, .height = 1, .rgba = {153, 102, 255, 7}});
    floor.iridescence = 1.0f;
    floor.iridescenceThicknessMin = 200.0f;
    floor.iridescenceThicknessMax = 700.0f;
    floor.iridescenceTexture.texture = floor.iridescenceThicknessTexture.texture = 0;
    scene.meshes[0].uv0.assign(scene.meshes[0].positions.size(), vec2(0.5f));
    const Rendered textured = render(scene, settings, 64);
    for (size_t i = 0; i < plain.pixelCount(); ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(textured.beauty(i)[c] / plain.beauty(i)[c], 1.0f, 0.01f) << i << " channel " << c;
    }
    EXPECT_GT(glm::length(plain.beauty(20) - bare.beauty(20)), 0.05f) << "the film changes the colour";
}

}  // namespace
}  // namespace limpid::test

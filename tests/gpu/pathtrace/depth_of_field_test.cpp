// Tests the thin lens against its formulas: the circle of confusion, and the plane in focus.
#include <algorithm>
#include <numbers>

#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

constexpr double pi64 = std::numbers::pi;
constexpr float radiance = 3.0f;

scene::Material emitter(float value) {
    scene::Material material = lambertian(vec3(0.0f));
    material.emission = vec3(value);
    return material;
}

/// A square of this side, centred at `center`, that faces +Z.
scene::Mesh squareAt(const vec3& center, float side) {
    const float h = 0.5f * side;
    scene::MeshBuilder builder("square");
    builder.quad(center + vec3(-h, -h, 0), center + vec3(h, -h, 0), center + vec3(h, h, 0),
                 center + vec3(-h, h, 0));
    return builder.take();
}

/// Looks along -Z from the origin.
scene::Camera lensAt(float diameter, float focus) {
    scene::Camera camera = scene::lookAt(vec3(0.0f), {0, 0, -1}, {0, 1, 0}, 0.8f);
    camera.lensDiameter = diameter;
    camera.focusDistance = focus;
    return camera;
}

class DepthOfFieldTest : public RenderTest {
  protected:
    static RenderSettings settings(uint32_t size) {
        RenderSettings result;
        result.extent = {size, size};
        result.samplesPerLaunch = 4;
        result.pathtrace.maxDepth = 0;
        return result;
    }
};

/// What a picture shows of one blurred point: sums over its pixels.
struct Spot {
    double sum = 0.0;
    glm::dvec2 center{0.0};
    double secondMoment = 0.0;  ///< mean squared distance from `center`
};

Spot spotOf(const Rendered& picture) {
    const uint32_t width = picture.layers.extent.width;
    Spot spot;
    const auto eachPixel = [&](const auto& visit) {
        for (uint32_t i = 0; i < picture.pixelCount(); ++i)
            visit(glm::dvec2(i % width + 0.5, i / width + 0.5), double{picture.beauty(i).r});
    };
    eachPixel([&](const glm::dvec2& at, double value) {
        spot.sum += value;
        spot.center += value * at;
    });
    spot.center /= spot.sum;
    eachPixel([&](const glm::dvec2& at, double value) {
        spot.secondMoment += value * glm::dot(at - spot.center, at - spot.center) / spot.sum;
    });
    return spot;
}

/// A small square in front of and behind the plane in focus, on the axis and beside it, becomes a uniform
/// disc of the diameter A |s - d| / (s d), measured on a plane at distance 1 (E. Hecht, "Optics",
/// section 5.2: similar triangles).
TEST_F(DepthOfFieldTest, APointOutOfFocusIsAUniformDiscOfTheKnownSize) {
    struct Case {
        float diameter, focus, distance;
        vec2 offset;  // of the direction to the square, at distance 1
    };
    for (const Case& c : {Case{1.0f, 4.0f, 2.0f, vec2(0.0f)}, Case{0.8f, 2.0f, 6.0f, vec2(0.1f, -0.15f)}}) {
        const RenderSettings s = settings(64);
        const double pixels = 64.0 / (2.0 * std::tan(0.4));  // in a unit of length at distance 1
        const double side = 2.0;                             // of the square, pixels
        scene::Scene scene;
        addMesh(scene,
                squareAt(c.distance * vec3(c.offset, -1.0f), static_cast<float>(side / pixels) * c.distance),
                emitter(radiance));
        scene.cameras = {lensAt(c.diameter, c.focus)};
        const Rendered picture = render(scene, s, 1024);
        const double a = double{c.diameter}, d = double{c.focus}, z = double{c.distance};
        const double radius = 0.5 * a * std::abs(z - d) / (z * d) * pixels;
        const Spot spot = spotOf(picture);
        // The disc is convolved with the square, and with the pixel.
        const double blur = (side * side + 1.0) / 6.0;
        const double found = std::sqrt(2.0 * (spot.secondMoment - blur));
        fmt::print("lens of {} m in focus at {} m, emitter at {} m: radius {:.3f} pixels, exactly {:.3f}\n",
                   c.diameter, c.focus, c.distance, found, radius);
        ASSERT_GT(radius, 8.0);
        EXPECT_NEAR(found / radius, 1.0, 5e-3);
        EXPECT_NEAR(spot.sum / (double{radiance} * side * side), 1.0, 1e-2);
        const glm::dvec2 center = glm::dvec2(32.0) + pixels * glm::dvec2(c.offset.x, -c.offset.y);
        EXPECT_LT(glm::distance(spot.center, center), 0.05);
        // Rings of equal area inside, and nothing outside.
        const double level = double{radiance} * side * side / (pi64 * radius * radius);
        const double inner = radius - side, outer = radius + side;
        std::array<double, 4> sums{}, counts{};
        for (uint32_t i = 0; i < picture.pixelCount(); ++i) {
            const double r = glm::distance(glm::dvec2(i % 64 + 0.5, i / 64 + 0.5), center);
            const double value = double{picture.beauty(i).r};
            if (r > outer) {
                EXPECT_EQ(value, 0.0) << i;
            }
            const auto ring = static_cast<size_t>(4.0 * r * r / (inner * inner));
            if (ring >= sums.size()) continue;
            sums[ring] += value;
            counts[ring] += 1.0;
        }
        for (size_t i = 0; i < sums.size(); ++i) EXPECT_NEAR(sums[i] / counts[i] / level, 1.0, 0.1) << i;
    }
}

/// Emitters of many values in the plane in focus look as through a pinhole, bit for bit.
TEST_F(DepthOfFieldTest, ThePlaneInFocusIsThatOfThePinhole) {
    scene::Scene scene;
    const float distance = 3.0f;
    for (int i = 0; i < 36; ++i) {
        const vec3 center(0.41f * static_cast<float>(i % 6) - 1.03f, 0.37f * static_cast<float>(i / 6) - 0.9f,
                          -distance);
        addMesh(scene, squareAt(center, 0.29f), emitter(1.0f + static_cast<float>(i)));
    }
    RenderSettings s = settings(48);
    s.jitter = Jitter::Off;
    scene.cameras = {lensAt(0.0f, 0.0f)};
    const Rendered pinhole = render(scene, s, 16);
    scene.cameras = {lensAt(0.5f, distance)};
    const Rendered lens = render(scene, s, 16);
    scene.cameras = {lensAt(0.5f, 1.5f * distance)};
    const Rendered blurred = render(scene, s, 16);
    size_t changed = 0, lit = 0;
    for (size_t i = 0; i < pinhole.pixelCount(); ++i) {
        EXPECT_EQ(lens.beauty(i), pinhole.beauty(i)) << i;
        changed += blurred.beauty(i) != pinhole.beauty(i);
        lit += pinhole.beauty(i) != vec3(0.0f);
    }
    EXPECT_GT(lit, pinhole.pixelCount() / 4);
    EXPECT_GT(changed, pinhole.pixelCount() / 4);
}

/// Layers are of the same rays as the light: where a sample hits the only emitter, it hits its surface.
TEST_F(DepthOfFieldTest, LayersAreOfTheSameRays) {
    scene::Scene scene;
    scene::Material material = emitter(radiance);
    material.baseColor = vec4(0.5f, 0.5f, 0.5f, 1.0f);
    addMesh(scene, squareAt({0, 0, -2}, 0.8f), material);
    scene.cameras = {lensAt(0.3f, 4.0f)};
    RenderSettings s = settings(32);
    s.layers = true;
    const Rendered picture = render(scene, s, 16);
    size_t partly = 0;
    for (size_t i = 0; i < picture.pixelCount(); ++i) {
        const double hits = double{picture.layers.emission[4 * i]} / double{radiance};
        EXPECT_NEAR(double{picture.layers.albedo[4 * i]}, 0.5 * hits, 1e-5) << i;
        EXPECT_NEAR(double{picture.layers.normal[4 * i + 2]}, hits, 1e-5) << i;
        partly += hits > 0.01 && hits < 0.99;
    }
    EXPECT_GT(partly, 100u);
}

/// A pinhole knows no distance.
TEST_F(DepthOfFieldTest, WithoutAnApertureNothingChanges) {
    scene::Scene scene = floorScene(vec3(0.6f));
    scene::PunctualLight light;
    light.position = {0.3f, 1.5f, -0.2f};
    scene.lights = {light};
    scene.cameras = {scene::lookAt({0.5f, 4, 4}, {0, 0, 0}, {0, 1, 0}, 0.6f)};
    RenderSettings s = settings(24);
    s.pathtrace.maxDepth = 2;
    const Rendered before = render(scene, s, 4);
    scene.cameras[0].focusDistance = 1.0f;
    const Rendered after = render(scene, s, 4);
    EXPECT_EQ(before.layers.beauty, after.layers.beauty);
}

}  // namespace
}  // namespace limpid::test

// Compares light sampling with densities that are known or integrated numerically.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "environment_pdf.comp.h"
#include "lights_sample.comp.h"
#include "scene/lights/environment.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/gpu/lights/lights_sample.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

using glm::dvec3;
constexpr double pi64 = std::numbers::pi;
constexpr uint32_t sampleCount = 1u << 17;

/// An emissive triangle as the test represents it.
struct Emitter {
    vec3 v[3];
    float radiance = 1.0f;
    bool doubleSided = false;

    dvec3 normal() const { return glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0])); }
    double area() const { return 0.5 * glm::length(normal()); }
    double power() const { return area() * double{radiance} * (doubleSided ? 2.0 : 1.0); }
};

const std::vector<Emitter> oneTriangle{{{{-1, 2, -1}, {1.5f, 2, -0.5f}, {0, 2.5f, 1}}, 3.0f, true}};
const std::vector<Emitter> severalTriangles{{{{-1, 2, -1}, {1.5f, 2, -0.5f}, {0, 2.5f, 1}}, 3.0f, true},
                                            {{{3, 0, 0}, {3, 0.5f, 0.5f}, {3, 0.6f, -0.4f}}, 25.0f, false},
                                            {{{-3, -1, 2}, {-2.5f, 1, 2}, {-2.8f, -1, 3}}, 0.5f, true},
                                            {{{0, -4, 0}, {0, -4, 1}, {1, -4, 0}}, 10.0f, false}};

scene::Scene sceneOf(const std::vector<Emitter>& emitters) {
    scene::Scene scene;
    if (emitters.empty()) scene.materials.emplace_back();
    for (const Emitter& e : emitters) {
        scene::Material material;
        material.metallic = material.specular = 0.0f;
        material.emission = vec3(e.radiance);
        material.doubleSided = e.doubleSided;
        scene::Mesh mesh;
        mesh.positions.assign(e.v, e.v + 3);
        for (uint32_t i = 0; i < 3; ++i) mesh.indices.push_back(i);
        scene::Instance instance;
        instance.mesh = static_cast<int>(scene.meshes.size());
        instance.material = static_cast<int>(scene.materials.size());
        scene.materials.push_back(material);
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back(std::move(instance));
    }
    return scene;
}

/// A dim environment with a sun of a few texels that is 50,000 times as bright, and a black region.
scene::Environment sunnyEnvironment() {
    scene::Environment environment{48, 24, {}};
    for (uint32_t y = 0; y < 24; ++y) {
        for (uint32_t x = 0; x < 48; ++x) {
            const float base = 0.2f + 0.1f * static_cast<float>((x * 7 + y * 13) % 11);
            const bool sun = (x == 30 || x == 31) && y == 6;
            environment.radiance.emplace_back(y > 18 ? 0.0f : sun ? 50000.0f : base);
        }
    }
    return environment;
}

/// The triangle hit by a direction, with the barycentrics of vertices 1 and 2; -1 if none.
struct Met {
    int index = -1;
    double u = 0.0, v = 0.0, t = 0.0;
};

Met meet(const std::vector<Emitter>& emitters, const vec3& from, const vec3& direction) {
    Met met;
    double nearest = 1e30;
    for (size_t i = 0; i < emitters.size(); ++i) {
        const Emitter& e = emitters[i];
        const dvec3 e1 = dvec3(e.v[1]) - dvec3(e.v[0]), e2 = dvec3(e.v[2]) - dvec3(e.v[0]),
                    s = dvec3(from) - dvec3(e.v[0]);
        const dvec3 d(direction), p = glm::cross(d, e2), q = glm::cross(s, e1);
        const double determinant = glm::dot(e1, p), u = glm::dot(s, p) / determinant,
                     v = glm::dot(d, q) / determinant;
        const double t = glm::dot(e2, q) / determinant;
        // Accepts points slightly beyond the edges, where rounding may move them.
        if (u < -1e-3 || v < -1e-3 || u + v > 1.001 || !(t > 0.0) || t > nearest) continue;
        nearest = t;
        met = {static_cast<int>(i), u, v, t};
    }
    return met;
}

class LightsTest : public GpuTest {
  protected:
    /// Samples lights at a point of a surface with this normal; without one, all directions are equal.
    std::vector<DrawnLight> draw(const scene::Scene& scene, const vec3& from, uint32_t count, uint32_t seed,
                                 const vec3& normal = vec3(0.0f), bool byTree = false) {
        const scene::SceneData data = scene::buildSceneData(scene, {}, byTree);
        const scene::GpuScene gpuScene(device(), data);
        const LightsSampleParams params{data.params, from, normal, count, seed};
        const Job job{.shader = shaders::lights_sample_comp,
                      .scene = &gpuScene,
                      .constants = {{"LIGHT_TREE", byTree ? 1u : 0u}},
                      .params = gpu::paramsOf(params),
                      .count = count};
        return run<DrawnLight>(job, count);
    }

    std::vector<vec4> environmentAt(const scene::Scene& scene, const std::vector<vec3>& directions) {
        const scene::SceneData data = scene::buildSceneData(scene);
        const scene::GpuScene gpuScene(device(), data);
        const auto count = static_cast<uint32_t>(directions.size());
        const LightsSampleParams params{data.params, vec3(0.0f), vec3(0.0f), count, 0};
        const gpu::Buffer buffer = upload("directions", directions);
        const Job job{.shader = shaders::environment_pdf_comp,
                      .scene = &gpuScene,
                      .buffers = {{"directions", &buffer}},
                      .params = gpu::paramsOf(params),
                      .count = count};
        return run<vec4>(job, count);
    }

    /// Three quarters by power, one quarter uniform: here every triangle is a lamp of its own.
    static double probabilityOf(const std::vector<Emitter>& emitters, const Emitter& chosen) {
        double power = 0.0;
        for (const Emitter& e : emitters) power += e.power();
        return 0.75 * chosen.power() / power + 0.25 / static_cast<double>(emitters.size());
    }

    /// Checks that samples are uniform over each triangle. `share` is the probability of sampling a triangle
    /// at all.
    void checkTriangles(const std::vector<Emitter>& emitters, const std::vector<DrawnLight>& drawn,
                        const vec3& from, double share) {
        constexpr size_t side = 8;
        double visible = 0.0;
        std::vector<double> observed(emitters.size() * side * side, 0.0), expected(observed.size(), 0.0);
        for (size_t i = 0; i < emitters.size(); ++i) {
            const bool front = glm::dot(emitters[i].normal(), dvec3(from) - dvec3(emitters[i].v[0])) > 0.0;
            if (!front && !emitters[i].doubleSided) continue;
            const double probability = share * probabilityOf(emitters, emitters[i]);
            visible += probability;
            for (size_t bin = 0; bin < side * side; ++bin) {
                expected[i * side * side + bin] =
                    static_cast<double>(drawn.size()) * probability / (side * side);
            }
        }
        double none = 0.0, different = 0.0;
        for (const DrawnLight& light : drawn) {
            if (light.delta) continue;
            if (light.pdf == 0.0f) {
                ++none;
                continue;
            }
            if (light.distance > 1e20f) continue;
            const Met met = meet(emitters, from, light.direction);
            ASSERT_GE(met.index, 0) << "a direction that meets no light";
            const Emitter& e = emitters[static_cast<size_t>(met.index)];
            ++observed[static_cast<size_t>(met.index) * side * side + binOf(met, side)];
            const double cosine = std::abs(glm::dot(glm::normalize(e.normal()), dvec3(light.direction)));
            const double pdf = share * probabilityOf(emitters, e) * met.t * met.t / (e.area() * cosine);
            ASSERT_NEAR(double{light.pdf} / pdf, 1.0, 1e-3) << "triangle " << met.index;
            ASSERT_NEAR(double{light.distance} / met.t, 1.0, 1e-3) << "triangle " << met.index;
            ASSERT_FLOAT_EQ(light.radiance.r, e.radiance);
            different += std::abs(light.hitPdf / light.pdf - 1.0f) > 1e-3f;
        }
        const double n = static_cast<double>(drawn.size());
        const double hidden = std::max(share - visible, 0.0);
        // A ray to a point exactly on an edge may miss the triangle.
        EXPECT_LE(different, n / 5000.0) << "densities of a hit that differ from the sampled ones";
        EXPECT_NEAR(none, n * hidden, 4.5 * std::sqrt(n * hidden) + 1e-6)
            << "samples of lights seen from behind";
        expectFit(observed, expected);
    }

    /// Bins on an equal-area grid of the triangle: inverts the warp of uniform sampling.
    static size_t binOf(const Met& met, size_t side) {
        const double sum = std::clamp(met.u + met.v, 1e-9, 1.0);
        const auto clampIndex = [&](double x) {
            return static_cast<size_t>(
                std::clamp(x * static_cast<double>(side), 0.0, static_cast<double>(side) - 0.5));
        };
        return clampIndex(sum * sum) * side + clampIndex(met.v / sum);
    }

    static void expectFit(std::vector<double> observed, std::vector<double> expected) {
        double sumObserved = 0.0, sumExpected = 0.0;
        for (size_t i = 0; i < expected.size(); ++i) {
            sumObserved += observed[i];
            sumExpected += expected[i];
        }
        EXPECT_NEAR(sumObserved, sumExpected, 4.5 * std::sqrt(sampleCount * 0.25) + 1e-3 * sumExpected);
        const double scale = sumObserved / sumExpected;
        for (double& e : expected) e *= scale;
        const ChiSquare result = chiSquare(observed, expected);
        EXPECT_FALSE(result.impossible);
        EXPECT_GT(result.p, 1e-4) << "chi-square " << result.statistic << " with " << result.degreesOfFreedom
                                  << " degrees of freedom; " << result.worst;
        fmt::print("{} bins, chi-square {:.1f}, p {:.3f}\n", result.degreesOfFreedom + 1, result.statistic,
                   result.p);
    }

    /// Bins of half a texel of the environment, with the density integrated over each.
    void checkEnvironment(const scene::Scene& scene, const std::vector<DrawnLight>& drawn, double share) {
        const size_t columns = size_t{scene.environment.width} * 2,
                     rows = size_t{scene.environment.height} * 2;
        constexpr size_t fine = 4;
        std::vector<vec3> directions;
        std::vector<double> areas;
        for (size_t y = 0; y < rows * fine; ++y) {
            for (size_t x = 0; x < columns * fine; ++x) {
                const double u = (static_cast<double>(x) + 0.5) / static_cast<double>(columns * fine);
                const double v = (static_cast<double>(y) + 0.5) / static_cast<double>(rows * fine);
                directions.push_back(scene::uvToDirection(vec2(u, v)));
                areas.push_back(2.0 * pi64 * pi64 * std::sin(pi64 * v) /
                                static_cast<double>(columns * rows * fine * fine));
            }
        }
        const std::vector<vec4> values = environmentAt(scene, directions);
        std::vector<double> expected(rows * columns, 0.0), observed(expected.size(), 0.0);
        double total = 0.0;
        for (size_t i = 0; i < values.size(); ++i) {
            const size_t x = i % (columns * fine) / fine, y = i / (columns * fine) / fine;
            expected[y * columns + x] += share * sampleCount * double{values[i].w} * areas[i];
            total += double{values[i].w} * areas[i];
        }
        EXPECT_NEAR(total, 1.0, 2e-3) << "the density over the sphere";
        for (const DrawnLight& light : drawn) {
            if (light.delta || light.pdf == 0.0f || light.distance < 1e20f) continue;
            const vec2 uv = scene::directionToUv(light.direction);
            ++observed[std::min(static_cast<size_t>(uv.y * static_cast<float>(rows)), rows - 1) * columns +
                       std::min(static_cast<size_t>(uv.x * static_cast<float>(columns)), columns - 1)];
        }
        expectFit(observed, expected);
    }

    /// Sampled and looked-up densities agree, except where rounding moves a direction into the next texel.
    static void checkEnvironmentPdf(const std::vector<DrawnLight>& drawn) {
        uint32_t count = 0, different = 0;
        for (const DrawnLight& light : drawn) {
            if (light.delta || light.distance < 1e20f || light.hitDistance >= 0.0f) continue;
            ++count;
            different += std::abs(light.hitPdf / light.pdf - 1.0f) > 1e-3f;
        }
        EXPECT_GT(count, 1000u);
        EXPECT_LE(different, count / 1000) << "of " << count;
    }
};

TEST_F(LightsTest, OneTriangle) {
    const vec3 from(0.2f, 0.1f, -0.3f);
    checkTriangles(oneTriangle, draw(sceneOf(oneTriangle), from, sampleCount, 1), from, 1.0);
}

TEST_F(LightsTest, TrianglesOfDifferentPower) {
    for (const vec3& from : {vec3(0.2f, 0.1f, -0.3f), vec3(-1.0f, -2.0f, 0.5f), vec3(0.4f, 1.9f, 0.1f)}) {
        checkTriangles(severalTriangles, draw(sceneOf(severalTriangles), from, sampleCount, 2), from, 1.0);
    }
}

TEST_F(LightsTest, EnvironmentWithASun) {
    scene::Scene scene = sceneOf({});
    scene.environment = sunnyEnvironment();
    const std::vector<DrawnLight> drawn = draw(scene, vec3(0.0f), sampleCount, 3);
    checkEnvironment(scene, drawn, 1.0);
    checkEnvironmentPdf(drawn);
}

/// Cosines are distributed as cos / pi says, so their squares are uniform; both densities are that.
TEST_F(LightsTest, AnEvenEnvironmentIsSampledByTheCosine) {
    scene::Scene scene = sceneOf({});
    scene.environment = {2, 2, {vec3(1.0f), vec3(1.5f), vec3(0.5f), vec3(1.0f)}};
    const vec3 normal = glm::normalize(vec3(0.3f, -0.8f, 0.5f));
    const std::vector<DrawnLight> drawn = draw(scene, vec3(0.0f), sampleCount, 6, normal);
    std::vector<double> observed(32), expected(32, sampleCount / 32.0);
    const vec3 side = glm::normalize(glm::cross(normal, vec3(0, 1, 0)));
    for (const DrawnLight& light : drawn) {
        const float cosine = glm::dot(light.direction, normal);
        ASSERT_GE(cosine, 0.0f);
        ASSERT_NEAR(double{light.pdf}, double{cosine} / pi64, 1e-5);
        ASSERT_NEAR(light.hitPdf, light.pdf, 1e-5f);
        const auto ring = static_cast<size_t>(std::min(16.0f * cosine * cosine, 15.0f));
        observed[2 * ring + (glm::dot(light.direction, side) > 0.0f)] += 1.0;
    }
    expectFit(observed, expected);
}

/// Directions map to the picture as environment.h describes. The pictures contain their own coordinates.
TEST_F(LightsTest, EnvironmentLookUpIsExact) {
    scene::Scene scene = sceneOf({});
    scene.environment = {64, 32, {}};
    for (uint32_t y = 0; y < 32; ++y) {
        for (uint32_t x = 0; x < 64; ++x) {
            scene.environment.radiance.emplace_back((static_cast<float>(x) + 0.5f) / 64,
                                                    (static_cast<float>(y) + 0.5f) / 32, 0);
        }
    }
    std::mt19937 random(8);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    std::vector<vec3> directions;
    while (directions.size() < 20000) {
        const dvec3 d(uniform(random), uniform(random), uniform(random));
        if (glm::length(d) > 0.1) directions.emplace_back(glm::normalize(d));
    }
    const std::vector<vec4> values = environmentAt(scene, directions);
    double worstU = 0.0, worstV = 0.0;
    for (size_t i = 0; i < directions.size(); ++i) {
        const dvec3 d = glm::normalize(dvec3(directions[i]));
        const double u = std::atan2(d.x, -d.z) / (2.0 * pi64) + 0.5, v = std::acos(d.y) / pi64;
        // Half a texel at the border is constant or wraps; near a pole u is ill-conditioned.
        if (u > 0.01 && u < 0.99 && std::abs(d.y) < 0.98)
            worstU = std::max(worstU, std::abs(double{values[i].x} - u));
        if (v > 0.02 && v < 0.98) worstV = std::max(worstV, std::abs(double{values[i].y} - v));
    }
    fmt::print("look-up is off by {:.2g} of the width, {:.2g} of the height\n", worstU, worstV);
    // A twentieth of a texel of a 4096 x 2048 picture.
    EXPECT_LT(worstU, 0.05 / 4096);
    EXPECT_LT(worstV, 0.05 / 2048);
}

/// A sample's radiance equals what a ray in its direction sees.
TEST_F(LightsTest, EnvironmentRadianceIsTheSampledOne) {
    scene::Scene scene = sceneOf({});
    scene.environment = sunnyEnvironment();
    for (vec3& radiance : scene.environment.radiance) radiance = glm::min(radiance, vec3(20.0f));
    const std::vector<DrawnLight> drawn = draw(scene, vec3(0.0f), 4096, 4);
    std::vector<vec3> directions;
    for (const DrawnLight& light : drawn) directions.push_back(light.direction);
    const std::vector<vec4> values = environmentAt(scene, directions);
    for (size_t i = 0; i < drawn.size(); ++i) {
        ASSERT_NEAR(values[i].x, drawn[i].radiance.x, 0.02f) << "sample " << i << " of seed 4";
    }
}

TEST_F(LightsTest, MixtureOfEverything) {
    scene::Scene scene = sceneOf(severalTriangles);
    scene.environment = sunnyEnvironment();
    const vec3 from(0.2f, 0.1f, -0.3f);
    const std::vector<DrawnLight> drawn = draw(scene, from, sampleCount, 5);
    checkTriangles(severalTriangles, drawn, from, 0.5);
    checkEnvironment(scene, drawn, 0.5);
    checkEnvironmentPdf(drawn);
}

/// Emissive triangles are sampled according to their power (here at least 20 %, at most 65 %). Punctual
/// lights are sampled by contribution in three of five samples, and uniformly in two.
TEST_F(LightsTest, PunctualLights) {
    scene::Scene scene = sceneOf(oneTriangle);
    scene::PunctualLight point, spot;
    point.position = {2, 3, 4};
    point.intensity = vec3(5.0f);
    spot.kind = scene::PunctualLight::Kind::Spot;
    spot.position = {-2, 3, 1};
    spot.direction = glm::normalize(vec3(2, -3, -1));
    spot.intensity = vec3(40.0f);
    spot.innerCone = 0.2f;
    spot.outerCone = 0.5f;
    scene.lights = {point, spot};
    const vec3 from(0.0f);
    const double arrives[] = {5.0 / 29.0, 40.0 / 14.0}, all = arrives[0] + arrives[1];
    const double triangle =
        std::clamp(oneTriangle[0].power() / (oneTriangle[0].power() + 4.0 * 45.0), 0.2, 0.65);
    const double probabilities[] = {triangle, (1.0 - triangle) * (0.6 * arrives[0] / all + 0.2),
                                    (1.0 - triangle) * (0.6 * arrives[1] / all + 0.2)};
    std::vector<double> observed(3, 0.0), expected;
    for (const double probability : probabilities) expected.push_back(sampleCount * probability);
    for (const DrawnLight& light : draw(scene, from, sampleCount, 6)) {
        const bool isPoint = light.delta && light.direction.x > 0.0f;
        ++observed[light.delta ? (isPoint ? 1 : 2) : 0];
        if (!light.delta) continue;
        ASSERT_NEAR(light.pdf, probabilities[isPoint ? 1 : 2], 1e-5);
        const double d2 = isPoint ? 29.0 : 14.0;  // the spot's axis goes through the point
        ASSERT_NEAR(light.radiance.g, (isPoint ? 5.0 : 40.0) / d2, 1e-4);
        ASSERT_NEAR(light.distance, std::sqrt(d2), 1e-5);
    }
    expectFit(observed, expected);
}

/// Returns the irradiance from a punctual light on an upward-facing floor at the origin, by the test's own
/// formula.
double irradianceOf(const scene::PunctualLight& light) {
    using Kind = scene::PunctualLight::Kind;
    if (light.kind == Kind::Directional)
        return double{light.intensity.r} * std::max(-double{light.direction.y}, 0.0);
    const dvec3 way(light.position);
    const double distance = glm::length(way), cosine = std::max(way.y / distance, 0.0);
    double result = double{light.intensity.r} * cosine / (distance * distance);
    if (light.range > 0.0f)
        result *= std::clamp(1.0 - std::pow(distance / double{light.range}, 4.0), 0.0, 1.0);
    if (light.kind == Kind::Spot) {
        const double inner = std::cos(double{light.innerCone}), outer = std::cos(double{light.outerCone});
        const double cone = (glm::dot(dvec3(light.direction), -way / distance) - outer) / (inner - outer);
        result *= std::pow(std::clamp(cone, 0.0, 1.0), 2.0);
    }
    return result;
}

scene::PunctualLight pointLight(const vec3& position, float intensity) {
    scene::PunctualLight light;
    light.position = position;
    light.intensity = vec3(intensity);
    return light;
}

scene::PunctualLight spotLight(const vec3& position, const vec3& target, float intensity, float outerCone) {
    scene::PunctualLight light = pointLight(position, intensity);
    light.kind = scene::PunctualLight::Kind::Spot;
    light.direction = glm::normalize(target - position);
    light.innerCone = 0.5f * outerCone;
    light.outerCone = outerCone;
    return light;
}

/// A few lights have no tree. These make them many.
void addDarkLamps(scene::Scene& scene) {
    for (int i = 0; i < 9; ++i) scene.lights.push_back(pointLight({0, 9, 0}, 0.0f));
}

/// The floor's irradiance estimated from single samples: mean and relative variance, and how often each lamp
/// was chosen.
struct FloorLight {
    double mean = 0.0, variance = 0.0;
    std::vector<double> frequencies;
};

FloorLight floorLight(const scene::Scene& scene, const std::vector<DrawnLight>& drawn) {
    FloorLight result;
    result.frequencies.resize(scene.lights.size());
    const double share = 1.0 / static_cast<double>(drawn.size());
    double square = 0.0;
    for (const DrawnLight& light : drawn) {
        if (light.pdf <= 0.0f || !light.delta) continue;
        const double value =
            double{light.radiance.r} * std::max(double{light.direction.y}, 0.0) / double{light.pdf};
        result.mean += value * share;
        square += value * value * share;
        size_t chosen = 0;
        double nearest = 2.0;
        for (size_t i = 0; i < scene.lights.size(); ++i) {
            const scene::PunctualLight& lamp = scene.lights[i];
            const bool sun = lamp.kind == scene::PunctualLight::Kind::Directional;
            const vec3 towards = sun ? -lamp.direction : glm::normalize(lamp.position);
            const double off = 1.0 - double{glm::dot(towards, light.direction)};
            if (off < nearest) chosen = i;
            nearest = std::min(nearest, off);
        }
        result.frequencies[chosen] += share;
    }
    result.variance = square / (result.mean * result.mean) - 1.0;
    return result;
}

/// One narrow spot lights the floor; brighter lamps do not reach it: out of range, outside their cone, or
/// from below.
TEST_F(LightsTest, ANarrowSpotAmongBrightLampsElsewhere) {
    scene::Scene scene = sceneOf({{{{5, 1, 5}, {5, 1, 6}, {6, 1, 5}}, 4000.0f, false}});
    scene.environment = sunnyEnvironment();
    scene.lights = {spotLight({0.1f, 3, 0}, {0, 0, 0}, 10.0f, 0.05f), pointLight({4, 2, 0}, 5000.0f),
                    spotLight({-2, 3, 1}, {-5, 0, 1}, 8000.0f, 0.4f), pointLight({0.5f, -1, 0}, 3000.0f)};
    scene.lights[1].range = 4.0f;
    addDarkLamps(scene);
    ASSERT_EQ(irradianceOf(scene.lights[1]) + irradianceOf(scene.lights[2]) + irradianceOf(scene.lights[3]),
              0.0);
    for (const bool byTree : {false, true}) {
        const FloorLight found =
            floorLight(scene, draw(scene, vec3(0.0f), sampleCount, 7, {0, 1, 0}, byTree));
        fmt::print("the narrow spot: {:.4f} of the samples, relative variance {:.2f}\n", found.frequencies[0],
                   found.variance);
        EXPECT_GE(found.frequencies[0], byTree ? 0.45 : 0.1);  // half are the environment's
        EXPECT_LT(found.variance, byTree ? 1.5 : 9.0);
        EXPECT_NEAR(found.mean / irradianceOf(scene.lights[0]), 1.0, 0.03);
    }
}

/// No lamp is chosen with less than a tenth of its share of the incident light, and the estimate is correct:
/// for few lamps, and for the largest number that are chosen by power.
TEST_F(LightsTest, LampsAreDrawnByWhatArrives) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    for (const size_t count : {size_t{2}, size_t{5}, size_t{32}, size_t{256}}) {
        scene::Scene scene = sceneOf(oneTriangle);
        for (size_t i = 0; i < count; ++i) {
            const vec3 at(3.0f * uniform(random), 2.0f * uniform(random) + 1.5f, 3.0f * uniform(random));
            const float intensity = std::exp(3.0f * uniform(random));
            scene.lights.push_back(i % 2 == 0
                                       ? pointLight(at, intensity)
                                       : spotLight(at, {0.5f * uniform(random), 0, 0}, intensity, 0.3f));
            if (i % 7 == 3) {
                scene.lights.back().kind = scene::PunctualLight::Kind::Directional;
                scene.lights.back().intensity *= 0.02f;
            }
        }
        double sum = 0.0;
        for (const scene::PunctualLight& lamp : scene.lights) sum += irradianceOf(lamp);
        for (const bool byTree : {false, true}) {
            const FloorLight found =
                floorLight(scene, draw(scene, vec3(0.0f), sampleCount, 9, {0, 1, 0}, byTree));
            const double error = std::sqrt(found.variance / sampleCount);
            fmt::print("{} lamps by {}: mean off by {:+.4f}, relative variance {:.2f}\n", count,
                       byTree ? "tree" : "power", found.mean / sum - 1.0, found.variance);
            EXPECT_NEAR(found.mean / sum, 1.0, 4.5 * error + 1e-4) << count;
            for (size_t i = 0; i < count; ++i) {
                const double share = irradianceOf(scene.lights[i]) / sum, f = found.frequencies[i];
                EXPECT_GE(f + 4.5 * std::sqrt(f / sampleCount) + 1e-5, 0.1 * share)
                    << count << " lamps by " << (byTree ? "tree" : "power") << ", number " << i;
            }
        }
    }
}

/// The density of a sample is that with which a ray that hits the same light is weighed.
TEST_F(LightsTest, TheTreeWeighsHitsByTheDensitiesOfSamples) {
    scene::Scene scene = sceneOf(severalTriangles);
    scene.environment = sunnyEnvironment();
    scene.lights = {pointLight({1, 2, 3}, 3.0f), pointLight({0, 3, 0}, 0.1f)};
    scene.lights[1].kind = scene::PunctualLight::Kind::Directional;
    addDarkLamps(scene);
    for (const vec3& normal : {vec3(0.0f), vec3(0, 1, 0), glm::normalize(vec3(1, -1, 0.5f))}) {
        const std::vector<DrawnLight> drawn = draw(scene, {0.2f, 0.1f, -0.3f}, sampleCount, 10, normal, true);
        uint32_t hits = 0, different = 0, deltas = 0, ofEnvironment = 0;
        for (const DrawnLight& light : drawn) {
            deltas += light.delta;
            ofEnvironment += !light.delta && light.distance > 1e20f;
            if (light.delta || light.pdf == 0.0f || light.distance > 1e20f) continue;
            ++hits;
            different += std::abs(light.hitPdf / light.pdf - 1.0f) > 1e-3f;
        }
        EXPECT_GT(hits, sampleCount / 50);
        EXPECT_LE(different, hits / 1000);
        EXPECT_GT(deltas, sampleCount / 50);
        EXPECT_NEAR(ofEnvironment, sampleCount / 2, 4.5 * std::sqrt(sampleCount / 4.0));
        checkEnvironmentPdf(drawn);
    }
}

}  // namespace
}  // namespace limpid::test

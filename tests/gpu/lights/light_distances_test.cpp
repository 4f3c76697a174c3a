// Maps of distances around lamps, against formulas; and what they do for sampling in a house of many rooms,
// whose lamps are bright and hidden but for those of one room.
#include "passes/light_distances/light_distances.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>

#include "lights_sample.comp.h"
#include "passes/light_distances/light_distances_params.h"
#include "scene/builtin/builtin_parts.h"
#include "scene/lights/light_control.h"
#include "scene/lights/live_lights.h"
#include "scene/motion/movement.h"
#include "scene/motion/scene_animator.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/lights/lights_sample.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {
namespace {

using scene::MeshBuilder;
using scene::PunctualLight;
using scene::Scene;

constexpr uint32_t side = layout::LIGHT_MAP_SIZE;

PunctualLight lampAt(const vec3& position, float intensity) {
    PunctualLight lamp;
    lamp.position = position;
    lamp.intensity = vec3(intensity);
    return lamp;
}

/// Walls, floor and, unless open, ceiling around a space.
void addBox(Scene& scene, const vec3& a, const vec3& b, bool ceiling = true) {
    MeshBuilder builder("box");
    builder.quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z});
    builder.quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z});
    builder.quad({a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    builder.quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z});
    builder.quad({b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z});
    if (ceiling) builder.quad({a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z});
    scene::Material material = lambertian(vec3(0.6f));
    material.doubleSided = true;
    addMesh(scene, builder.take(), material);
}

constexpr int roomsX = 6, roomsZ = 5;
constexpr size_t dimLamps = 2;  ///< the first lamps are those of the room at the origin

/// Rooms of 4 x 3 x 4 m around the one whose corner is at the origin; a bright lamp in each other one, and
/// two dim lamps in this one.
Scene house() {
    Scene scene;
    scene.lights = {lampAt({1.0f, 2.5f, 1.2f}, 1.0f), lampAt({3.0f, 2.0f, 3.0f}, 0.4f)};
    for (int x = -3; x < roomsX - 3; ++x) {
        for (int z = -2; z < roomsZ - 2; ++z) {
            const vec3 corner(4.0f * static_cast<float>(x), 0.0f, 4.0f * static_cast<float>(z));
            addBox(scene, corner, corner + vec3(4.0f, 3.0f, 4.0f));
            if (x == 0 && z == 0) continue;
            scene.lights.push_back(lampAt(corner + vec3(2.0f, 2.4f, 2.0f), 300.0f));
            if (x % 2 == 0) continue;
            scene.lights.back().kind = PunctualLight::Kind::Spot;
            scene.lights.back().outerCone = 1.5f;
            scene.lights.back().direction =
                glm::normalize(-scene.lights.back().position + vec3(2.0f, 0.0f, 2.0f));
        }
    }
    scene::addCamera(scene, {0.3f, 1.6f, 0.3f}, {2.6f, 0.9f, 2.6f}, 1.2f);
    return scene;
}

/// A point of the room of the dim lamps.
struct Place {
    vec3 position, normal;
};
constexpr std::array<Place, 5> places{
    Place{{2.0f, 0.001f, 2.0f}, {0, 1, 0}}, Place{{0.5f, 0.001f, 3.5f}, {0, 1, 0}},
    Place{{3.5f, 0.001f, 3.5f}, {0, 1, 0}}, Place{{0.001f, 1.0f, 2.0f}, {1, 0, 0}},
    Place{{3.0f, 2.8f, 3.999f}, {0, 0, -1}}};

/// On the floor and the walls, near each other and near corners of this room, behind whose walls bright lamps
/// are.
std::vector<Place> nearCorners() {
    std::vector<Place> near;
    for (const float d : {0.01f, 0.1f, 0.25f}) {
        for (const float x : {d, 4.0f - d}) {
            for (const float z : {d, 2.0f, 4.0f - d}) near.push_back({{x, 0.001f, z}, {0, 1, 0}});
            near.push_back({{x, d, 0.001f}, {0, 0, 1}});
        }
    }
    return near;
}

/// How often each lamp is drawn at a place.
struct Draws {
    std::vector<double> share;    ///< of all samples
    std::vector<double> inverse;  ///< sum of 1 / pdf over all samples; 1 if pdf is the probability
    std::vector<double> error;    ///< standard error of `inverse`
};

/// With the `compute` tracer, as the shader that draws lights.
class LightChoiceTest : public RenderTest {
  protected:
    explicit LightChoiceTest(scene::Tracer tracer = scene::Tracer::Compute) : tracer_(tracer) {}

    scene::GpuScene onDevice(const scene::SceneData& data) { return {device(), data, {tracer_, {}}}; }

    void measure(scene::GpuScene& scene) {
        gpu::FrameGraph graph;
        graph.beginFrame();
        lightDistances(graph, scene);
        graph.execute(device());
        device().waitIdle();
        scene.setLightDistancesStale(false);
    }

    /// The distances beyond which lamps are almost surely hidden.
    std::vector<float> download(const scene::GpuScene& scene) {
        const std::vector<std::byte> bytes = device().download(scene.buffer("lightDistances"));
        std::vector<float> values(bytes.size() / sizeof(float));
        std::memcpy(values.data(), bytes.data(), bytes.size());
        for (float& value : values) {
            const auto both = std::bit_cast<uint32_t>(value);
            value = std::bit_cast<float>(both & 0xFFFF0000u);
            EXPECT_LE(std::bit_cast<float>(both << 16),
                      value);  // probably hidden before almost surely hidden
        }
        return values;
    }

    std::vector<float> mapsOf(const Scene& scene) {
        scene::GpuScene placed = onDevice(scene::buildSceneData(scene));
        measure(placed);
        return download(placed);
    }

    Draws draw(const Scene& scene, const scene::GpuScene& placed, const Place& at, bool byTree) {
        constexpr uint32_t count = 1u << 14;
        const LightsSampleParams params{placed.params(), at.position, at.normal, count, 7};
        const auto drawn = run<DrawnLight>({.shader = shaders::lights_sample_comp,
                                            .scene = &placed,
                                            .constants = {{"LIGHT_TREE", byTree ? 1u : 0u}},
                                            .params = gpu::paramsOf(params),
                                            .count = count},
                                           count);
        const size_t lamps = scene.lights.size();
        Draws result{std::vector<double>(lamps), std::vector<double>(lamps), std::vector<double>(lamps)};
        for (const DrawnLight& light : drawn) {
            if (!(light.pdf > 0.0f)) continue;
            const vec3 target = at.position + light.distance * light.direction;
            const auto lamp = std::ranges::find_if(scene.lights, [&](const PunctualLight& l) {
                return glm::distance(l.position, target) < 0.01f;
            });
            if (lamp == scene.lights.end()) throw Error("a sample is not of any lamp");
            const auto i = static_cast<size_t>(lamp - scene.lights.begin());
            const double inverse = 1.0 / double{light.pdf};
            result.share[i] += 1.0 / count;
            result.inverse[i] += inverse / count;
            result.error[i] += inverse * inverse / count;
        }
        for (size_t i = 0; i < lamps; ++i)
            result.error[i] = std::sqrt((result.error[i] - result.inverse[i] * result.inverse[i]) / count);
        return result;
    }

    /// The smallest quotient of a visible lamp's share of the samples and its share of the light, over all
    /// places.
    double leastQuotient(const Scene& scene, const scene::GpuScene& placed, bool byTree,
                         std::span<const Place> at) {
        double least = 1e9;
        for (const Place& place : at) {
            const Draws draws = draw(scene, placed, place, byTree);
            double light[dimLamps] = {}, sum = 0.0;
            for (size_t i = 0; i < dimLamps; ++i) {
                const vec3 way = scene.lights[i].position - place.position;
                const float distance = glm::length(way);
                const float cosine = std::max(glm::dot(way, place.normal) / distance, 0.0f);
                light[i] = double{scene.lights[i].intensity.r * cosine / (distance * distance)};
                sum += light[i];
            }
            for (size_t i = 0; i < dimLamps; ++i)
                if (light[i] > 0.0) least = std::min(least, draws.share[i] * sum / light[i]);
        }
        return least;
    }

  private:
    scene::Tracer tracer_;
};

class LightDistancesTest : public LightChoiceTest, public testing::WithParamInterface<scene::Tracer> {
  protected:
    LightDistancesTest() : LightChoiceTest(GetParam()) {}
    void SetUp() override {
        GpuTest::SetUp();
        requireTracer(GetParam());
    }
};

/// Distance from a point within the box to its surface.
double toBox(const dvec3& from, const dvec3& direction, const dvec3& a, const dvec3& b) {
    double nearest = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
        const double wall = direction[axis] > 0.0 ? b[axis] : a[axis];
        if (direction[axis] != 0.0) nearest = std::min(nearest, (wall - from[axis]) / direction[axis]);
    }
    return nearest;
}

/// Octahedral coordinates, -1 to 1, as a direction. The formula of Meyer et al. 2010, in double precision.
dvec3 fromOctahedral(double x, double y) {
    dvec3 n(x, y, 1.0 - std::abs(x) - std::abs(y));
    if (n.z < 0.0)
        n = {(1.0 - std::abs(y)) * (x >= 0.0 ? 1.0 : -1.0), (1.0 - std::abs(x)) * (y >= 0.0 ? 1.0 : -1.0),
             n.z};
    return glm::normalize(n);
}

/// In an empty box, the map is nowhere nearer than the walls (corners: 1 %), and nowhere farther than the
/// farthest wall in the directions of the texel and its neighbours, plus the margin.
TEST_P(LightDistancesTest, DistancesInABoxFollowTheFormula) {
    const dvec3 a(-1.0, -2.0, -1.5), b(3.0, 1.0, 2.5);
    Scene scene;
    addBox(scene, vec3(a), vec3(b));
    scene.lights = {lampAt({0.5f, -0.3f, 1.4f}, 1.0f), lampAt({2.5f, 0.5f, -1.0f}, 1.0f)};
    const std::vector<float> maps = mapsOf(scene);
    ASSERT_EQ(maps.size(), size_t{2} * side * side);
    constexpr uint32_t fine = 8;  // directions along a texel's side
    struct Seen {
        dvec3 direction;
        double distance;
    };
    for (size_t lamp = 0; lamp < 2; ++lamp) {
        const dvec3 from(scene.lights[lamp].position);
        std::vector<Seen> seen;
        for (uint32_t y = 0; y < side * fine; ++y) {
            for (uint32_t x = 0; x < side * fine; ++x) {
                const dvec3 d = fromOctahedral(2.0 * (x + 0.5) / (side * fine) - 1.0,
                                               2.0 * (y + 0.5) / (side * fine) - 1.0);
                const double distance = toBox(from, d, a, b);
                seen.push_back({d, distance});
                // A corner between the rays can be farther away than they and the margin tell.
                EXPECT_GE(double{maps[(lamp * side + y / fine) * side + x / fine]}, distance * 0.99);
            }
        }
        // The corner of a neighbour is at most this far from a texel's centre.
        const double reach = std::cos(0.4);
        for (uint32_t y = 0; y < side; ++y) {
            for (uint32_t x = 0; x < side; ++x) {
                const dvec3 centre =
                    fromOctahedral(2.0 * (x + 0.5) / side - 1.0, 2.0 * (y + 0.5) / side - 1.0);
                double farthest = 0.0;
                for (const Seen& s : seen)
                    if (glm::dot(s.direction, centre) > reach) farthest = std::max(farthest, s.distance);
                EXPECT_LE(double{maps[(lamp * side + y) * side + x]},
                          farthest * (1.0 + double{LIGHT_MAP_MARGIN_AROUND}) * 1.01);
            }
        }
    }
}

/// Nothing is hidden in directions in which rays leave the scene, nor by the maps of directional lights.
TEST_P(LightDistancesTest, NothingIsHiddenWhereRaysMeetNothing) {
    Scene scene;
    addBox(scene, vec3(-2.0f), vec3(2.0f), false);
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::Directional;
    scene.lights = {lampAt({0, 0, 0}, 1.0f), sun, lampAt({1, 0, 0}, 1.0f)};
    const std::vector<float> maps = mapsOf(scene);
    ASSERT_EQ(maps.size(), size_t{3} * side * side);
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
            const dvec3 d = fromOctahedral(2.0 * (x + 0.5) / side - 1.0, 2.0 * (y + 0.5) / side - 1.0);
            if (d.y > 0.75) {
                EXPECT_GE(maps[y * side + x], 1e30f);
            } else if (d.y < -0.4) {
                EXPECT_LT(maps[y * side + x], 4.0f);
            }
            EXPECT_GE(maps[(side + y) * side + x], 1e30f);
        }
    }
}

TEST_F(LightChoiceTest, AVisibleLampIsSampledDespiteManyHiddenOnes) {
    const Scene scene = house();
    scene::SceneData data = scene::buildSceneData(scene, {}, true);
    ASSERT_TRUE(data.features.lightDistances);
    scene::GpuScene mapped = onDevice(data);
    data.features.lightDistances = false;
    const scene::GpuScene plain = onDevice(data);
    EXPECT_EQ(plain.mappedLights(), 0u);
    measure(mapped);
    const std::vector<Place> corners = nearCorners();
    for (const bool byTree : {false, true}) {
        const double with = leastQuotient(scene, mapped, byTree, places),
                     without = leastQuotient(scene, plain, byTree, places),
                     cornered = leastQuotient(scene, mapped, byTree, corners);
        fmt::print("{}: at least {:.4f} of a visible lamp's share, {:.4f} in corners; without maps {:.4f}\n",
                   byTree ? "light tree" : "by power", with, cornered, without);
        EXPECT_GE(with, 0.3);
        EXPECT_GE(cornered, 0.1);
        EXPECT_LT(without, 0.1);
    }
}

/// Of every lamp in front of the surface, hidden or not, the samples' 1 / pdf must sum to 1.
TEST_F(LightChoiceTest, TheDensityIsTheProbability) {
    const Scene scene = house();
    scene::GpuScene mapped = onDevice(scene::buildSceneData(scene, {}, true));
    measure(mapped);
    for (const bool byTree : {false, true}) {
        size_t tested = 0;
        for (const Place& at : places) {
            const Draws draws = draw(scene, mapped, at, byTree);
            for (size_t i = 0; i < scene.lights.size(); ++i) {
                if (draws.share[i] * (1u << 14) < 10) continue;
                EXPECT_NEAR(draws.inverse[i], 1.0, 5.0 * draws.error[i]) << i;
                ++tested;
            }
        }
        EXPECT_GT(tested, 20u);
    }
}

TEST_P(LightDistancesTest, PicturesKeepTheirMeanAndLoseNoise) {
    constexpr gpu::Extent size{24, 16};
    constexpr uint32_t batches = 12, samples = 4;
    const Scene scene = house();
    scene::SceneData data = scene::buildSceneData(scene);
    double mean[2] = {}, variance[2] = {}, noise[2] = {};
    for (int with = 0; with < 2; ++with) {
        data.features.lightDistances = with == 1;
        scene::GpuScene placed = onDevice(data);
        RenderSettings settings;
        settings.extent = size;
        settings.pathtrace.maxDepth = 2;
        settings.samplesPerLaunch = samples;
        FrameRenderer renderer(device(), placed, settings, UINT64_MAX);
        const size_t pixels = size_t{size.width} * size.height;
        std::vector<double> sum(pixels), squares(pixels);
        for (uint32_t batch = 0; batch < batches; ++batch) {
            settings.seed = 2 * batch + static_cast<uint32_t>(with) + 1;
            renderer.setSettings(settings);
            renderer.begin({.camera = camera(scene, settings)});
            while (renderer.samplesInMean() < 2 * samples) renderer.launch();
            const RenderedLayers layers = renderer.download();
            double picture = 0.0;
            for (size_t i = 0; i < pixels; ++i) {
                const double value = double{layers.beauty[4 * i]};
                sum[i] += value / batches;
                squares[i] += value * value / batches;
                picture += value / static_cast<double>(pixels);
            }
            mean[with] += picture / batches;
            variance[with] += picture * picture / batches;
        }
        for (size_t i = 0; i < pixels; ++i)
            noise[with] += std::max(squares[i] - sum[i] * sum[i], 0.0) / static_cast<double>(pixels);
        variance[with] = std::max(variance[with] - mean[with] * mean[with], 0.0) / (batches - 1);
    }
    fmt::print(
        "means {:.5f} and {:.5f} with maps, standard error {:.5f}; variance {:.4f} of that without maps\n",
        mean[0], mean[1], std::sqrt(variance[0] + variance[1]), noise[1] / noise[0]);
    EXPECT_GT(mean[1], 0.0);
    EXPECT_NEAR(mean[0], mean[1], 4.0 * std::sqrt(variance[0] + variance[1]));
    EXPECT_LT(noise[1], 0.25 * noise[0]);
}

/// Whether frames measure again after something has moved, and only then.
TEST_P(LightDistancesTest, MovedLampsAndGeometryAreMeasuredAgain) {
    Scene scene;
    addBox(scene, vec3(-2.0f), vec3(2.0f));
    addBox(scene, vec3(-0.6f), vec3(0.6f));
    const int node = scene::addNode(scene, 1);
    scene.lights = {lampAt({1.0f, 1.0f, 1.0f}, 1.0f), lampAt({-1.0f, 0.0f, 0.0f}, 1.0f)};
    scene::addCamera(scene, {1.5f, 0.0f, 1.5f}, {0.0f, 0.0f, 0.0f}, 1.0f);
    using scene::AnimatedValue, scene::Interpolation;
    scene::addClip(
        scene,
        {"moving",
         {{node, AnimatedValue::Translation, Interpolation::Linear, 3, {0.0f, 1.0f}, {0, 0, 0, 0, 0, 3}}}});
    scene::prepare(scene);
    scene::chooseClip(scene, "");
    const scene::SceneData data = scene::buildSceneData(scene);
    scene::GpuScene placed = onDevice(data);
    scene::LiveLights live(scene, data);
    RenderSettings settings;
    settings.extent = {8, 8};
    settings.pathtrace.maxDepth = 1;
    FrameRenderer renderer(device(), placed, settings, 1);
    Moment moment{.camera = camera(scene, settings)};
    scene::SceneAnimator animator(scene, data);
    const auto mapsAfter = [&](const Moment& next) {
        renderer.render(next);
        EXPECT_FALSE(placed.lightDistancesStale());
        return download(placed);
    };
    const auto passes = [&] { return renderer.graph().passes().size(); };

    moment.scene = animator.frame(0.0, 0.0);
    const std::vector<float> start = mapsAfter(moment);
    moment.scene.reset();
    const size_t withMeasuring = passes();
    EXPECT_EQ(mapsAfter(moment), start);
    EXPECT_LT(passes(), withMeasuring);

    // The inner box stands between the second lamp and the wall at x = 2, and moves away.
    moment.scene = animator.frame(0.5, 0.0);
    const std::vector<float> moved = mapsAfter(moment);
    const auto towards = [](const std::vector<float>& maps, size_t lamp, uint32_t x, uint32_t y) {
        return maps[(lamp * side + y) * side + x];
    };
    // This texel is beside +X. The inner box is 0.4 away at first, then the wall 3.
    EXPECT_LT(towards(start, 1, side - 1, side / 2), 0.7f);
    EXPECT_NEAR(towards(moved, 1, side - 1, side / 2), 3.1f * (1.0f + LIGHT_MAP_MARGIN_AROUND), 0.6f);

    std::vector<scene::LightControl> before = scene::lightControlsOf(scene), after = before;
    after.at(0).position = {1.5f, -1.0f, 0.5f};
    scene::applyLightControls(scene, after, before);
    live.update(scene);
    moment.scene.emplace();
    moment.scene->params = placed.params();
    live.setParams(moment.scene->params);
    live.addTo(*moment.scene);
    const std::vector<float> relit = mapsAfter(moment);
    const dvec3 lamp(after.at(0).position);
    // The inner box is gone to z = 1.5 (half of the way) and hides none of the downward directions.
    for (uint32_t y = 0; y < side; ++y) {
        for (uint32_t x = 0; x < side; ++x) {
            const dvec3 d = fromOctahedral(2.0 * (x + 0.5) / side - 1.0, 2.0 * (y + 0.5) / side - 1.0);
            if (d.y < -0.3) {
                EXPECT_GE(double{towards(relit, 0, x, y)}, toBox(lamp, d, dvec3(-2.0), dvec3(2.0)) * 0.999);
            }
        }
    }
    EXPECT_TRUE(std::equal(relit.begin() + side * side, relit.end(), moved.begin() + side * side));
}

INSTANTIATE_TEST_SUITE_P(Tracers, LightDistancesTest,
                         testing::Values(scene::Tracer::Compute, scene::Tracer::Hardware),
                         [](const auto& listed) { return std::string(scene::toString(listed.param)); });

}  // namespace
}  // namespace limpid::test

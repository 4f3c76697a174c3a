// Compares the walk through the light tree on the device with the formula in double precision, with its own
// probabilities, and with what really arrives.
#include "scene/device/lights/light_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include "light_tree_walk.comp.h"
#include "tests/gpu/gpu_fixture.h"
#include "tests/reference/statistics.h"

namespace limpid::test {
namespace {

using glm::dvec3;
using scene::PunctualLight;
constexpr double pi64 = std::numbers::pi;

struct Query {
    vec3 position{0.0f}, normal{0.0f, 1.0f, 0.0f};
    float grazing = 0.0f;
    uint32_t bothSides = 0, child = 0, seed = 0;
    uvec4 trail{0u};
};

struct Answer {
    float weight, probability;
    uint32_t light;
    float chosenProbability;
    float left;  ///< of the number that has chosen
};

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float operator()(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(engine_);
    }
    vec3 point(float size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }
    vec3 direction() {
        vec3 d = point(1.0f);
        while (glm::length(d) > 1.0f || glm::length(d) < 0.1f) d = point(1.0f);
        return glm::normalize(d);
    }
    Query query() {
        const float kind = (*this)(0.0f, 1.0f);
        return {.position = point(8.0f),
                .normal = direction(),
                .grazing = kind < 0.1f ? 0.1f : 0.0f,
                .bothSides = kind > 0.9f ? 1u : 0u};
    }

  private:
    std::mt19937 engine_;
};

/// `triangles` small emissive ones of different strength, and lamps: points, and spots of 1 to 80 degrees.
scene::Scene randomScene(uint32_t triangles, uint32_t lamps, uint32_t seed) {
    Random random(seed);
    scene::Scene scene;
    scene.materials.emplace_back();
    for (uint32_t i = 0; i < triangles; ++i) {
        scene::Material material;
        material.emission = vec3(random(0.1f, 1.0f), random(0.1f, 1.0f), random(0.1f, 20.0f));
        material.doubleSided = i % 5 == 0;
        scene::Mesh mesh;
        const vec3 v = random.point(8.0f);
        mesh.positions = {v, v + random.point(0.7f), v + random.point(0.7f)};
        mesh.indices = {0, 1, 2};
        scene::Instance instance;
        instance.mesh = static_cast<int>(scene.meshes.size());
        instance.material = static_cast<int>(scene.materials.size());
        scene.materials.push_back(material);
        scene.meshes.push_back(std::move(mesh));
        scene.instances.push_back(std::move(instance));
    }
    for (uint32_t i = 0; i < lamps; ++i) {
        PunctualLight lamp;
        lamp.position = random.point(8.0f);
        lamp.intensity = vec3(random(0.0f, 30.0f));
        if (i % 4 == 1) lamp.range = random(2.0f, 9.0f);
        if (i % 2 == 1) {
            lamp.kind = PunctualLight::Kind::Spot;
            lamp.direction = random.direction();
            lamp.outerCone = random(0.02f, 1.4f);
            lamp.innerCone = random(0.0f, 0.98f) * lamp.outerCone;
        }
        scene.lights.push_back(lamp);
    }
    return scene;
}

/// A child as the texels describe it.
struct Packed {
    dvec3 center{0.0}, axis{0.0};
    double radius = 0.0, range = 0.0, first = 0.0, second = 0.0, intensity = 0.0;
    uint32_t link = 0;

    bool is(uint32_t flag) const { return (link & flag) != 0; }
    uint32_t index() const { return link & layout::LIGHT_LINK_INDEX; }
};

double snorm(uint32_t word) {
    return std::max(static_cast<double>(static_cast<int16_t>(word)) / 32767.0, -1.0);
}

Packed unpack(const std::vector<uvec4>& texels, uint32_t child) {
    const uvec4 place = texels[size_t{child} * layout::LIGHT_CHILD_TEXELS],
                effect = texels[size_t{child} * layout::LIGHT_CHILD_TEXELS + 1];
    Packed p;
    const auto value = [](uint32_t word) { return double{std::bit_cast<float>(word)}; };
    p.center = {value(place.x), value(place.y), value(place.z)};
    p.radius = value(place.w & 0xFFFF0000u);
    p.range = value(place.w << 16);
    dvec3 n(snorm(effect.x & 0xFFFFu), snorm(effect.x >> 16), 0.0);
    n.z = 1.0 - std::abs(n.x) - std::abs(n.y);
    const double fold = std::max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -fold : fold;
    n.y += n.y >= 0.0 ? -fold : fold;
    p.axis = glm::normalize(n);
    p.first = 2.0 * std::asin((effect.y & 0xFFFFu) / 65535.0);
    p.second = 2.0 * std::asin((effect.y >> 16) / 65535.0);
    p.intensity = value(effect.z);
    p.link = effect.w;
    return p;
}

double angleBetween(const dvec3& a, const dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The formula of light_bounds.h and light_tree.glsl, by angles.
double weightOf(const Packed& p, const Query& q) {
    const dvec3 way = p.center - dvec3(q.position), normal(q.normal);
    const double distance = glm::length(way);
    const double around = distance > p.radius ? std::asin(p.radius / distance) : pi64;
    double off = angleBetween(p.axis, -way);
    if (p.is(layout::LIGHT_LINK_TWO_SIDED)) off = std::min(off, pi64 - off);
    double share = 0.0;
    if (p.is(layout::LIGHT_LINK_SPOT)) {
        const double inner = std::cos(p.first), outer = std::cos(p.second);
        const double ramp = (std::cos(off) - outer) / std::max(0.001, inner - outer);
        share = std::pow(std::clamp(ramp, 0.0, 1.0), 2.0);
    } else {
        const double beyond = std::max(std::max(off - p.first, 0.0) - around, 0.0);
        if (beyond < p.second) share = (std::cos(beyond) - std::cos(p.second)) / (1.0 - std::cos(p.second));
    }
    double incidence = angleBetween(normal, way);
    if (q.bothSides != 0) incidence = std::min(incidence, pi64 - incidence);
    const double least = q.bothSides != 0 ? 0.01 : double{q.grazing};
    const double usable = std::max({std::cos(std::max(incidence - around, 0.0)) + 1e-4, least, 0.0});
    const double beyondRange = std::pow(std::max(distance - p.radius, 0.0) / p.range, 4.0);
    share *= std::max(1.0 - beyondRange, 0.0) * usable;
    return p.intensity * share / std::max(distance * distance, p.radius * p.radius);
}

class LightTreeTest : public GpuTest {
  protected:
    void load(const scene::Scene& scene) {
        data_ = scene::buildSceneData(scene, {}, true);
        gpuScene_.emplace(device(), data_);
        trails_.assign(data_.lights.size() / layout::LIGHT_TEXELS, uvec4(0u));
        childCount_ = 0;
        findTrails(0, uvec4(0u), 0);
    }
    std::vector<Answer> ask(const std::vector<Query>& queries) {
        const auto count = static_cast<uint32_t>(queries.size());
        const gpu::Buffer buffer = upload("queries", queries);
        return run<Answer>({.shader = shaders::light_tree_walk_comp,
                            .scene = &*gpuScene_,
                            .buffers = {{"queries", &buffer}},
                            .params = gpu::paramsOf(count),
                            .count = count},
                           count);
    }
    std::vector<double> weightsAt(Query point) {
        std::vector<Query> queries(childCount_, point);
        for (uint32_t i = 0; i < childCount_; ++i) queries[i].child = i;
        std::vector<double> weights;
        for (const Answer& answer : ask(queries)) weights.push_back(double{answer.weight});
        return weights;
    }
    std::vector<double> probabilitiesAt(Query point) {
        std::vector<Query> queries(trails_.size(), point);
        for (size_t i = 0; i < trails_.size(); ++i) queries[i].trail = trails_[i];
        std::vector<double> probabilities;
        for (const Answer& answer : ask(queries)) probabilities.push_back(double{answer.probability});
        return probabilities;
    }
    Packed child(uint32_t index) const { return unpack(data_.lightTree, index); }

    /// Of the choices at the root, as docs/lighting.md says.
    double uniformShare(double reaching) const {
        if (!data_.features.lightDistances) return std::min(0.2, 0.8 / reaching);
        return std::min(std::max(0.8 / reaching, 15.0 / (reaching * reaching)), 0.42);
    }

    /// Adds the probabilities of lights below the node that starts at `first`, from the weights of children.
    /// Returns the probability that the walk ends there without a light.
    double addShares(const std::vector<double>& weights, uint32_t first, double probability,
                     std::vector<double>& ofLights) const {
        double sum = 0.0, lost = 0.0, reaching = 0.0;
        uint32_t end = first;
        do {
            sum += weights[end];
            reaching += weights[end] > 0.0 ? 1.0 : 0.0;
        } while (!child(end++).is(layout::LIGHT_LINK_LAST));
        if (sum == 0.0) return probability;
        const double uniformly = first == 0 ? uniformShare(reaching) : 0.0;
        for (uint32_t i = first; i < end; ++i) {
            if (weights[i] == 0.0) continue;
            const double share = probability * ((1.0 - uniformly) * weights[i] / sum + uniformly / reaching);
            if (child(i).is(layout::LIGHT_LINK_LEAF)) {
                ofLights[child(i).index()] = share;
            } else {
                lost += addShares(weights, child(i).index(), share, ofLights);
            }
        }
        return lost;
    }

    scene::SceneData data_;
    std::optional<scene::GpuScene> gpuScene_;
    std::vector<uvec4> trails_;  ///< of the lights
    uint32_t childCount_ = 0;

  private:
    void findTrails(uint32_t first, const uvec4& before, uint32_t depth) {
        for (uint32_t step = 0;; ++step) {
            const Packed p = child(first + step);
            childCount_ = std::max(childCount_, first + step + 1);
            uvec4 trail = before;
            const uint32_t at0 =
                depth == 0 ? 0 : layout::LIGHT_TRAIL_ROOT_BITS + (depth - 1) * layout::LIGHT_TRAIL_BITS;
            const uint32_t count = depth == 0 ? layout::LIGHT_TRAIL_ROOT_BITS : layout::LIGHT_TRAIL_BITS;
            for (uint32_t bit = 0; bit < count; ++bit) {
                const uint32_t at = at0 + bit;
                trail[static_cast<int>(at / 32)] |= (step >> bit & 1u) << at % 32;
            }
            if (p.is(layout::LIGHT_LINK_LEAF)) {
                trails_[p.index()] = trail;
            } else {
                findTrails(p.index(), trail, depth + 1);
            }
            if (p.is(layout::LIGHT_LINK_LAST)) return;
        }
    }
};

TEST_F(LightTreeTest, WeightsAreTheFormula) {
    load(randomScene(300, 200, 1));
    Random random(2);
    std::vector<Query> queries;
    for (uint32_t i = 0; i < 20000; ++i) {
        queries.push_back(random.query());
        queries.back().child = i % childCount_;
        // Near the light, where bounds matter.
        if (i % 3 == 0) queries.back().position = vec3(child(i % childCount_).center) + random.point(1.0f);
    }
    const std::vector<Answer> answers = ask(queries);
    double worst = 0.0;
    uint32_t zeros = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const Packed p = child(queries[i].child);
        const double expected = weightOf(p, queries[i]), found = double{answers[i].weight};
        const double distance = glm::length(p.center - dvec3(queries[i].position));
        const double brightest = p.intensity / std::max(distance * distance, p.radius * p.radius);
        zeros += expected == 0.0;
        // A narrow spot's ramp divides a rounded difference of cosines.
        const double steep = p.is(layout::LIGHT_LINK_SPOT)
                                 ? 1.0 / std::max(0.001, std::cos(p.first) - std::cos(p.second))
                                 : 50.0;
        const double error = std::abs(found - expected) / (expected + brightest * steep * 1e-3);
        worst = std::max(worst, error);
        ASSERT_LT(error, 2e-3) << "query " << i << ": " << found << " instead of " << expected;
    }
    fmt::print("weights are off by up to {:.2g}; {} of {} are 0\n", worst, zeros, queries.size());
    EXPECT_GT(zeros, queries.size() / 10);
    EXPECT_LT(zeros, queries.size() / 2);
}

/// The probabilities of all lights and of the walk's end without a light add up to 1.
TEST_F(LightTreeTest, ProbabilitiesAreSharesOfTheWeights) {
    load(randomScene(300, 200, 3));
    Random random(4);
    double lostOfAll = 0.0;
    for (int i = 0; i < 40; ++i) {
        const Query point = random.query();
        std::vector<double> expected(trails_.size(), 0.0);
        const double lost = addShares(weightsAt(point), 0, 1.0, expected);
        const std::vector<double> found = probabilitiesAt(point);
        double sum = lost;
        for (size_t light = 0; light < found.size(); ++light) {
            sum += found[light];
            ASSERT_NEAR(found[light], expected[light], 1e-5 * expected[light] + 1e-9) << light;
        }
        EXPECT_NEAR(sum, 1.0, 1e-5);
        lostOfAll += lost / 40;
    }
    fmt::print("{:.2f} % of the walks end without a light\n", 100.0 * lostOfAll);
    EXPECT_LT(lostOfAll, 0.25);
}

/// And what is left of the number that has chosen is uniform for each light.
TEST_F(LightTreeTest, LightsAreChosenWithTheirProbabilities) {
    load(randomScene(60, 40, 5));
    constexpr uint32_t walks = 1u << 18, parts = 4;
    Random random(6);
    for (uint32_t round = 0; round < 3; ++round) {
        Query point = random.query();
        const std::vector<double> probabilities = probabilitiesAt(point);
        point.seed = round;
        std::vector<double> observed(trails_.size() * parts + 1, 0.0), expected;
        for (const double p : probabilities) expected.insert(expected.end(), parts, p * walks / parts);
        double sum = 0.0;
        for (const double p : probabilities) sum += p;
        expected.push_back(std::max(1.0 - sum, 0.0) * walks);
        for (const Answer& answer : ask(std::vector<Query>(walks, point))) {
            const bool none = answer.chosenProbability == 0.0f;
            ASSERT_TRUE(none || (answer.left >= 0.0f && answer.left < 1.0f)) << answer.left;
            ++observed[none ? observed.size() - 1
                            : answer.light * parts + static_cast<uint32_t>(answer.left * parts)];
            if (none) continue;
            ASSERT_NEAR(double{answer.chosenProbability} / probabilities[answer.light], 1.0, 1e-5)
                << "light " << answer.light << ", probability " << probabilities[answer.light];
        }
        const ChiSquare result = chiSquare(observed, expected);
        EXPECT_FALSE(result.impossible);
        EXPECT_GT(result.p, 1e-4) << result.worst;
        fmt::print("{} bins, chi-square {:.1f}, p {:.3f}\n", result.degreesOfFreedom + 1, result.statistic,
                   result.p);
    }
}

/// Returns what a lamp sends to a diffuse surface, by the extension's formula.
double irradianceOf(const PunctualLight& lamp, const Query& at) {
    const dvec3 way = dvec3(lamp.position) - dvec3(at.position);
    const double distance = glm::length(way), cosine = glm::dot(way, dvec3(at.normal)) / distance;
    double result = double{lamp.intensity.r} * std::max(at.bothSides != 0 ? std::abs(cosine) : cosine, 0.0) /
                    (distance * distance);
    if (lamp.range > 0.0f) result *= std::clamp(1.0 - std::pow(distance / double{lamp.range}, 4.0), 0.0, 1.0);
    if (lamp.kind == PunctualLight::Kind::Spot) {
        const double inner = std::cos(double{lamp.innerCone}), outer = std::cos(double{lamp.outerCone});
        const double off = glm::dot(dvec3(lamp.direction), -way / distance);
        result *= std::pow(std::clamp((off - outer) / std::max(inner - outer, 0.001), 0.0, 1.0), 2.0);
    }
    return result;
}

TEST_F(LightTreeTest, NoLightThatReachesAPointIsNeverChosen) {
    const scene::Scene scene = randomScene(200, 100, 7);
    load(scene);
    Random random(8);
    uint32_t reaching = 0, faint = 0;
    for (int i = 0; i < 60; ++i) {
        const Query point = random.query();
        const std::vector<double> probabilities = probabilitiesAt(point);
        for (size_t light = 0; light < 200; ++light) {
            const std::vector<vec3>& v = scene.meshes[light].positions;
            const dvec3 normal = glm::cross(dvec3(v[1]) - dvec3(v[0]), dvec3(v[2]) - dvec3(v[0]));
            bool reaches = false;
            for (int k = 0; k < 30; ++k) {
                // Corners first: there the light that is seen at the smallest angle comes from.
                const float u = k < 3 ? static_cast<float>(k == 1) : random(0.0f, 1.0f);
                const float w = k < 3 ? static_cast<float>(k == 2) : random(0.0f, 1.0f - u);
                const dvec3 way = dvec3(v[0] + u * (v[1] - v[0]) + w * (v[2] - v[0])) - dvec3(point.position);
                const bool front = light % 5 == 0 || glm::dot(normal, way) < 0.0;
                reaches =
                    reaches || (front && (point.bothSides != 0 || glm::dot(way, dvec3(point.normal)) > 0.0));
            }
            reaching += reaches;
            if (reaches) {
                ASSERT_GT(probabilities[light], 0.0) << "triangle " << light << ", point " << i;
            }
        }
        for (size_t lamp = 0; lamp < scene.lights.size(); ++lamp) {
            const double irradiance = irradianceOf(scene.lights[lamp], point);
            faint += irradiance > 0.0 && irradiance < 1e-6;
            if (irradiance > 0.0) {
                ASSERT_GT(probabilities[200 + lamp], 0.0) << "lamp " << lamp << ", point " << i;
            }
        }
    }
    fmt::print("{} triangles reach their point; {} lamps send less than 1e-6\n", reaching, faint);
    EXPECT_GT(reaching, 1000u);
}

/// Spots of a stage: narrow and wide ones, whose intensities differ by a factor of 10,000, above a floor and
/// a step.
scene::Scene stage() {
    Random random(9);
    scene::Scene scene = randomScene(1, 0, 10);
    for (int i = 0; i < 48; ++i) {
        PunctualLight lamp;
        lamp.kind = PunctualLight::Kind::Spot;
        lamp.position = {random(-6.0f, 6.0f), random(3.0f, 5.0f), random(-6.0f, 6.0f)};
        const vec3 target(random(-6.0f, 6.0f), 0.0f, random(-6.0f, 6.0f));
        lamp.direction = glm::normalize(target - lamp.position);
        lamp.outerCone = random(0.02f, 0.5f);
        lamp.innerCone = random(0.1f, 0.95f) * lamp.outerCone;
        lamp.intensity = vec3(std::pow(10.0f, random(-1.0f, 3.0f)));
        scene.lights.push_back(lamp);
    }
    return scene;
}

TEST_F(LightTreeTest, SpotsAreChosenByWhatTheySendToTheFloor) {
    const scene::Scene scene = stage();
    load(scene);
    Random random(11);
    double least = 1e9, meanLost = 0.0;
    uint32_t lit = 0;
    for (int i = 0; i < 200; ++i) {
        const Query point{.position = {random(-6.0f, 6.0f), i % 4 == 0 ? 0.8f : 0.0f, random(-6.0f, 6.0f)}};
        const std::vector<double> probabilities = probabilitiesAt(point);
        double all = 0.0, chosen = 0.0;
        for (const PunctualLight& lamp : scene.lights) all += irradianceOf(lamp, point);
        for (const double p : probabilities) chosen += p;
        if (all == 0.0) continue;
        ++lit;
        meanLost += 1.0 - chosen;
        for (size_t lamp = 0; lamp < scene.lights.size(); ++lamp) {
            const double share = irradianceOf(scene.lights[lamp], point) / all;
            if (share > 1e-6) least = std::min(least, probabilities[1 + lamp] / share);
            EXPECT_GE(probabilities[1 + lamp], 0.1 * share) << "lamp " << lamp << ", point " << i;
        }
    }
    fmt::print("{} lit points: least probability over share {:.3f}, {:.1f} % of the walks lost\n", lit, least,
               100.0 * meanLost / lit);
    EXPECT_GT(lit, 50u);
}

}  // namespace
}  // namespace limpid::test

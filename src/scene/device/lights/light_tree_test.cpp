#include "scene/device/lights/light_tree.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <random>
#include <set>

namespace limpid::scene {
namespace {

using glm::dvec3;

class Random {
  public:
    explicit Random(uint32_t seed) : engine_(seed) {}
    float operator()(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(engine_);
    }
    vec3 point(float size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }

  private:
    std::mt19937 engine_;
};

LightBounds randomLight(Random& random) {
    const float kind = random(0.0f, 1.0f);
    if (kind < 0.6f) {
        const vec3 v = random.point(10.0f);
        return triangleLightBounds({v, v + random.point(1.0f), v + random.point(1.0f)}, random(0.1f, 9.0f),
                                   random(0.0f, 1.0f) < 0.2f);
    }
    PunctualLight light;
    light.position = random.point(10.0f);
    light.intensity = vec3(random(0.0f, 100.0f));
    if (random(0.0f, 1.0f) < 0.3f) light.range = random(1.0f, 5.0f);
    if (kind < 0.8f) {
        light.kind = PunctualLight::Kind::Spot;
        light.direction = glm::normalize(random.point(1.0f));
        light.outerCone = random(0.01f, 1.5f);
        light.innerCone = random(0.0f, 0.99f) * light.outerCone;
    }
    return punctualLightBounds(light);
}

std::vector<LightBounds> randomLights(size_t count, uint32_t seed) {
    Random random(seed);
    std::vector<LightBounds> lights;
    for (size_t i = 0; i < count; ++i) lights.push_back(randomLight(random));
    return lights;
}

double angleBetween(const vec3& a, const vec3& b) {
    const dvec3 x(a), y(b);
    return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y));
}

/// Returns the number of a child that a trail names at a depth.
uint32_t stepOf(const uvec4& trail, uint32_t depth) {
    const uint32_t root = layout::LIGHT_TRAIL_ROOT_BITS, inner = layout::LIGHT_TRAIL_BITS;
    const uint32_t first = depth == 0 ? 0 : root + (depth - 1) * inner, count = depth == 0 ? root : inner;
    uint32_t step = 0;
    for (uint32_t bit = 0; bit < count; ++bit) {
        const uint32_t at = first + bit;
        step |= (trail[static_cast<int>(at / 32)] >> at % 32 & 1u) << bit;
    }
    return step;
}

/// Follows all trails: each must end at its light, and together they must visit all children.
void expectTrailsToEveryLight(const LightTree& tree) {
    std::set<uint32_t> visited;
    for (uint32_t light = 0; light < tree.lightCount(); ++light) {
        uint32_t first = 0;
        for (uint32_t depth = 0;; ++depth) {
            ASSERT_LT(depth, LightTree::maxDepth) << light;
            const uint32_t at = first + stepOf(tree.trail(light), depth);
            ASSERT_LT(at, tree.children().size()) << light;
            for (uint32_t i = first; i < at; ++i) ASSERT_FALSE(tree.children()[i].last) << light;
            visited.insert(at);
            const LightTree::Child& child = tree.children()[at];
            if (child.isLight) {
                ASSERT_EQ(child.index, light);
                break;
            }
            ASSERT_GT(child.index, at) << "children come after their node";
            first = child.index;
        }
    }
    EXPECT_EQ(visited.size(), tree.children().size());
    EXPECT_LE(tree.children().size() * layout::LIGHT_CHILD_TEXELS, lightTreeTexels(tree.lightCount()));
}

void expectContains(const LightBounds& whole, const LightBounds& part) {
    const double away = glm::length(dvec3(part.center) - dvec3(whole.center));
    EXPECT_LE(away + double{part.radius}, double{whole.radius} * (1.0 + 1e-6));
    if (whole.spread < pi) {
        EXPECT_LE(angleBetween(whole.axis, part.axis) + double{part.spread}, double{whole.spread} + 2e-5);
    }
    EXPECT_LE(part.falloff, whole.falloff);
    EXPECT_LE(part.range, whole.range);
    EXPECT_LE(part.twoSided, whole.twoSided);
}

/// Every node contains its children and has their intensity.
void expectNodesToContainChildren(const LightTree& tree) {
    const std::vector<LightTree::Child>& children = tree.children();
    for (const LightTree::Child& node : children) {
        if (node.isLight) continue;
        double intensity = 0.0;
        uint32_t at = node.index;
        do {
            intensity += double{children[at].bounds.intensity};
            if (children[at].bounds.intensity > 0.0f) expectContains(node.bounds, children[at].bounds);
        } while (!children[at++].last);
        EXPECT_NEAR(double{node.bounds.intensity} / std::max(intensity, 1e-30), 1.0, 1e-4);
    }
}

TEST(LightTree, HasEveryLightOnce) {
    for (const size_t count : {1, 2, 3, 8, 9, 100, 3000}) {
        const size_t firstLamp = count == 100 ? 60 : count;
        const LightTree tree(randomLights(count, static_cast<uint32_t>(count)), firstLamp);
        EXPECT_EQ(tree.lightCount(), count);
        expectTrailsToEveryLight(tree);
        expectNodesToContainChildren(tree);
    }
    EXPECT_TRUE(LightTree({}, 0).children().empty());
}

/// Lights in one place, and lights whose distances double, of which each split separates one.
TEST(LightTree, IsNeverTooDeep) {
    std::vector<LightBounds> same(1000), doubling;
    for (LightBounds& light : same) light.intensity = 1.0f;
    for (int i = 0; i < 120; ++i) {
        doubling.emplace_back();
        doubling.back().center.x = std::ldexp(1.0f, i - 60);
        doubling.back().intensity = 1.0f;
    }
    expectTrailsToEveryLight(LightTree(same, same.size()));
    expectTrailsToEveryLight(LightTree(doubling, doubling.size()));
    for (LightBounds& light : same) light.intensity = 0.0f;
    expectTrailsToEveryLight(LightTree(same, same.size()));
}

TEST(LightTree, RefittedNodesContainMovedLights) {
    const std::vector<LightBounds> before = randomLights(500, 3), after = randomLights(500, 4);
    LightTree tree(before, 450);
    const std::vector<LightTree::Child> old = tree.children();
    for (uint32_t light = 0; light < 500; light += 7) tree.setLight(light, after[light]);
    const std::vector<uint32_t> changed = tree.refit();
    expectNodesToContainChildren(tree);
    for (uint32_t i = 0; i < old.size(); ++i) {
        const LightTree::Child &a = old[i], &b = tree.children()[i];
        const bool same = a.bounds.center == b.bounds.center && a.bounds.radius == b.bounds.radius &&
                          a.bounds.intensity == b.bounds.intensity;
        EXPECT_TRUE(same || std::ranges::binary_search(changed, i)) << i;
    }
    EXPECT_LT(changed.size(), old.size());
    EXPECT_TRUE(tree.refit().empty());
}

/// What shaders read contains the bounds from which it was packed, and hardly more.
TEST(LightTree, PackedBoundsContainTheExactOnes) {
    for (const LightBounds& light : randomLights(2000, 5)) {
        std::vector<uvec4> texels(layout::LIGHT_CHILD_TEXELS);
        packLightChild({light, 7, 0, true, true}, texels);
        const float radius = std::bit_cast<float>(texels[0].w & 0xFFFF0000u),
                    range = std::bit_cast<float>(texels[0].w << 16);
        EXPECT_GE(radius, light.radius);
        EXPECT_LE(radius, light.radius * 1.01f);
        EXPECT_GE(range, light.range);
        const auto angle = [](uint32_t packed) { return 2.0 * std::asin(packed / 65535.0); };
        const double spread = angle(texels[1].y & 0xFFFFu), other = angle(texels[1].y >> 16);
        EXPECT_GE(spread, double{light.spread} - 1e-6);
        EXPECT_LE(spread, double{light.spread} + 0.01);
        EXPECT_GE(light.spot ? other - double{light.spread} : other, double{light.falloff} - 1e-6);
        EXPECT_EQ(texels[1].w & layout::LIGHT_LINK_INDEX, 7u);
    }
}

/// Times are printed, and not tested.
TEST(LightTree, HoldsManyLights) {
    const std::vector<LightBounds> lights = randomLights(100'000, 6);
    const auto seconds = [](auto start) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const auto start = std::chrono::steady_clock::now();
    LightTree tree(lights, lights.size());
    const double built = seconds(start);
    for (uint32_t light = 0; light < tree.lightCount(); ++light) tree.setLight(light, lights[light]);
    const auto startRefit = std::chrono::steady_clock::now();
    tree.refit();
    const double refitted = seconds(startRefit);
    fmt::print("100,000 lights: built in {:.1f} ms, all refitted in {:.1f} ms\n", 1e3 * built,
               1e3 * refitted);
    expectTrailsToEveryLight(tree);
}

}  // namespace
}  // namespace limpid::scene

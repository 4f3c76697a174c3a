#include "scene/builtin/random_still_life.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene {
namespace {

constexpr uint32_t seeds = 40;

TEST(RandomStillLife, IsTheSameForTheSameSeed) {
    for (const uint32_t seed : {0u, 1u, 4000000000u}) {
        const Scene a = randomStillLife(seed), b = randomStillLife(seed);
        ASSERT_EQ(a.meshes.size(), b.meshes.size());
        for (size_t i = 0; i < a.meshes.size(); ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
        for (size_t i = 0; i < a.instances.size(); ++i)
            EXPECT_EQ(a.instances[i].transform, b.instances[i].transform);
        for (size_t i = 0; i < a.textures.size(); ++i) EXPECT_EQ(a.textures[i].rgba, b.textures[i].rgba);
    }
}

void expectThingsBeforeTheCamera(const Scene& scene) {
    const Camera& camera = scene.cameras.at(0);
    const vec3 eye(camera.toWorld[3]), forward = -vec3(camera.toWorld[2]);
    for (const Instance& instance : scene.instances) {
        if (instance.name == "support") continue;
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        vec3 lower(1e9f), upper(-1e9f);
        for (const vec3& p : mesh.positions) {
            const vec3 world(instance.transform * vec4(p, 1.0f));
            lower = glm::min(lower, world);
            upper = glm::max(upper, world);
        }
        EXPECT_FALSE(glm::all(glm::greaterThan(eye, lower)) && glm::all(glm::lessThan(eye, upper)))
            << "the camera stands in a " << instance.name;
        EXPECT_GT(glm::dot(0.5f * (lower + upper) - eye, forward), 0.0f)
            << "behind the camera: a " << instance.name;
    }
}

TEST(RandomStillLife, ManySeedsAreUnalikeLitAndSeen) {
    std::set<float> heights;
    int standing = 0, skies = 0, dark = 0;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        SCOPED_TRACE(seed);
        Scene scene = randomStillLife(seed);
        heights.insert(scene.cameras.at(0).toWorld[3].y);
        standing += scene.meshes.front().name == "support" ? 1 : 0;
        skies += scene.environment.width == 64 ? 1 : 0;
        dark += scene.environment.empty() ? 1 : 0;
        const bool glows =
            std::ranges::any_of(scene.materials, [](const Material& m) { return m.emission.x > 0.0f; });
        EXPECT_TRUE(glows || !scene.environment.empty() || !scene.lights.empty());
        ASSERT_NO_THROW(prepare(scene));
        expectThingsBeforeTheCamera(scene);
    }
    EXPECT_EQ(heights.size(), seeds);
    for (const int count : {standing, skies, dark}) {
        EXPECT_GT(count, 1);
        EXPECT_LT(count, static_cast<int>(seeds) - 4);
    }
}

TEST(RandomStillLife, HasANameAmongTheBuiltInScenes) {
    EXPECT_EQ(builtinScene("still-life-17").name, "still-life-17");
    for (const char* wrong : {"still-life-", "still-life--1", "still-life-4294967296", "still-life"})
        EXPECT_THROW(builtinScene(wrong), UsageError) << wrong;
}

}  // namespace
}  // namespace limpid::scene

#include "scene/builtin/random_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene {
namespace {

constexpr uint32_t rooms = 20;

struct Bounds {
    vec3 lower{1e9f}, upper{-1e9f};
};

Bounds boundsOf(const Mesh& mesh) {
    Bounds bounds;
    for (const vec3& p : mesh.positions) {
        bounds.lower = glm::min(bounds.lower, p);
        bounds.upper = glm::max(bounds.upper, p);
    }
    return bounds;
}

TEST(RandomRoom, IsTheSameForTheSameSeed) {
    for (const uint32_t seed : {0u, 1u, 4000000000u}) {
        const Scene a = randomRoom(seed), b = randomRoom(seed);
        ASSERT_EQ(a.meshes.size(), b.meshes.size());
        for (size_t i = 0; i < a.meshes.size(); ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions);
        for (size_t i = 0; i < a.materials.size(); ++i)
            EXPECT_EQ(a.materials[i].baseColor, b.materials[i].baseColor);
    }
}

void expectAllInside(const Scene& scene) {
    const Bounds room = boundsOf(scene.meshes[0]);
    const vec3 eye(scene.cameras.at(0).toWorld[3]);
    EXPECT_TRUE(glm::all(glm::greaterThan(eye, room.lower + 0.1f)));
    EXPECT_TRUE(glm::all(glm::lessThan(eye, room.upper - 0.1f)));
    for (size_t i = 1; i < scene.meshes.size(); ++i) {
        const Bounds thing = boundsOf(scene.meshes[i]);
        EXPECT_TRUE(glm::all(glm::greaterThan(thing.lower, room.lower - 0.01f))) << scene.meshes[i].name;
        EXPECT_TRUE(glm::all(glm::lessThan(thing.upper, room.upper + 0.01f))) << scene.meshes[i].name;
        if (scene.meshes[i].name == "lamp") continue;
        const bool around =
            glm::all(glm::greaterThan(eye, thing.lower)) && glm::all(glm::lessThan(eye, thing.upper));
        EXPECT_FALSE(around) << "the camera stands in a " << scene.meshes[i].name;
    }
}

/// Consecutive seeds give rooms that are not alike, hold all that is in them, and are lit.
TEST(RandomRoom, ManySeedsAreUnalikeWholeAndLit) {
    int left = 0, many = 0, skies = 0;
    std::set<float> widths;
    for (uint32_t seed = 0; seed < rooms; ++seed) {
        SCOPED_TRACE(seed);
        Scene scene = randomRoom(seed);
        widths.insert(boundsOf(scene.meshes[0]).upper.x);
        left += boundsOf(scene.meshes[0]).upper.x < 3.0f ? 1 : 0;
        many += scene.instances.size() > 18 ? 1 : 0;
        expectAllInside(scene);
        const bool glows =
            std::ranges::any_of(scene.materials, [](const Material& m) { return m.emission.x > 0.0f; });
        EXPECT_TRUE(glows || !scene.environment.empty());
        skies += scene.environment.empty() ? 0 : 1;
        EXPECT_NO_THROW(prepare(scene));
    }
    EXPECT_EQ(widths.size(), rooms);
    EXPECT_GT(left, 3);
    EXPECT_LT(left, 17);
    EXPECT_GT(many, 1);
    EXPECT_LT(many, 19);
    EXPECT_GT(skies, 1);
    EXPECT_LT(skies, 15);
}

TEST(RandomRoom, HasANameAmongTheBuiltInScenes) {
    EXPECT_EQ(builtinScene("room-17").name, "room-17");
    EXPECT_EQ(builtinScene("room-4294967295").name, "room-4294967295");
    for (const char* wrong : {"room-", "room--1", "room-1x", "room-4294967296", "room"})
        EXPECT_THROW(builtinScene(wrong), UsageError) << wrong;
}

}  // namespace
}  // namespace limpid::scene

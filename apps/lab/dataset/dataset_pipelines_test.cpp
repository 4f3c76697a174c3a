// Tests that random clips need few pipelines.
#include "lab/dataset/dataset_pipelines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "lab/dataset/dataset_motion.h"
#include "lab/dataset/dataset_night.h"
#include "scene/builtin/random_room.h"
#include "scene/builtin/random_still_life.h"

namespace limpid::cli {
namespace {

scene::SceneData dataOf(uint32_t seed) {
    scene::Scene scene = seed % 2 == 0 ? scene::randomRoom(seed) : scene::randomStillLife(seed);
    if (seed % 5 == 0) makeNight(scene, seed);
    if (seed % 3 == 0)
        addMotion(scene, seed, {}, {1, 5});
    else
        addStillClip(scene);
    return scene::buildSceneData(scene);
}

/// Specialisation constants that differ between scenes.
using Kind = std::pair<scene::SceneFeatures, uint32_t>;

size_t kindsAmong(std::vector<Kind> all) {
    std::vector<Kind> found;
    for (const Kind& kind : all)
        if (std::ranges::find(found, kind) == found.end()) found.push_back(kind);
    return found.size();
}

TEST(DatasetPipelines, FewAreNeeded) {
    std::vector<Kind> own, alike;
    for (uint32_t seed = 0; seed < 30; ++seed) {
        scene::SceneData data = dataOf(seed);
        own.emplace_back(data.features, data.stackSize);
        generalise(data, true);
        alike.emplace_back(data.features, data.stackSize);
    }
    EXPECT_GT(kindsAmong(own), 15u);
    EXPECT_LE(kindsAmong(alike), 6u);
}

/// The environment that is added is black, and takes samples only where there is nothing else.
TEST(DatasetPipelines, LightStaysAsItWas) {
    for (uint32_t seed = 0; seed < 8; ++seed) {
        const scene::SceneData own = dataOf(seed);
        scene::SceneData alike = own;
        generalise(alike, true);
        EXPECT_EQ(alike.lights, own.lights);
        EXPECT_TRUE(alike.features.environment);
        if (own.features.environment) {
            EXPECT_EQ(alike.environment, own.environment);
            EXPECT_EQ(alike.params.environmentProbability, own.params.environmentProbability);
        } else {
            EXPECT_EQ(alike.params.environmentScale, vec3(0.0f));
            EXPECT_EQ(alike.params.environmentProbability, 0.0f);
        }
    }
}

}  // namespace
}  // namespace limpid::cli

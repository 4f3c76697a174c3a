// Tests what moves and shines in the clips of a dataset, in many random scenes.
#include "lab/dataset/dataset_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "lab/dataset/dataset_night.h"
#include "lab/dataset/dataset_things.h"
#include "scene/builtin/random_room.h"
#include "scene/builtin/random_still_life.h"
#include "scene/motion/animation.h"

namespace limpid::cli {
namespace {

constexpr uint32_t seeds = 24;
const std::vector<uint32_t> stored{1, 2, 10, 11};

/// Rooms with even seeds, still lifes with odd ones.
scene::Scene sceneOf(uint32_t seed) {
    static const std::vector<scene::Scene> scenes = [] {
        std::vector<scene::Scene> made;
        for (uint32_t i = 0; i < seeds; ++i)
            made.push_back(i % 2 == 0 ? scene::randomRoom(i) : scene::randomStillLife(i));
        return made;
    }();
    return scenes[seed];
}

const scene::Clip& clipOf(const scene::Scene& scene) {
    return scene.rig.clips[static_cast<size_t>(scene.clip)];
}

float differenceOf(const mat4& a, const mat4& b) {
    float largest = 0.0f;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            largest = std::max(largest, std::abs(a[column][row] - b[column][row]));
    return largest;
}

TEST(DatasetMotion, AtRestEverythingIsInItsPlace) {
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        scene::Scene scene = sceneOf(seed);
        const ClipMotion motion = addMotion(scene, seed, {}, stored);
        if (motion.count() == 0) continue;
        const scene::RigPose rest = evaluate(scene.rig, nullptr, 0.0);
        for (const scene::Instance& instance : scene.instances) {
            if (instance.node == scene::none) continue;
            EXPECT_LT(differenceOf(rest.toWorld[static_cast<size_t>(instance.node)], instance.transform),
                      1e-5f)
                << scene.name << " " << instance.name;
        }
        for (const scene::PunctualLight& light : scene.lights) {
            if (light.node == scene::none) continue;
            const mat4& toWorld = rest.toWorld[static_cast<size_t>(light.node)];
            if (light.kind == scene::PunctualLight::Kind::Directional)
                EXPECT_LT(glm::distance(-vec3(toWorld[2]), light.direction), 1e-5f) << scene.name;
            else
                EXPECT_LT(glm::distance(vec3(toWorld[3]), light.position), 1e-5f) << scene.name;
        }
    }
}

TEST(DatasetMotion, ThingsMoveDuringTheWholeClipAndSurroundingsDoNot) {
    ClipMotion all;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        scene::Scene scene = sceneOf(seed);
        const SequenceTiming timing{.framesPerSecond = seed % 3 == 0 ? 7.5 : 100.0, .start = 1.5};
        const ClipMotion motion = addMotion(scene, seed, timing, stored);
        ASSERT_GT(motion.count(), 0u) << scene.name;
        all.objects += motion.objects;
        all.lights += motion.lights;
        all.switched += motion.switched;
        const scene::Instance* still = surroundingsOf(scene);
        EXPECT_TRUE(!still || still->movement == scene::Movement::Still) << scene.name;
        for (const scene::Channel& channel : clipOf(scene).channels) {
            EXPECT_TRUE(std::ranges::is_sorted(channel.times, std::less_equal{})) << scene.name;
            if (channel.interpolation == scene::Interpolation::Step) {
                // Between two stored frames.
                EXPECT_GT(channel.times.back(), timing.timeOf(stored.front())) << scene.name;
                EXPECT_LT(channel.times.back(), timing.timeOf(stored.back())) << scene.name;
            } else {
                EXPECT_GE(channel.times.back(), timing.timeOf(stored.back())) << scene.name;
            }
        }
    }
    EXPECT_GT(all.objects, seeds);
    EXPECT_GT(all.lights, seeds / 4);
    EXPECT_GT(all.switched, seeds / 5);
}

TEST(DatasetMotion, ThingsStayWithinTheWalls) {
    for (uint32_t seed = 0; seed < seeds; seed += 2) {
        scene::Scene scene = sceneOf(seed);
        addMotion(scene, seed, {}, stored);
        const scene::Aabb walls = boundsOf(scene, *surroundingsOf(scene));
        for (const double time : {0.0, 0.1, 0.2, 0.3}) {
            const scene::RigPose pose = evaluate(scene.rig, &clipOf(scene), time);
            for (scene::Instance instance : scene.instances) {
                if (instance.node == scene::none) continue;
                instance.transform = pose.toWorld[static_cast<size_t>(instance.node)];
                const vec3 center = boundsOf(scene, instance).center();
                EXPECT_TRUE(glm::all(glm::greaterThan(center, walls.lower)))
                    << scene.name << " " << instance.name;
                EXPECT_TRUE(glm::all(glm::lessThan(center, walls.upper)))
                    << scene.name << " " << instance.name;
            }
        }
    }
}

TEST(DatasetMotion, TheSameSeedMovesTheSame) {
    scene::Scene one = sceneOf(6), other = sceneOf(6), third = sceneOf(6);
    addMotion(one, 3, {}, stored);
    addMotion(other, 3, {}, stored);
    addMotion(third, 4, {}, stored);
    const auto valuesOf = [](const scene::Scene& scene) {
        std::vector<float> values;
        for (const scene::Channel& channel : clipOf(scene).channels)
            values.insert(values.end(), channel.values.begin(), channel.values.end());
        return values;
    };
    EXPECT_EQ(valuesOf(one), valuesOf(other));
    EXPECT_NE(valuesOf(one), valuesOf(third));
}

/// With a bulb whose light shines beside it.
scene::Scene sceneWithABulbAndItsLight() {
    for (uint32_t seed = 1;; ++seed) {
        scene::Scene scene = scene::randomStillLife(seed);
        if (std::ranges::any_of(thingsOf(scene), [&](const Thing& thing) {
                return !thing.lights.empty() && std::ranges::any_of(thing.instances, [&](size_t i) {
                    return isLamp(scene, scene.instances[i]);
                });
            }))
            return scene;
    }
}

TEST(DatasetMotion, ABulbAndItsLightAreSwitchedAlike) {
    const scene::Scene still = sceneWithABulbAndItsLight();
    size_t on = 0, off = 0;
    for (uint32_t seed = 0; seed < 200; ++seed) {
        scene::Scene scene = still;
        addMotion(scene, seed, {}, stored);
        std::map<int, std::vector<bool>> litAtFirst;  // by the node that moves the thing
        for (const scene::Channel& channel : clipOf(scene).channels) {
            const int thing = scene.rig.nodes[static_cast<size_t>(channel.node)].parent;
            if (channel.interpolation != scene::Interpolation::Step || thing == scene::none) continue;
            const float lit = channel.value == scene::AnimatedValue::Scale ? 1.0f : 0.0f;
            litAtFirst[thing].push_back(channel.values[1] == lit);
        }
        for (const auto& [thing, lit] : litAtFirst) {
            EXPECT_EQ(std::ranges::count(lit, lit.front()), std::ssize(lit)) << scene.name << " " << seed;
            if (lit.size() > 1) ++(lit.front() ? on : off);
        }
    }
    EXPECT_GT(on, 5u);
    EXPECT_GT(off, 5u);
}

/// A light that is off has no size, is far away, or shines from below the ground.
TEST(DatasetMotion, SomethingStaysLit) {
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        scene::Scene scene = sceneOf(seed);
        addMotion(scene, seed, {}, stored);
        if (!scene.environment.empty()) continue;
        for (const double time : {0.0, 1.0}) {
            const scene::RigPose pose = evaluate(scene.rig, &clipOf(scene), time);
            const auto isUp = [&](const scene::PunctualLight& light) {
                if (light.kind != scene::PunctualLight::Kind::Directional || light.node == scene::none)
                    return true;
                return pose.toWorld[static_cast<size_t>(light.node)][2].y > 0.0f;
            };
            const auto isOn = [&](int node) {
                if (node == scene::none) return true;
                const mat4& toWorld = pose.toWorld[static_cast<size_t>(node)];
                return glm::length(vec3(toWorld[0])) > 0.5f && glm::length(vec3(toWorld[3])) < 100.0f;
            };
            bool lit = std::ranges::any_of(
                scene.lights, [&](const auto& light) { return isOn(light.node) && isUp(light); });
            for (const scene::Instance& instance : scene.instances)
                lit |= isLamp(scene, instance) && isOn(instance.node);
            EXPECT_TRUE(lit) << scene.name;
        }
    }
}

/// One that is switched off shines from below the ground.
TEST(DatasetMotion, SunsKeepTheirHeight) {
    size_t turned = 0, below = 0;
    for (uint32_t seed = 0; seed < 300; ++seed) {
        scene::Scene scene = sceneOf(seed % seeds);
        addMotion(scene, seed, {}, stored);
        for (const scene::PunctualLight& light : scene.lights) {
            if (light.kind != scene::PunctualLight::Kind::Directional || light.node == scene::none) continue;
            const scene::RigPose pose = evaluate(scene.rig, &clipOf(scene), 0.3);
            const vec3 direction = -vec3(pose.toWorld[static_cast<size_t>(light.node)][2]);
            EXPECT_NEAR(std::abs(direction.y), -light.direction.y, 1e-5) << scene.name;
            EXPECT_TRUE(direction.y < 0.0f || surroundingsOf(scene)) << scene.name;
            turned += std::abs(direction.x - light.direction.x) > 1e-4f ? 1 : 0;
            below += direction.y > 0.0f ? 1 : 0;
        }
    }
    EXPECT_GT(turned, 0u);
    EXPECT_GT(below, 0u);
}

TEST(DatasetMotion, AStillClipMovesNothing) {
    scene::Scene scene = sceneOf(2);
    addStillClip(scene);
    const scene::RigPose pose = evaluate(scene.rig, &clipOf(scene), 1.0);
    size_t count = 0;
    for (const scene::Instance& instance : scene.instances) {
        if (instance.movement == scene::Movement::Still) continue;
        ++count;
        EXPECT_EQ(pose.toWorld[static_cast<size_t>(instance.node)], instance.transform);
    }
    EXPECT_EQ(count, 1u);
}

float strengthOf(const vec3& light) {
    return light.r + light.g + light.b;
}

/// Of each lamp and each light of the thing.
std::vector<float> strengthsOf(const scene::Scene& scene, const Thing& thing) {
    std::vector<float> strengths;
    for (const size_t i : thing.lights) strengths.push_back(strengthOf(scene.lights[i].intensity));
    for (const size_t i : thing.instances) {
        const auto material = static_cast<size_t>(scene.instances[i].material);
        const float strength = strengthOf(scene.materials[material].emission);
        if (strength > 0.0f) strengths.push_back(strength);
    }
    return strengths;
}

/// How strong each lamp is at night, of 1 by day.
std::vector<float> factorsOf(const scene::Scene& day, const scene::Scene& night) {
    std::vector<float> factors;
    for (const Thing& thing : thingsOf(day)) {
        if (!shines(day, thing)) continue;
        const std::vector<float> before = strengthsOf(day, thing), after = strengthsOf(night, thing);
        const float factor = after.front() / before.front();
        for (size_t i = 0; i < before.size(); ++i)
            EXPECT_NEAR(after[i] / before[i], factor, 1e-5f) << day.name;
        factors.push_back(factor);
    }
    return factors;
}

TEST(DatasetNight, OneOrTwoLampsKeepTheirStrength) {
    std::vector<size_t> scenes(3);  // by the number of lamps that stay as they are
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        const scene::Scene day = sceneOf(seed);
        scene::Scene night = day;
        makeNight(night, seed);
        const std::vector<float> factors = factorsOf(day, night);
        const auto kept = static_cast<size_t>(std::ranges::count(factors, 1.0f));
        ASSERT_LE(kept, 2u) << day.name;
        EXPECT_EQ(kept == 0, factors.empty()) << day.name;
        ++scenes[kept];
        for (const float factor : factors) {
            if (factor == 1.0f) continue;
            EXPECT_GE(factor, 0.0099f) << day.name;
            EXPECT_LE(factor, 0.2001f) << day.name;
        }
        const size_t added = night.lights.size() - day.lights.size();
        if (factors.empty())
            EXPECT_TRUE(added == 1 || added == 2) << day.name;
        else
            EXPECT_EQ(added, 0u) << day.name;
    }
    for (size_t kept = 0; kept < scenes.size(); ++kept) EXPECT_GT(scenes[kept], 0u) << kept;
}

TEST(DatasetNight, SunAndSkyAreDim) {
    for (uint32_t seed = 0; seed < seeds; ++seed) {
        const scene::Scene day = sceneOf(seed);
        scene::Scene night = day;
        makeNight(night, seed);
        for (size_t i = 0; i < day.lights.size(); ++i) {
            if (day.lights[i].kind != scene::PunctualLight::Kind::Directional) continue;
            EXPECT_LE(night.lights[i].intensity.g, 0.21f * day.lights[i].intensity.g) << day.name;
        }
        for (size_t i = 0; i < day.environment.radiance.size(); ++i)
            ASSERT_LE(night.environment.radiance[i].g, 0.21f * day.environment.radiance[i].g) << day.name;
    }
}

/// Rooms have lamps of their own, so these are taken away.
TEST(DatasetNight, LightsThatAreAddedAreWithinTheWalls) {
    for (uint32_t seed = 0; seed < 200; ++seed) {
        scene::Scene scene = sceneOf(2 * seed % seeds);
        scene.lights.clear();
        for (scene::Material& material : scene.materials) material.emission = vec3(0.0f);
        makeNight(scene, seed);
        ASSERT_GT(scene.lights.size(), 0u);
        const scene::Aabb walls = boundsOf(scene, *surroundingsOf(scene));
        for (const scene::PunctualLight& light : scene.lights) {
            EXPECT_TRUE(glm::all(glm::greaterThan(light.position, walls.lower))) << scene.name << " " << seed;
            EXPECT_TRUE(glm::all(glm::lessThan(light.position, walls.upper))) << scene.name << " " << seed;
        }
    }
}

}  // namespace
}  // namespace limpid::cli

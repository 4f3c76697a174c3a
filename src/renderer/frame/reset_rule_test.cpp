#include "renderer/frame/reset_rule.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "scene/model/camera.h"

namespace limpid {
namespace {

AccumulationState state() {
    AccumulationState s;
    s.camera = scene::cameraParams(scene::lookAt({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.8f), 320, 180);
    s.settings.extent = {320, 180};
    return s;
}

TEST(ResetRule, KeepsWhatDidNotChange) {
    EXPECT_FALSE(mustReset(state(), state()));
    AccumulationState more = state();
    more.settings.samplesPerLaunch = 8;
    EXPECT_FALSE(mustReset(state(), more)) << "more samples per launch are more of the same";
}

TEST(ResetRule, ResetsOnEveryChange) {
    const auto camera = [](const vec3& eye, float fov) {
        return scene::cameraParams(scene::lookAt(eye, {0, 0, 0}, {0, 1, 0}, fov), 320, 180);
    };
    const std::vector<std::pair<const char*, std::function<void(AccumulationState&)>>> changes{
        {"a lens", [](AccumulationState& s) { s.camera.lensRadius = 0.01f; }},
        {"camera moved",
         [&](auto& s) {
             s.camera = camera({1, 2, 3.0001f}, 0.8f);
         }},
        {"field of view",
         [&](auto& s) {
             s.camera = camera({1, 2, 3}, 0.81f);
         }},
        {"width", [](auto& s) { s.settings.extent.width = 321; }},
        {"height", [](auto& s) { s.settings.extent.height = 181; }},
        {"seed", [](auto& s) { s.settings.seed = 1; }},
        {"jitter", [](auto& s) { s.settings.jitter = Jitter::Off; }},
        {"layers", [](auto& s) { s.settings.layers = true; }},
        {"depth", [](auto& s) { s.settings.pathtrace.maxDepth = 3; }},
        {"roulette", [](auto& s) { s.settings.pathtrace.rouletteDepth = 9; }},
        {"clamp", [](auto& s) { s.settings.pathtrace.fireflyClamp = 9.0f; }},
        {"sampler", [](auto& s) { s.settings.pathtrace.samplerTea = true; }},
        {"points", [](auto& s) { s.settings.pathtrace.samplerSobol = false; }},
        {"scene", [](auto& s) { s.sceneVersion = 1; }},
    };
    for (const auto& [name, change] : changes) {
        AccumulationState changed = state();
        change(changed);
        EXPECT_TRUE(mustReset(state(), changed)) << name;
    }
}

}  // namespace
}  // namespace limpid

#include "scene/framing/own_light.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene {
namespace {

TEST(OwnLight, APointStandsWhereItIsPut) {
    const PunctualLight lamp = parseLamp("point,1,-2.5,3e1,0.5").value();
    EXPECT_EQ(lamp.kind, PunctualLight::Kind::Point);
    EXPECT_EQ(lamp.position, vec3(1.0f, -2.5f, 30.0f));
    EXPECT_EQ(lamp.intensity, vec3(0.5f));
}

TEST(OwnLight, ASunShinesFromItsDirection) {
    const PunctualLight lamp = parseLamp("sun,0,4,-3,2").value();
    EXPECT_EQ(lamp.kind, PunctualLight::Kind::Directional);
    EXPECT_LT(glm::distance(lamp.direction, vec3(0.0f, -0.8f, 0.6f)), 1e-6f);
}

TEST(OwnLight, NothingIsNothing) {
    EXPECT_FALSE(parseLamp(""));
    EXPECT_FALSE(parseBackground(""));
}

TEST(OwnLight, WhatMakesNoSenseIsRefused) {
    for (const char* text : {"point", "point,1,2,3", "point,1,2,3,4,5", "point,1,2,x,4", "lamp,1,2,3,4",
                             "sun,0,0,0,1", "point,1,2,3,-1", "point,1,2,nan,1", "point,1,2,3 ,1"})
        EXPECT_THROW(parseLamp(text), UsageError) << text;
    for (const char* text : {"1", "1,2", "1,2,3,4", "1,2,-3", "a,b,c", "inf,0,0"})
        EXPECT_THROW(parseBackground(text), UsageError) << text;
}

TEST(OwnLight, IsAddedAndTheBackgroundReplaced) {
    Scene scene = builtinScene("cornell");
    const size_t lights = scene.lights.size();
    scene.environment = {.width = 1, .height = 1, .radiance = {vec3(9.0f)}};
    addOwnLight(scene, {{parseLamp("point,0,1,0,1").value()}, vec3(1.0f, 2.0f, 3.0f)});
    prepare(scene);
    EXPECT_EQ(scene.lights.size(), lights + 1);
    for (const vec3& radiance : scene.environment.radiance) EXPECT_EQ(radiance, vec3(1.0f, 2.0f, 3.0f));
    addOwnLight(scene, {{}, vec3(0.0f)});
    prepare(scene);
    EXPECT_TRUE(scene.environment.empty());
}

}  // namespace
}  // namespace limpid::scene

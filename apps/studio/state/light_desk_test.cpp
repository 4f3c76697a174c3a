#include "studio/state/light_desk.h"

#include <gmock/gmock.h>

#include "scene/framing/own_light.h"

namespace limpid::studio {
namespace {

using scene::LightControl;

std::vector<LightControl> loaded(int lamps) {
    std::vector<LightControl> controls(static_cast<size_t>(lamps) + 1);
    for (int i = 0; i < lamps; ++i) {
        controls[static_cast<size_t>(i)].index = i;
        controls[static_cast<size_t>(i)].name = "lamp";
    }
    controls.back().kind = LightControl::Kind::Emitter;
    controls.back().name = "ceiling";
    return controls;
}

TEST(LightDesk, KnowsWhatWasAdded) {
    LightDesk desk;
    desk.show(loaded(3), {.scene = "a",
                          .environment = {},
                          .lights = {"point,0,0,0,1"},
                          .background = "0.5,1,0",
                          .lightFile = {}});
    EXPECT_FALSE(desk.isAdded(desk.lights[1]));
    EXPECT_TRUE(desk.isAdded(desk.lights[2]));
    EXPECT_FALSE(desk.isAdded(desk.lights[3]));
    EXPECT_EQ(desk.backgroundText(), "0.5,1,0");
    EXPECT_FALSE(desk.isChanged());
}

TEST(LightDesk, KeepsChangesWhenAnotherLightComesOrGoes) {
    scene::SceneSource source{.scene = "a",
                              .environment = {},
                              .lights = {"point,0,0,0,1", "point,1,1,1,1"},
                              .background = {},
                              .lightFile = {}};
    LightDesk desk;
    desk.show(loaded(3), source);  // lamp 0 belongs to the scene
    desk.lights[0].on = false;
    desk.lights[2].brightness = 0.5f;
    desk.lights[3].color = {1, 0, 0};

    LightDesk more;
    more.show(loaded(4), source);
    more.carry(desk);
    EXPECT_FALSE(more.lights[0].on);
    EXPECT_EQ(more.lights[2].brightness, 0.5f);
    EXPECT_EQ(more.lights[4].color, vec3(1, 0, 0));

    removeLamp(1, source, desk);
    EXPECT_THAT(source.lights, testing::ElementsAre("point,1,1,1,1"));
    LightDesk fewer;
    fewer.show(loaded(2), source);
    fewer.carry(desk);
    EXPECT_FALSE(fewer.lights[0].on);
    EXPECT_EQ(fewer.lights[1].brightness, 0.5f);
    removeLamp(0, source, desk);  // belongs to the scene
    EXPECT_EQ(source.lights.size(), 1u);
}

TEST(LightDesk, NewLampsSuitTheExposure) {
    const auto near = scene::parseLamp(newLamp(false, {0, 0, 0}, {0, 0, -1}, 0.0f)).value();
    const auto far = scene::parseLamp(newLamp(false, {0, 0, 0}, {0, 0, -10}, 0.0f)).value();
    const auto bright = scene::parseLamp(newLamp(false, {0, 0, 0}, {0, 0, -1}, -3.0f)).value();
    EXPECT_NEAR(far.intensity.x, 100.0f * near.intensity.x, 1.0f);
    EXPECT_NEAR(bright.intensity.x, 8.0f * near.intensity.x, 0.1f);
    EXPECT_EQ(scene::parseLamp(newLamp(true, {0, 0, 0}, {0, 0, -1}, 2.0f))->kind,
              scene::PunctualLight::Kind::Directional);
}

}  // namespace
}  // namespace limpid::studio

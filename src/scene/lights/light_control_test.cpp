#include "scene/lights/light_control.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "base/error.h"
#include "scene/builtin/builtin.h"
#include "scene/lights/light_file.h"
#include "scene/lights/live_lights.h"
#include "scene/load/loader_test_files.h"
#include "scene/prepare/prepare.h"

namespace limpid::scene {
namespace {

using Kind = LightControl::Kind;

/// A scene with an emissive ceiling, a lamp, a sun and an environment.
Scene litScene() {
    Scene scene = cornellScene();
    PunctualLight lamp;
    lamp.name = "lamp";
    lamp.position = {0.5f, 1.0f, 0.5f};
    lamp.intensity = {1.0f, 0.5f, 0.25f};
    PunctualLight sun;
    sun.kind = PunctualLight::Kind::Directional;
    scene.lights = {lamp, sun};
    scene.environment.width = 4;
    scene.environment.height = 2;
    scene.environment.radiance.assign(8, vec3(0.5f));
    prepare(scene);
    return scene;
}

TEST(LightControl, ListsEveryLight) {
    const std::vector<LightControl> controls = lightControlsOf(litScene());
    ASSERT_EQ(controls.size(), 4u);
    EXPECT_EQ(controls[0].name, "lamp");
    EXPECT_EQ(controls[0].color, vec3(1.0f, 0.5f, 0.25f));
    EXPECT_EQ(controls[1].name, "sun 1");
    EXPECT_EQ(controls[2].kind, Kind::Emitter);
    EXPECT_EQ(controls[3].kind, Kind::Environment);
}

/// The uploaded records equal those of a scene built with the current lights.
TEST(LightControl, ChangesAreWhatBuildingTheSceneAnewWouldGive) {
    Scene scene = litScene();
    const SceneData built = buildSceneData(scene);
    LiveLights live(scene, built);
    const std::vector<LightControl> before = lightControlsOf(scene);
    std::vector<LightControl> now = before;
    now[0].position = {0.1f, 0.2f, 0.3f};
    now[0].color = {3.0f, 0.0f, 1.0f};
    now[1].on = false;
    now[2].brightness = 0.25f;
    now[3].on = false;
    now[3].turn = 90.0f;
    applyLightControls(scene, now, before);
    live.update(scene);
    const SceneData anew = buildSceneData(scene);
    EXPECT_NE(anew.lights, built.lights);
    EXPECT_EQ(live.packed().lights, anew.lights);
    EXPECT_EQ(live.packed().lightDensity, anew.lightDensity);
    EXPECT_EQ(live.packed().lightPyramid.size(), anew.lightPyramid.size());
    SceneFrame frame;
    frame.params = built.params;
    live.setParams(frame.params);
    live.addTo(frame);
    EXPECT_EQ(frame.params.environmentScale, vec3(0.0f));
    EXPECT_EQ(frame.params.environmentTurn, 0.25f);
    EXPECT_EQ(frame.params.environmentProbability, 0.0f);
    EXPECT_EQ(anew.params.environmentProbability, 0.0f);
    EXPECT_EQ(anew.params.environmentScale, vec3(0.0f));
    // Apply the uploads of materials to what was built.
    std::vector<uvec4> materials = built.materials;
    for (const SceneFrame::Upload& upload : frame.uploads) {
        if (upload.buffer == "materials")
            std::ranges::copy(upload.bytes, std::as_writable_bytes(std::span(materials)).begin() +
                                                static_cast<std::ptrdiff_t>(upload.offset));
    }
    EXPECT_EQ(materials, anew.materials);
    // Restore the original lights.
    applyLightControls(scene, before, now);
    live.update(scene);
    EXPECT_EQ(live.packed().lights, built.lights);
    EXPECT_EQ(live.packed().lightDensity, built.lightDensity);
}

TEST(LightControl, WhatIsOffHasNoPowerAndKeepsItsPlace) {
    Scene scene = litScene();
    const SceneData built = buildSceneData(scene);
    const std::vector<LightControl> before = lightControlsOf(scene);
    std::vector<LightControl> now = before;
    for (LightControl& control : now) control.on = false;
    applyLightControls(scene, now, before);
    const SceneData dark = buildSceneData(scene);
    EXPECT_EQ(dark.lights.size(), built.lights.size());
    EXPECT_EQ(dark.params.triangleLightCount, built.params.triangleLightCount);
    EXPECT_EQ(dark.params.punctualCount, built.params.punctualCount);
    EXPECT_EQ(dark.features, built.features);
    for (const PunctualLight& light : scene.lights) EXPECT_EQ(light.intensity, vec3(0.0f));
    // Without the lamp and the sun, more samples go to the ceiling.
    const std::vector<LightControl> off = now;
    now[2].on = true;
    applyLightControls(scene, now, off);
    const SceneData one = buildSceneData(scene);
    EXPECT_GT(one.params.triangleLightProbability, built.params.triangleLightProbability);
}

/// Uploads of a frame must not overlap (gpu/graph/frame_graph.h).
TEST(LightControl, WhatAnAnimatorWritesGoesOverIt) {
    Scene scene = litScene();
    LiveLights live(scene, buildSceneData(scene));
    live.update(scene);
    SceneFrame frame;
    frame.uploads.push_back({"lights", 16, std::vector<std::byte>(8, std::byte{0x5a})});
    frame.uploads.push_back({"instances", 0, std::vector<std::byte>(8)});
    live.addTo(frame);
    int writesLights = 0;
    for (const SceneFrame::Upload& upload : frame.uploads) {
        if (upload.buffer != "lights") continue;
        ++writesLights;
        EXPECT_EQ(upload.offset, 0u);
        EXPECT_EQ(upload.bytes.at(16), std::byte{0x5a});
    }
    EXPECT_EQ(writesLights, 1);
}

class LightFileTest : public test::FolderTest {};

TEST_F(LightFileTest, KeepsWhatDiffers) {
    const std::vector<LightControl> before = lightControlsOf(litScene());
    std::vector<LightControl> now = before;
    now[0].on = false;
    now[0].position = {0.1f, 0.7f, 0.3f};
    now[2].color = {0.3f, 0.2f, 0.1f};
    now[3].turn = 33.3f;
    test::put(folder / "lights.json", lightFileText(now, before));
    EXPECT_EQ(readLightFile(folder / "lights.json", before), now);
    EXPECT_THAT(lightFileText(now, before), testing::Not(testing::HasSubstr("\"sun 1\"")));
}

TEST_F(LightFileTest, SaysWhatIsWrong) {
    const std::vector<LightControl> before = lightControlsOf(litScene());
    for (const char* text :
         {"{\"lights\": [{\"kind\": \"lamp\", \"index\": 7}]}", "{\"lights\": [{\"kind\": \"torch\"}]}",
          "{\"lights\": [{\"kind\": \"lamp\", \"colour\": [1, 1, 1]}]}",
          "{\"lights\": [{\"kind\": \"lamp\", \"brightness\": -1}]}",
          "{\"lights\": [{\"kind\": \"lamp\", \"color\": [1, -1, 1]}]}",
          "{\"lights\": [{\"kind\": \"lamp\", \"direction\": [0, 0, 0]}]}", "lights"}) {
        test::put(folder / "lights.json", text);
        EXPECT_THROW(readLightFile(folder / "lights.json", before), InputError) << text;
    }
}

}  // namespace
}  // namespace limpid::scene

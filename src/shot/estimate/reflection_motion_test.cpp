// Tests what is made of smooth mirrors in frames of other renderers, against a plane mirror that is known in
// closed form.
#include "shot/estimate/reflection_motion.h"

#include <gmock/gmock.h>

#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;
using image::Image;

constexpr uint32_t mirrorWidth = 40, mirrorHeight = 30;
constexpr float nearPlane = 0.1f;

CameraParams cameraBefore(float x) {
    ShotCamera camera;
    camera.eye = {x, 0, 4};
    camera.forward = {0, 0, -1};
    camera.up = {0, 1, 0};
    camera.verticalFov = glm::radians(60.0f);
    return camera.params(mirrorWidth, mirrorHeight);
}

size_t pixelAt(uint32_t x, uint32_t y) {
    return size_t{y} * mirrorWidth + x;
}

/// Pixels that a shift of the camera by 1 moves a point at this depth.
float shiftAt(float depth) {
    return 0.5f * mirrorHeight / std::tan(glm::radians(30.0f)) / depth;
}

/// The plane z = 0, seen from z = 4. Below row 20 it is diffuse. Above, it is a mirror that shows a plane as
/// far behind it; from column 30 on, the sky.
ShotLayers mirrorLayers() {
    const auto filled = [](uint32_t components, float value) {
        return Image(mirrorWidth, mirrorHeight, components, value);
    };
    ShotLayers layers;
    layers.width = mirrorWidth;
    layers.height = mirrorHeight;
    layers.images = {{"beauty", filled(3, 1.0f)},         {"diffuse", filled(3, 0.0f)},
                     {"specular", filled(3, 1.0f)},       {"albedo", filled(3, 0.0f)},
                     {"albedoSpecular", filled(3, 0.9f)}, {"albedoReflected", filled(3, 0.9f)},
                     {"mirroredEmission", filled(3, 0)},  {"normal", filled(3, 0.0f)},
                     {"cameraNormal", filled(3, 0.0f)},   {"depth", filled(1, 4.0f)},
                     {"distance", filled(1, 0.0f)},       {"motion", filled(2, 0.0f)}};
    for (uint32_t y = 0; y < mirrorHeight; ++y)
        for (uint32_t x = 0; x < mirrorWidth; ++x) {
            const bool mirror = y < 20, sky = mirror && x >= 30;
            const vec2 at(2.0f * (static_cast<float>(x) + 0.5f) / mirrorWidth - 1.0f,
                          1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / mirrorHeight);
            const float distance = 4.0f * glm::length(rayOf(cameraBefore(0), at));
            layers.images["normal"].at(x, y, 2) = 1.0f;
            layers.images["cameraNormal"].at(x, y, mirror ? 0 : 2) = sky ? 0.0f : 1.0f;
            layers.images["distance"].at(x, y, 0) = distance * (mirror && !sky ? 2.0f : 1.0f) - nearPlane;
            layers.images["motion"].at(x, y, 0) = -shiftAt(4.0f);
            for (uint32_t c = 0; c < 3; ++c) {
                layers.images["albedo"].at(x, y, c) = mirror ? 0.0f : 0.5f;
                layers.images["mirroredEmission"].at(x, y, c) = sky ? 0.75f : 0.25f;
            }
        }
    return layers;
}

LayerMap mirrorMap() {
    LayerMap map;
    map.encoding.depthKind = DepthKind::Planar;
    return map;
}

TEST(ReflectionMotion, ThatOfAPlaneMirrorIsThatOfTheImageBehindIt) {
    FrameConverter converter(mirrorMap());
    const ShotLayers layers = mirrorLayers();
    EXPECT_TRUE(converter.convert(layers, cameraBefore(1), false).reflectionMotion.empty());
    const HostFrame frame = converter.convert(layers, cameraBefore(0), true);
    ASSERT_FALSE(frame.reflectionMotion.empty());
    const float* const moved = &frame.reflectionMotion[4 * pixelAt(20, 10)];
    EXPECT_EQ(moved[3], 1.0f);
    EXPECT_NEAR(moved[0], -shiftAt(8.0f), 0.01f) << "the surface moves by " << shiftAt(4.0f);
    EXPECT_NEAR(moved[1], 0.0f, 0.01f);
    EXPECT_EQ(frame.reflectionMotion[4 * pixelAt(20, 25) + 3], 0.0f) << "no mirror";
    EXPECT_EQ(frame.reflectionMotion[4 * pixelAt(36, 10) + 3], 0.0f) << "the sky is no image";
}

TEST(ReflectionMotion, GlassAndMovingMirrorsAreLeftOut) {
    for (const char* role : {"albedoReflected", "motion"}) {
        FrameConverter converter(mirrorMap());
        ShotLayers layers = mirrorLayers();
        for (float& value : layers.images[role].pixels) value *= 0.2f;
        converter.convert(layers, cameraBefore(1), false);
        const HostFrame frame = converter.convert(layers, cameraBefore(0), true);
        EXPECT_EQ(frame.reflectionMotion[4 * pixelAt(20, 10) + 3], 0.0f) << role;
    }
}

/// Backwards, it is the motion from the next frame, which was converted before.
TEST(ReflectionMotion, BackwardsItComesFromTheNextFrame) {
    FrameConverter converter(mirrorMap());
    ShotLayers layers = mirrorLayers();
    converter.convertAlone(layers, cameraBefore(1), false);
    HostFrame frame = converter.convertAlone(layers, cameraBefore(0), true);
    EXPECT_NEAR(frame.reflectionMotion[4 * pixelAt(20, 10)], -shiftAt(8.0f), 0.01f);
    dropMovingMirrors(cameraBefore(1), frame);
    EXPECT_EQ(frame.reflectionMotion[4 * pixelAt(20, 10) + 3], 1.0f);
    frame.motion[4 * pixelAt(20, 10)] += 2.0f;
    dropMovingMirrors(cameraBefore(1), frame);
    EXPECT_EQ(frame.reflectionMotion[4 * pixelAt(20, 10) + 3], 0.0f);
}

TEST(MirroredEmission, WhatMirrorsShowOfLampsAndSkyIsNotFiltered) {
    FrameConverter converter(mirrorMap());
    ShotLayers layers = mirrorLayers();
    HostFrame frame = converter.convert(layers, cameraBefore(0), false);
    EXPECT_EQ(frame.emission[4 * pixelAt(36, 10)], 0.75f) << "the sky";
    EXPECT_EQ(frame.specular[4 * pixelAt(36, 10)], 0.25f) << "the sum stays";
    EXPECT_EQ(frame.emission[4 * pixelAt(20, 10)], 0.25f);
    EXPECT_EQ(frame.emission[4 * pixelAt(20, 25)], 0.0f) << "the normal is the surface's own: no mirror";
    for (float& value : layers.images["albedoReflected"].pixels) value = 0.5f;
    frame = converter.convert(layers, cameraBefore(0), false);
    EXPECT_EQ(frame.emission[4 * pixelAt(36, 10)], 0.0f) << "glass reflects by chance, which is noise";
}

}  // namespace
}  // namespace limpid::shot

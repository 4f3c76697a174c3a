// Tests what is made of a file's layers, against a scene that is known in closed form: a camera that moves
// before a plane.
#include "shot/frame/shot_frame.h"

#include <gmock/gmock.h>

#include <cmath>

#include "shaders/common/scene_layout.h"
#include "shot/layers/recognise.h"
#include "shot/motion_check.h"
#include "shot/run/packed_picture.h"
#include "shot/shot_denoiser.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;
using image::Image;

constexpr uint32_t columns = 40, rows = 30;

ShotCamera cameraAt(float x) {
    ShotCamera camera;
    camera.eye = {x, 0, 4};
    camera.forward = {0, 0, -1};
    camera.up = {0, 1, 0};
    camera.verticalFov = glm::radians(60.0f);
    return camera;
}

Image filled(uint32_t components, float value) {
    return Image(columns, rows, components, value);
}

Image vectors(const vec3& value) {
    Image image(columns, rows, 3);
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = value[static_cast<int>(i % 3)];
    return image;
}

/// The plane z = 0, seen from a distance of 4, with stripes; the top row shows nothing. `shift`: of the
/// stripes, in pixels to the left.
ShotLayers layersOf(float shift = 0.0f) {
    ShotLayers layers;
    layers.width = columns;
    layers.height = rows;
    layers.images = {{"beauty", filled(3, 1.5f)},
                     {"albedo", filled(3, 0.5f)},
                     {"normal", vectors({0, 0, 1})},
                     {"depth", filled(1, 4.0f)},
                     {"motion", filled(2, 0.0f)}};
    for (uint32_t x = 0; x < columns; ++x) {
        layers.images["depth"].at(x, 0, 0) = 1e10f;
        for (uint32_t y = 0; y < rows; ++y) {
            layers.images["motion"].at(x, y, 0) = shift;
            const float place = (static_cast<float>(x) + shift) / 13.0f;
            layers.images["albedo"].at(x, y, 0) = place - std::floor(place) < 0.5f ? 0.2f : 0.9f;
        }
    }
    return layers;
}

LayerMap planar() {
    LayerMap map;
    map.encoding.depthKind = DepthKind::Planar;
    return map;
}

size_t at(uint32_t x, uint32_t y) {
    return size_t{y} * columns + x;
}

TEST(ShotFrame, DepthAlongTheAxisBecomesDistanceAlongTheRay) {
    FrameConverter converter(planar());
    const CameraParams camera = cameraAt(0).params(columns, rows);
    const HostFrame frame = converter.convert(layersOf(), camera, false);
    const float sx = (2.0f * 5.5f / columns - 1.0f) * std::tan(glm::radians(30.0f)) * columns / rows;
    const float sy = (1.0f - 2.0f * 9.5f / rows) * std::tan(glm::radians(30.0f));
    EXPECT_NEAR(frame.depth[4 * at(5, 9)], 4.0f * std::sqrt(1 + sx * sx + sy * sy), 1e-5f);
    EXPECT_EQ(frame.depth[4 * at(5, 9) + 1], 1.0f);
    EXPECT_EQ(frame.depth[4 * at(5, 0) + 1], 0.0f) << "nothing is hit";
    EXPECT_EQ(frame.ids[2 * at(5, 0)], layout::NONE);
    EXPECT_NE(frame.ids[2 * at(5, 9)], layout::NONE);
    EXPECT_EQ(frame.motion[4 * at(5, 9) + 3], 0.0f) << "no frame came before";
    EXPECT_EQ(converter.report().camera, CameraSource::Given);
}

TEST(ShotFrame, LightIsOneSignalOrTwoAndSumsUpToTheBeauty) {
    FrameConverter converter(planar());
    const CameraParams camera = cameraAt(0).params(columns, rows);
    ShotLayers layers = layersOf();
    HostFrame frame = converter.convert(layers, camera, false);
    EXPECT_TRUE(frame.specular.empty());
    EXPECT_EQ(frame.diffuse[4 * at(5, 9)], 1.5f);
    EXPECT_EQ(frame.diffuse[4 * at(5, 0)], 0.0f);
    EXPECT_EQ(frame.emission[4 * at(5, 0)], 1.5f) << "what is behind everything is not filtered";
    layers.images["diffuse"] = filled(3, 0.5f);
    layers.images["specular"] = filled(3, 0.25f);
    layers.images["emission"] = filled(3, 0.125f);
    frame = converter.convert(layers, camera, false);
    EXPECT_EQ(frame.diffuse[4 * at(5, 9)], 0.5f);
    EXPECT_EQ(frame.emission[4 * at(5, 9)], 0.125f);
    EXPECT_EQ(frame.specular[4 * at(5, 9)], 0.875f) << "with what no layer explains";
    EXPECT_NEAR(converter.report().lightShare, 1.0 - 0.625 / 1.5, 1e-6);
    EXPECT_EQ(frame.albedoSpecular[4 * at(5, 9)], 1.0f);
    // A background belongs to the beauty only if the sum says so.
    layers.images["background"] = filled(3, 0.625f);
    frame = converter.convert(layers, camera, false);
    EXPECT_EQ(frame.emission[4 * at(5, 9)], 0.75f);
    EXPECT_NEAR(converter.report().lightShare, 1.0, 1e-6);
    layers.images["background"] = filled(3, 7.0f);
    frame = converter.convert(layers, camera, false);
    EXPECT_EQ(frame.emission[4 * at(5, 9)], 0.125f);
}

TEST(ShotFrame, TransparentFilmIsDividedByItsAlpha) {
    FrameConverter converter(planar());
    ShotLayers layers = layersOf();
    layers.isTransparent = true;
    layers.images["alpha"] = filled(1, 0.25f);
    layers.images["alpha"].at(3, 9, 0) = 0.0f;
    const HostFrame frame = converter.convert(layers, cameraAt(0).params(columns, rows), false);
    EXPECT_EQ(frame.diffuse[4 * at(5, 9)], 6.0f);
    EXPECT_EQ(frame.albedo[4 * at(5, 9) + 1], 2.0f);
    EXPECT_EQ(frame.depth[4 * at(3, 9) + 1], 0.0f) << "not covered";
    EXPECT_EQ(frame.emission[4 * at(3, 9)], 1.5f) << "a lamp has alpha 0 and a colour";
    // Partly covered, but neither the depth nor the distance knows by what: not divided.
    layers.images["depth"].at(7, 9, 0) = 1e10f;
    const HostFrame missed = converter.convert(layers, cameraAt(0).params(columns, rows), false);
    EXPECT_EQ(missed.depth[4 * at(7, 9) + 1], 0.0f);
    EXPECT_EQ(missed.emission[4 * at(7, 9)], 1.5f);
}

TEST(ShotFrame, TransparentFilmStaysSoUntilACutOrASky) {
    FrameConverter converter(planar());
    const auto isTransparent = [&](bool uncovered, bool continues, bool sky = false) {
        ShotLayers layers = layersOf();
        layers.isTransparent = uncovered;
        layers.showsSky = sky;
        layers.images["alpha"] = filled(1, 0.5f);
        const HostFrame frame =
            converter.convertUsingUp(layers, cameraAt(0).params(columns, rows), continues, false);
        EXPECT_EQ(frame.diffuse[4 * at(5, 9)], layers.isTransparent ? 3.0f : 1.5f);
        return layers.isTransparent;
    };
    EXPECT_FALSE(isTransparent(false, false));
    EXPECT_TRUE(isTransparent(true, true));
    EXPECT_TRUE(isTransparent(false, true));
    EXPECT_TRUE(isTransparent(false, true)) << "also two frames later";
    EXPECT_FALSE(isTransparent(false, false)) << "a cut";
    EXPECT_TRUE(isTransparent(true, true));
    EXPECT_FALSE(isTransparent(false, true, true));
    EXPECT_FALSE(isTransparent(false, true));
}

TEST(ShotFrame, NormalsAreTurnedIntoTheWorld) {
    LayerMap map = planar();
    map.encoding.normalSpace = NormalSpace::Camera;
    map.encoding.normalScale = {1, 1, -1};
    ShotCamera camera = cameraAt(0);
    camera.forward = {1, 0, 0};
    ShotLayers layers = layersOf();
    layers.images["normal"] = vectors({0, 0.6f, -0.8f});
    const HostFrame frame = FrameConverter(map).convert(layers, camera.params(columns, rows), false);
    EXPECT_NEAR(frame.normal[4 * at(5, 9)], -0.8f, 1e-6f);
    EXPECT_NEAR(frame.normal[4 * at(5, 9) + 1], 0.6f, 1e-6f);
}

TEST(ShotFrame, AMixedNormalIsThatOfTheNeighbourAtTheSameDistance) {
    ShotLayers layers = layersOf();
    const auto set = [&](uint32_t x, const vec3& normal, float depth) {
        for (uint32_t c = 0; c < 3; ++c) layers.images["normal"].at(x, 9, c) = normal[static_cast<int>(c)];
        layers.images["depth"].at(x, 9, 0) = depth;
    };
    for (uint32_t x = 21; x < columns; ++x)
        for (uint32_t y = 8; y < 11; ++y) layers.images["depth"].at(x, y, 0) = 8.0f;
    set(21, {1, 0, 0}, 8.0f);
    set(20, {0.5f, 0, 0.5f}, 4.0f);
    const HostFrame frame =
        FrameConverter(planar()).convert(layers, cameraAt(0).params(columns, rows), false);
    EXPECT_EQ(frame.normal[4 * at(20, 9) + 2], 1.0f);
    EXPECT_EQ(frame.normal[4 * at(21, 9)], 1.0f);
}

/// The camera is found in depth and distance.
TEST(ShotFrame, SolvedCamerasKnowTheShapeOfPixels) {
    ShotLayers layers = layersOf();
    layers.pixelAspect = 2.0f;
    const CameraParams camera = cameraAt(0).params(columns, rows, layers.pixelAspect);
    Image distance = filled(1, 0.0f), depth = filled(1, 0.0f);
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const float sx = 2.0f * (static_cast<float>(x) + 0.5f) / columns - 1.0f;
            const float sy = 1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / rows;
            depth.at(x, y, 0) = 3.0f + static_cast<float>((3 * x + 5 * y) % 7);
            distance.at(x, y, 0) =
                depth.at(x, y, 0) * glm::length(camera.forward + sx * camera.right + sy * camera.up);
        }
    layers.images["depth"] = depth;
    layers.images["distance"] = distance;
    FrameConverter converter(planar());
    const HostFrame frame = converter.convert(layers, {}, false);
    EXPECT_EQ(converter.report().camera, CameraSource::Solved);
    EXPECT_NEAR(glm::length(frame.camera.right) / glm::length(camera.right), 1.0f, 5e-3f);
    EXPECT_NEAR(glm::length(frame.camera.up) / glm::length(camera.up), 1.0f, 5e-3f);
    EXPECT_NEAR(frame.depth[4 * at(1, 1)] / distance.at(1, 1, 0), 1.0f, 5e-3f);
    layers.images.erase("distance");
    const HostFrame supposed = FrameConverter(planar()).convert(layers, {}, false);
    EXPECT_NEAR(glm::length(supposed.camera.up) / glm::length(supposed.camera.right), rows / (2.0f * columns),
                1e-4f);
}

TEST(ShotFrame, MotionIsConvertedAndHasTheDifferenceOfDistances) {
    LayerMap map = planar();
    map.encoding.motionUnit = MotionUnit::Picture;
    map.encoding.motionScale = {-1, 1};
    FrameConverter converter(map);
    ShotLayers layers = layersOf();
    converter.convert(layers, cameraAt(0).params(columns, rows), false);
    layers.images["motion"] = filled(2, -0.05f);
    layers.images["motion"].at(7, 9, 0) = 1e10f;
    const HostFrame frame = converter.convert(layers, cameraAt(1).params(columns, rows), true);
    EXPECT_FLOAT_EQ(frame.motion[4 * at(5, 9)], 2.0f);
    EXPECT_FLOAT_EQ(frame.motion[4 * at(5, 9) + 1], -1.5f);
    EXPECT_EQ(frame.motion[4 * at(7, 9) + 3], 0.0f) << "no value";
    const float sx = (2.0f * 5.5f / columns - 1.0f) * std::tan(glm::radians(30.0f)) * columns / rows;
    const float sy = (1.0f - 2.0f * 9.5f / rows) * std::tan(glm::radians(30.0f));
    const vec3 point(1.0f + 4.0f * sx, 4.0f * sy, 0.0f);
    EXPECT_NEAR(frame.motion[4 * at(5, 9) + 2],
                glm::length(point - vec3(0, 0, 4)) - glm::length(point - vec3(1, 0, 4)), 1e-5f);
}

TEST(ShotFrame, BackwardsMotionLeadsToTheNextFrame) {
    FrameConverter converter(planar());
    HostFrame now = converter.convertAlone(layersOf(2.0f), cameraAt(0).params(columns, rows), false);
    const HostFrame next = converter.convertAlone(layersOf(2.0f), cameraAt(0).params(columns, rows), false);
    EXPECT_EQ(next.motion[4 * at(5, 9)], 2.0f);
    turnAround(now, next);
    EXPECT_EQ(now.motion[4 * at(9, 9)], -2.0f);
    EXPECT_EQ(now.motion[4 * at(9, 9) + 3], 1.0f);
    EXPECT_EQ(now.motion[4 * at(1, 9) + 3], 0.0f) << "nothing of the next frame leads there";
}

TEST(ShotFrame, MergedPicturesFollowTheLongerHistory) {
    CleanPicture a{.beauty = {1, 1, 1, 1, 1, 1, 1, 1}, .frames = {1, 4}, .report = {}, .disocclusion = {}};
    const CleanPicture b{
        .beauty = {5, 5, 5, 1, 5, 5, 5, 1}, .frames = {3, 4}, .report = {}, .disocclusion = {}};
    merge(a, b);
    EXPECT_THAT(a.beauty, testing::ElementsAre(4, 4, 4, 1, 3, 3, 3, 1));
}

TEST(ShotFrame, WhatIsTooBrightToBePackedIsThatOfTheOtherDirection) {
    CleanPicture a{.beauty = {1e5f, 1, 1, 1, 2, 2, 2, 1}, .frames = {1, 1}, .report = {}, .disocclusion = {}};
    CleanPicture b{.beauty = {1e5f, 9, 9, 1, 4, 4, 4, 1}, .frames = {9, 1}, .report = {}, .disocclusion = {}};
    merge(a, PackedPicture(b).unpacked());
    EXPECT_THAT(a.beauty, testing::ElementsAre(1e5f, 1, 1, 1, 3, 3, 3, 1));
}

TEST(ShotFrame, InfiniteLightThatIsNotFilteredIsTheLargestHalf) {
    FrameConverter converter(planar());
    const CameraParams camera = cameraAt(0).params(columns, rows);
    ShotLayers layers = layersOf();
    Image& beauty = layers.images["beauty"];
    beauty.at(5, 0, 0) = INFINITY;
    beauty.at(6, 0, 0) = -INFINITY;
    beauty.at(7, 0, 0) = NAN;
    beauty.at(5, 9, 0) = beauty.at(6, 9, 0) = INFINITY;
    layers.images["emission"] = filled(3, 0.0f);
    layers.images["emission"].at(6, 9, 0) = INFINITY;
    layers.groups = {beauty};
    const HostFrame frame = converter.convertUsingUp(layers, camera, false, false);
    EXPECT_EQ(frame.emission[4 * at(5, 0)], 65504.0f) << "the sun";
    EXPECT_EQ(frame.emission[4 * at(6, 0)], 0.0f);
    EXPECT_EQ(frame.emission[4 * at(7, 0)], 0.0f);
    EXPECT_TRUE(std::isinf(frame.diffuse[4 * at(5, 9)])) << "noise: denoisers leave it out";
    EXPECT_EQ(frame.diffuse[4 * at(6, 9)], 0.0f);
    EXPECT_EQ(frame.emission[4 * at(6, 9)], 65504.0f) << "a lamp";
    EXPECT_EQ(layers.groups[0].at(5, 0, 0), 65504.0f);
    EXPECT_EQ(converter.report().notFinite, 5u);
}

TEST(ShotFrame, AnInfiniteLampIsFoundWithoutOtherLayers) {
    ShotLayers layers = layersOf();
    for (const char* role : {"depth", "normal"}) layers.images.erase(role);
    for (uint32_t y = 9; y < 13; ++y)
        for (uint32_t i = 0; i < 15; ++i) layers.images["beauty"].at(5 + i / 3, y, i % 3) = INFINITY;
    const HostFrame frame =
        FrameConverter(planar()).convert(layers, cameraAt(0).params(columns, rows), false);
    EXPECT_EQ(frame.emission[4 * at(6, 10)], 65504.0f);
    EXPECT_EQ(frame.emission[4 * at(20, 20)], 0.0f);
}

TEST(ShotFrame, AnInfiniteFireflyIsNoLamp) {
    ShotLayers layers = layersOf();
    for (uint32_t y = 9; y < 12; ++y)
        for (uint32_t i = 0; i < 9; ++i) layers.images["beauty"].at(5 + i / 3, y, i % 3) = INFINITY;
    const CameraParams camera = cameraAt(0).params(columns, rows);
    HostFrame frame = FrameConverter(planar()).convert(layers, camera, false);
    EXPECT_EQ(frame.emission[4 * at(6, 10)], 0.0f);
    EXPECT_TRUE(std::isinf(frame.diffuse[4 * at(6, 10)])) << "denoisers leave it out";
    layers.images["normal"].at(6, 10, 2) = -1.0f;  // a bulb
    frame = FrameConverter(planar()).convert(layers, camera, false);
    EXPECT_EQ(frame.emission[4 * at(6, 10)], 65504.0f);
}

/// Of a file with a beauty, normals, a depth and motion.
ShotLayers readBack(float depth, float normal, float motion) {
    image::LayeredImage file;
    file.width = columns;
    file.height = rows;
    file.add("", "RGB", filled(3, 1.0f), image::Storage::Float);
    file.add("normal", "XYZ", filled(3, normal), image::Storage::Float);
    file.add("depth", "Z", filled(1, depth), image::Storage::Float);
    file.add("motion", "XY", filled(2, motion), image::Storage::Float);
    image::ExrDocument document = image::ExrDocument::of(file, "a.exr");
    return readLayers(document, recognise(document, {}).at(0));
}

TEST(ReadLayers, ADepthWithoutValuesIsMissing) {
    EXPECT_TRUE(readBack(4.0f, 0.5f, 1.0f).find("depth"));
    for (const float depth : {0.0f, -4.0f, NAN}) {
        const ShotLayers layers = readBack(depth, 0.5f, 1.0f);
        EXPECT_FALSE(layers.find("depth")) << depth;
        EXPECT_THAT(layers.problems, testing::ElementsAre(testing::HasSubstr("no value above 0")));
        const HostFrame frame =
            FrameConverter(planar()).convert(layers, cameraAt(0).params(columns, rows), false);
        EXPECT_EQ(frame.depth[4 * at(5, 9) + 1], 1.0f) << "it is denoised";
    }
    const ShotLayers sky = readBack(0.0f, 0.0f, 1.0f);
    EXPECT_TRUE(sky.find("depth")) << "there are no normals either";
    EXPECT_TRUE(sky.problems.empty());
}

/// Some renderers write a depth of 0 where nothing is hit.
TEST(ReadLayers, WithoutNormalsOtherLayersTellThatOnlySkyIsSeen) {
    const auto keepsDepth = [](const std::vector<std::pair<std::string, float>>& layers) {
        image::LayeredImage file;
        file.width = columns;
        file.height = rows;
        file.add("", "RGB", filled(3, 1.0f), image::Storage::Float);
        file.add("depth", "Z", filled(1, 0.0f), image::Storage::Float);
        for (const auto& [name, value] : layers)
            file.add(name, name.empty() ? "A" : "RGB", filled(name.empty() ? 1 : 3, value),
                     image::Storage::Float);
        image::ExrDocument document = image::ExrDocument::of(file, "a.exr");
        return readLayers(document, recognise(document, {}).at(0)).find("depth") != nullptr;
    };
    EXPECT_FALSE(keepsDepth({})) << "nothing tells";
    EXPECT_TRUE(keepsDepth({{"albedo", 0.0f}}));
    EXPECT_FALSE(keepsDepth({{"albedo", 0.5f}}));
    EXPECT_TRUE(keepsDepth({{"diffuse", 0.0f}, {"specular", 0.0f}}));
    EXPECT_FALSE(keepsDepth({{"albedo", 0.0f}, {"diffuse", 0.5f}}));
    EXPECT_TRUE(keepsDepth({{"", 0.0f}})) << "nothing covers the film";
    EXPECT_FALSE(keepsDepth({{"", 1.0f}})) << "opaque film";
    EXPECT_FALSE(keepsDepth({{"", 0.0f}, {"albedo", 0.5f}}));
}

TEST(ReadLayers, MotionThatIsZeroEverywhereIsNotBelieved) {
    EXPECT_FALSE(readBack(4.0f, 0.5f, 1.0f).zeroMotion);
    ShotLayers layers = readBack(4.0f, 0.5f, 0.0f);
    EXPECT_TRUE(layers.zeroMotion);
    EXPECT_FALSE(layers.find("motion"));
    restoreZeroMotion(layers);
    EXPECT_FALSE(layers.zeroMotion);
    ASSERT_TRUE(layers.find("motion"));
    EXPECT_EQ(layers.find("motion")->at(5, 9, 1), 0.0f);
}

TEST(MotionCheck, RightMotionExplainsTheChangeAndWrongMotionIsNoticed) {
    const ShotLayers before = layersOf(0.0f);
    ShotLayers now = layersOf(3.0f);
    now.images["motion"] = filled(2, 0.0f);
    for (size_t p = 0; p < now.images["motion"].pixels.size(); p += 2) now.images["motion"].pixels[p] = 3.0f;
    Encoding encoding;
    auto check = checkMotion(before, now, encoding);
    ASSERT_TRUE(check);
    EXPECT_GT(check->change, 0.02);
    EXPECT_GT(check->explained, 0.9);
    EXPECT_EQ(check->better, "");
    encoding.motionScale = {-1, 1};
    check = checkMotion(before, now, encoding);
    EXPECT_LT(check->explained, 0.5);
    EXPECT_THAT(check->better, testing::HasSubstr("motion.scale=1,"));
    for (float& v : now.images["motion"].pixels) v /= columns;
    encoding = {};
    check = checkMotion(before, now, encoding);
    EXPECT_THAT(check->better, testing::HasSubstr("motion.unit=picture"));
    now.images.erase("motion");
    EXPECT_FALSE(checkMotion(before, now, encoding));
}

TEST(MotionCheck, CutsAreFound) {
    const ShotLayers before = layersOf(0.0f);
    ShotLayers now = layersOf(3.0f);
    EXPECT_FALSE(isCut(before, now, {}));
    now.images["albedo"] = filled(3, 0.0f);
    now.images["normal"] = vectors({1, 0, 0});
    EXPECT_TRUE(isCut(before, now, {}));
    now.images.erase("motion");
    EXPECT_TRUE(isCut(before, now, {}));
    ShotLayers still = before;
    still.images.erase("motion");
    EXPECT_FALSE(isCut(before, still, {}));
}

}  // namespace
}  // namespace limpid::shot

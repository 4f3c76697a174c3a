// Tests cameras of glTF files, on one that Blender 3.4 exported from the shot `camera` of scripts/shots.
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>

#include "base/error.h"
#include "image/io/temp_folder.h"
#include "shot/camera/camera_track.h"
#include "shot/frame/pixel_layers.h"
#include "shot/frame/shot_frame.h"
#include "shot/layers/recognise.h"

namespace limpid::shot {
namespace {

using testing::HasSubstr;

const std::string shots = std::string(LIMPID_TEST_DATA) + "/shots/";

/// Where a point is on the picture, in pixels from the left and from the top.
vec2 project(const CameraParams& camera, const vec3& point, const ShotLayers& layers) {
    const vec3 away = point - camera.origin, axis = glm::normalize(camera.forward);
    const vec3 ray = away / glm::dot(away, axis);
    const vec2 at(glm::dot(ray, camera.right) / glm::dot(camera.right, camera.right),
                  glm::dot(ray, camera.up) / glm::dot(camera.up, camera.up));
    return (at * vec2(0.5f, -0.5f) + 0.5f) * vec2(layers.width, layers.height);
}

TEST(GltfTrackTest, BlendersExportIsTheTrackOfItsScript) {
    const CameraTrack exported = CameraTrack::read(shots + "camera.glb");
    const CameraTrack written = CameraTrack::read(shots + "camera.camera.json");
    for (int frame = 1; frame <= 16; ++frame) {
        ASSERT_TRUE(exported.at(frame)) << frame;
        const CameraParams a = exported.at(frame, UpAxis::Z)->params(320, 180);
        const CameraParams b = written.at(frame, UpAxis::Z)->params(320, 180);
        EXPECT_LT(glm::distance(a.origin, b.origin), 1e-5f) << frame;
        EXPECT_LT(glm::distance(a.forward, b.forward), 1e-5f) << frame;
        EXPECT_LT(glm::distance(a.right, b.right), 1e-5f) << frame;
        EXPECT_LT(glm::distance(a.up, b.up), 1e-5f) << frame;
        EXPECT_NEAR(a.spread, b.spread, 1e-6f);
    }
    EXPECT_LT(glm::distance(exported.at(1)->eye, vec3(-0.9f, 1.35f, 2.1f)), 1e-5f) << "y is up in glTF";
    const std::vector<int> frames = {-1, 0, 16, 17, 18, 40};
    EXPECT_EQ(exported.lacking(frames), (std::vector<int>{-1, 18, 40})) << "keys are at 0 to 17";
    EXPECT_EQ(exported.at(40)->eye, exported.at(17)->eye) << "it stands still";
    EXPECT_EQ(written.lacking(frames), (std::vector<int>{-1, 0, 17, 18, 40}));
    EXPECT_FALSE(written.at(17));
}

TEST(GltfTrackTest, TimesFollowTheFrameRateAndTheFirstFrame) {
    const CameraTrack plain = CameraTrack::read(shots + "camera.glb");
    const CameraTrack late = CameraTrack::read(shots + "camera.glb", {.firstFrame = 1001});
    EXPECT_EQ(late.at(1005)->eye, plain.at(4)->eye);
    const CameraTrack fast = CameraTrack::read(shots + "camera.glb", {.framesPerSecond = 48.0f});
    EXPECT_LT(glm::distance(fast.at(8)->eye, plain.at(4)->eye), 1e-5f);
    const vec3 between = 0.5f * (plain.at(4)->eye + plain.at(5)->eye);
    EXPECT_LT(glm::distance(fast.at(9)->eye, between), 1e-5f);
    EXPECT_NE(fast.hash(), plain.hash());
    EXPECT_EQ(plain.hash(), CameraTrack::read(shots + "camera.glb").hash());
}

/// Nothing moves but the camera: from depth and both cameras follow Blender's positions and its motion.
TEST(GltfTrackTest, TheLayersOfTheShotFitTheCamera) {
    image::ExrDocument file = image::ExrDocument::read(shots + "camera.0014.exr");
    const std::vector<LayerMap> maps = recognise(file, {});
    const LayerMap& map = maps.at(0);
    ASSERT_EQ(map.encoding.worldUp, UpAxis::Z);
    const ShotLayers layers = readLayers(file, map);
    const CameraTrack track = CameraTrack::read(shots + "camera.glb");
    const auto cameraOf = [&](int frame) {
        return track.at(frame, map.encoding.worldUp)->params(layers.width, layers.height);
    };
    const CameraParams now = cameraOf(14), before = cameraOf(13);
    const image::Image &depth = *layers.find("depth"), &position = *layers.find("position");
    size_t pixels = 0, fits = 0;
    float longest = 0.0f;
    for (size_t p = 0; p < depth.pixels.size(); ++p) {
        const auto moved = motionAt(*layers.find("motion"), p, map.encoding);
        if (!(depth.pixels[p] < 100.0f) || !moved) continue;
        const vec3 point = now.origin + rayOf(now, onScreen(p, layers)) * depth.pixels[p];
        const vec3 given(position.pixels[3 * p], position.pixels[3 * p + 1], position.pixels[3 * p + 2]);
        EXPECT_LT(glm::distance(point, given), 0.01f) << p;  // half precision
        const vec2 motion = project(before, point, layers) - project(now, point, layers);
        fits += glm::distance(motion, *moved) < 0.05f ? 1 : 0;
        longest = std::max(longest, glm::length(motion));
        ++pixels;
    }
    EXPECT_GT(pixels, 1000u);
    // Blender's motion is a mean over samples all over the pixel, its depth that at the centre.
    EXPECT_GT(static_cast<double>(fits), 0.9 * static_cast<double>(pixels)) << fits << " of " << pixels;
    EXPECT_GT(longest, 0.5f);
}

/// Files that are written here.
class WrittenGltfTest : public testing::Test {
  protected:
    std::string put(const std::string& members) {
        image::test::put(folder_ / "a.gltf", R"({"asset": {"version": "2.0"}, )" + members + "}");
        return (folder_ / "a.gltf").string();
    }
    static std::string messageOf(const std::string& source) {
        try {
            CameraTrack::read(source);
        } catch (const InputError& error) {
            return error.what();
        }
        return "none";
    }
    /// Two cameras below a node at (0, 0, 10).
    static constexpr const char* twoCameras =
        R"("scene": 0, "scenes": [{"nodes": [0]}], "nodes": [
           {"children": [1, 2], "translation": [0, 0, 10], "name": "rig"},
           {"camera": 0, "name": "main", "translation": [1, 0, 0], "scale": [2, 2, 2]},
           {"camera": 1, "name": "side"}],
           "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}},
                       {"name": "plan", "type": "orthographic",
                        "orthographic": {"xmag": 2, "ymag": 1.5, "zfar": 9, "znear": 0.1}}])";
    image::test::TempFolder folder_;
};

TEST_F(WrittenGltfTest, ACameraIsChosenByName) {
    const std::string file = put(twoCameras);
    EXPECT_THAT(messageOf(file), HasSubstr("has 2 cameras; a.gltf#NAME chooses one: 'main', 'side'"));
    EXPECT_THAT(messageOf(file + "#top"), HasSubstr("has no camera 'top'; it has 'main', 'side'"));
    const CameraTrack track = CameraTrack::read(file + "#main");
    ASSERT_TRUE(track.at(5));
    EXPECT_EQ(track.at(5)->eye, vec3(1, 0, 10));
    EXPECT_EQ(track.at(5)->forward, vec3(0, 0, -1));
    EXPECT_EQ(track.at(5)->verticalFov, 1.0f);
    EXPECT_TRUE(track.lacking(std::vector<int>{1, 2}).empty()) << "it never moves";
    EXPECT_EQ(track.at(5, UpAxis::Z)->eye, vec3(1, -10, 0));
    EXPECT_EQ(track.at(5, UpAxis::Z)->forward, vec3(0, 1, 0));
    EXPECT_EQ(track.at(5, UpAxis::Z)->up, vec3(0, 0, 1));
    EXPECT_EQ(CameraTrack::read(file + "#side").at(1)->orthographicHeight, 3.0f);
    EXPECT_EQ(CameraTrack::read(file + "#plan").at(1)->orthographicHeight, 3.0f) << "the camera's own name";
}

/// Exporters write a clip for each object; here the camera stands still on a rig that moves.
TEST_F(WrittenGltfTest, ACameraMovesWithItsParents) {
    const float numbers[] = {0.0f, 1.0f, 0, 0, 10, 0, 8, 10, 0.5f, 7, 7, 7};
    std::string base64;
    const auto* const bytes = reinterpret_cast<const unsigned char*>(numbers);
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < sizeof(numbers); i += 3) {
        const unsigned triple = bytes[i] << 16u | bytes[i + 1] << 8u | bytes[i + 2];
        for (const unsigned shift : {18u, 12u, 6u, 0u}) base64 += digits[triple >> shift & 63u];
    }
    const std::string file = put(
        std::string(twoCameras) +
        R"(, "buffers": [{"byteLength": 48, "uri": "data:application/octet-stream;base64,)" + base64 +
        R"("}], "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 0, "byteOffset": 8, "byteLength": 24},
                        {"buffer": 0, "byteOffset": 32, "byteLength": 4}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR"},
                          {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"},
                          {"bufferView": 2, "componentType": 5126, "count": 1, "type": "SCALAR"},
                          {"bufferView": 3, "componentType": 5126, "count": 1, "type": "VEC3"}],
            "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                            "samplers": [{"input": 0, "output": 1}]},
                           {"channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}],
                            "samplers": [{"input": 2, "output": 3}]}])");
    const CameraTrack track = CameraTrack::read(file + "#main");
    EXPECT_EQ(track.at(0)->eye, vec3(1, 0, 10));
    EXPECT_LT(glm::distance(track.at(12)->eye, vec3(1, 4, 10)), 1e-5f);
    EXPECT_LT(glm::distance(track.at(24)->eye, vec3(1, 8, 10)), 1e-5f);
    EXPECT_EQ(track.lacking(std::vector<int>{-3, 0, 24, 25}), (std::vector<int>{-3, 25}));
    EXPECT_EQ(CameraTrack::read(file + "#side").at(12)->eye, vec3(7, 11, 17)) << "both clips play";
    EXPECT_THROW(CameraTrack::read(file + "#main", {.framesPerSecond = 1e8f}), InputError) << "too long";
}

TEST_F(WrittenGltfTest, FaultsAreNamed) {
    EXPECT_THAT(messageOf(put(R"("nodes": [{}])")), HasSubstr("a.gltf: has no camera"));
    EXPECT_THAT(messageOf(put(R"("nodes": [{"camera": 1}], "cameras": [{"type": "perspective"}])")),
                HasSubstr("a.gltf: "));
    EXPECT_THAT(messageOf(put(R"("nodes": [{"camera": 0}], "cameras": [{"type": "perspective"}])")),
                HasSubstr("has no perspective"));
    EXPECT_THAT(messageOf((folder_ / "missing.glb").string()), HasSubstr("missing.glb"));
    image::test::put(folder_ / "b.glb", "no glTF");
    EXPECT_THAT(messageOf((folder_ / "b.glb").string()), HasSubstr("b.glb: "));
}

}  // namespace
}  // namespace limpid::shot

// Tests KHR_mesh_quantization: vertices of bytes and shorts, normalised or not, each padded to four bytes as
// the extension requires; expected values are from its own table (section "Encoding Quantized Data").
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/log.h"
#include "scene/load/loader_test_files.h"

namespace limpid::scene::test {
namespace {

/// Returns the limits of the integer type, zero, and some values in between.
template <typename T>
std::vector<T> samples(size_t count) {
    std::vector<T> values{std::numeric_limits<T>::min(), std::numeric_limits<T>::max(), T{0}, T{1}};
    for (size_t i = values.size(); i < count; ++i) values.push_back(static_cast<T>(i * 7919));
    return values;
}

template <typename T>
float expected(T value, bool normalized) {
    if (!normalized) return static_cast<float>(value);
    const float whole = static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
    return std::is_signed_v<T> ? std::max(whole, -1.0f) : whole;
}

GltfFile quantizedFile() {
    GltfFile file = triangle();
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
    return file;
}

/// Adds a clip that moves the triangle's node, so that the loader keeps deformations.
GltfFile animatedFile() {
    GltfFile file = quantizedFile();
    const int input = file.addFloats({0, 1}, "SCALAR", 1),
              output = file.addFloats({0, 0, 0, 1, 0, 0}, "VEC3", 3);
    file.document["animations"] = json::array(
        {{{"samplers", json::array({{{"input", input}, {"output", output}}})},
          {"channels",
           json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})}}});
    return file;
}

template <typename T>
class QuantizationTest : public FolderTest {};
using Types = testing::Types<int8_t, uint8_t, int16_t, uint16_t>;
TYPED_TEST_SUITE(QuantizationTest, Types);

TYPED_TEST(QuantizationTest, PositionsAndCoordinates) {
    for (const bool normalized : {false, true}) {
        const auto positions = samples<TypeParam>(9);
        const auto uvs = samples<TypeParam>(6);
        GltfFile file = quantizedFile();
        json& attributes = file.primitive()["attributes"];
        attributes["POSITION"] = addPadded(file, positions, "VEC3", 3, normalized);
        attributes["TEXCOORD_0"] = addPadded(file, uvs, "VEC2", 2, normalized);
        attributes["TEXCOORD_1"] = addPadded(file, uvs, "VEC2", 2, !normalized);
        const Mesh mesh = loadScene(file.save(this->folder)).meshes.at(0);
        for (size_t i = 0; i < 9; ++i)
            EXPECT_EQ(mesh.positions[i / 3][static_cast<int>(i % 3)], expected(positions[i], normalized));
        for (size_t i = 0; i < 6; ++i) {
            EXPECT_EQ(mesh.uv0[i / 2][static_cast<int>(i % 2)], expected(uvs[i], normalized));
            EXPECT_EQ(mesh.uv1[i / 2][static_cast<int>(i % 2)], expected(uvs[i], !normalized));
        }
    }
}

template <typename T>
class SignedQuantizationTest : public FolderTest {};
using SignedTypes = testing::Types<int8_t, int16_t>;
TYPED_TEST_SUITE(SignedQuantizationTest, SignedTypes);

TYPED_TEST(SignedQuantizationTest, NormalsAndTangents) {
    log::setLevel(log::Level::Error);
    constexpr auto one = std::numeric_limits<TypeParam>::max(), least = std::numeric_limits<TypeParam>::min();
    const auto part = [](double x) { return static_cast<TypeParam>(std::lround(x * one)); };
    const auto minusOne = static_cast<TypeParam>(-one);
    GltfFile file = quantizedFile();
    json& attributes = file.primitive()["attributes"];
    attributes["NORMAL"] =
        addPadded<TypeParam>(file, {0, 0, one, part(0.6), 0, part(0.8), 0, least, 0}, "VEC3", 3, true);
    attributes["TANGENT"] = addPadded<TypeParam>(
        file, {one, 0, 0, one, part(0.8), 0, part(-0.6), minusOne, 0, 0, one, least}, "VEC4", 4, true);
    const Mesh mesh = loadScene(file.save(this->folder)).meshes.at(0);
    log::setLevel(log::Level::Info);
    // At most a step of the integers off; normalised again.
    const float tolerance = 1.5f / static_cast<float>(one);
    const vec3 normals[] = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, -1, 0}};
    const vec4 tangents[] = {{1, 0, 0, 1}, {0.8f, 0, -0.6f, -1}, {0, 0, 1, -1}};
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_LT(glm::distance(mesh.normals[i], normals[i]), tolerance);
        EXPECT_NEAR(glm::length(mesh.normals[i]), 1.0f, 1e-6f);
        EXPECT_LT(glm::distance(mesh.tangents[i], tangents[i]), tolerance);
    }
}

TYPED_TEST(SignedQuantizationTest, MorphTargets) {
    for (const bool normalized : {false, true}) {
        const auto deltas = samples<TypeParam>(9);
        GltfFile file = quantizedFile();
        file.primitive()["targets"] =
            json::array({{{"POSITION", addPadded(file, deltas, "VEC3", 3, normalized)}}});
        const std::vector<vec3> rest = loadScene(file.save(this->folder)).meshes.at(0).positions;
        file.document["meshes"][0]["weights"] = {0.5};
        const std::vector<vec3> moved = loadScene(file.save(this->folder)).meshes.at(0).positions;
        for (size_t i = 0; i < 9; ++i) {
            const int c = static_cast<int>(i % 3);
            EXPECT_EQ(moved[i / 3][c], rest[i / 3][c] + 0.5f * expected(deltas[i], normalized));
        }
    }
}

TYPED_TEST(SignedQuantizationTest, MorphedNormals) {
    const auto deltas = samples<TypeParam>(9);
    GltfFile file = animatedFile();
    json& attributes = file.primitive()["attributes"];
    attributes["NORMAL"] = file.addFloats({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
    attributes["TANGENT"] = file.addFloats({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", 4);
    const int accessor = addPadded(file, deltas, "VEC3", 3, true);
    file.primitive()["targets"] = json::array({{{"NORMAL", accessor}, {"TANGENT", accessor}}});
    const Scene scene = loadScene(file.save(this->folder));
    const MorphTarget& target = scene.meshes.at(0).deformation->targets.at(0);
    for (size_t i = 0; i < 9; ++i) {
        const int c = static_cast<int>(i % 3);
        EXPECT_EQ(target.normals[i / 3][c], expected(deltas[i], true));
        EXPECT_EQ(target.tangents[i / 3][c], expected(deltas[i], true));
    }
}

template <typename T>
class UnsignedQuantizationTest : public FolderTest {};
using UnsignedTypes = testing::Types<uint8_t, uint16_t>;
TYPED_TEST_SUITE(UnsignedQuantizationTest, UnsignedTypes);

TYPED_TEST(UnsignedQuantizationTest, JointsAndWeights) {
    constexpr auto one = std::numeric_limits<TypeParam>::max();
    const std::vector<TypeParam> weights{one, 0,           0, 0,       one / 5,     one / 5,
                                         0,   one / 5 * 3, 0, one / 3, one / 3 * 2, 0};
    const std::vector<TypeParam> joints{0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0};
    GltfFile file = animatedFile();
    json& attributes = file.primitive()["attributes"];
    attributes["JOINTS_0"] = addPadded(file, joints, "VEC4", 4, false);
    attributes["WEIGHTS_0"] = addPadded(file, weights, "VEC4", 4, true);
    file.document["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0}, {}])");
    file.document["skins"] = json::parse(R"([{"joints": [0, 1]}])");
    const Scene scene = loadScene(file.save(this->folder));
    const Deformation& deformation = *scene.meshes.at(0).deformation;
    for (size_t i = 0; i < 12; ++i) {
        EXPECT_EQ(deformation.joints.at(i / 4)[i % 4], joints[i]);
        // The loader divides by the sum, which is 1 except for rounding.
        EXPECT_NEAR(deformation.weights.at(i / 4)[static_cast<int>(i % 4)], expected(weights[i], true),
                    1e-6f);
    }
}

/// glTF 2.0, section 3.11: rotations and weights may be normalised integers.
TYPED_TEST(QuantizationTest, AnimatedRotations) {
    const auto values = samples<TypeParam>(8);
    GltfFile file = animatedFile();
    file.document["animations"][0]["samplers"][0]["output"] = addPadded(file, values, "VEC4", 4, true);
    file.document["animations"][0]["channels"][0]["target"]["path"] = "rotation";
    const Channel channel = loadScene(file.save(this->folder)).rig.clips.at(0).channels.at(0);
    ASSERT_EQ(channel.values.size(), 8u);
    for (size_t i = 0; i < 8; ++i) EXPECT_EQ(channel.values[i], expected(values[i], true));
}

}  // namespace
}  // namespace limpid::scene::test

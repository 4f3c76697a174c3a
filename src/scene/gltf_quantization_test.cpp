// KHR_mesh_quantization: vertices of bytes and shorts, normalised or not, each padded to four bytes as the
// extension wants; the values by its own table (section "Encoding Quantized Data").
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/log.h"
#include "scene/loader_test_files.h"

namespace limpid::scene::test {
namespace {

template <typename T>
constexpr int componentType = sizeof(T) == 1 ? (std::is_signed_v<T> ? 5120 : 5121)
                                             : (std::is_signed_v<T> ? 5122 : 5123);

/// The integers' ends, zero, and some in between.
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

/// An accessor of `values`, each element padded to a multiple of four bytes by other values than zero.
template <typename T>
int addPadded(GltfFile& file, const std::vector<T>& values, const char* type, size_t components,
              bool normalized) {
    const size_t stride = (components * sizeof(T) + 3) / 4 * 4;
    std::string bytes(values.size() / components * stride, '\x5a');
    for (size_t i = 0; i < values.size(); i += components)
        std::memcpy(bytes.data() + i / components * stride, &values[i], components * sizeof(T));
    const int view = file.addView(bytes.data(), bytes.size());
    file.document["bufferViews"].back()["byteStride"] = stride;
    return file.add("accessors", {{"bufferView", view},
                                  {"componentType", componentType<T>},
                                  {"count", values.size() / components},
                                  {"type", type},
                                  {"normalized", normalized}});
}

GltfFile quantizedFile() {
    GltfFile file = triangle();
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {"KHR_mesh_quantization"};
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
    // A step of the integers off, at most; unit length again.
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

}  // namespace
}  // namespace limpid::scene::test

// Tests KHR_draco_mesh_compression: reads known geometry back that Draco's encoder wrote, and damaged files.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/log.h"
#include "scene/gltf/document/gltf_access.h"
#include "scene/gltf/document/gltf_document.h"
#include "scene/load/loader_test_files.h"

namespace limpid::scene::test {
namespace {

constexpr const char* extensionName = "KHR_draco_mesh_compression";

/// A torus of size x size squares. All positions differ, so they identify the vertices.
struct Torus {
    std::vector<vec3> positions, normals;
    std::vector<vec2> uvs;
    std::vector<std::array<uint16_t, 4>> joints;
    std::vector<std::array<uint8_t, 4>> colors;
    std::vector<uint32_t> indices;

    explicit Torus(uint32_t size) {
        for (uint32_t i = 0; i < size * size; ++i) {
            const float u = static_cast<float>(i % size) / static_cast<float>(size);
            const float v = static_cast<float>(i / size) / static_cast<float>(size);
            const vec3 outwards(std::cos(2 * pi * u), 0, std::sin(2 * pi * u));
            const vec3 normal = outwards * std::cos(2 * pi * v) + vec3(0, std::sin(2 * pi * v), 0);
            positions.push_back(outwards * 3.0f + normal);
            normals.push_back(normal);
            uvs.emplace_back(u, v);
            joints.push_back({static_cast<uint16_t>(i % 300), 0, 0, static_cast<uint16_t>(i % 7)});
            colors.push_back({static_cast<uint8_t>(i % 256), static_cast<uint8_t>(i / 3 % 256), 0, 255});
            const uint32_t right = i / size * size + (i + 1) % size, up = (i + size) % (size * size);
            const uint32_t across = up / size * size + (up + 1) % size;
            indices.insert(indices.end(), {i, up, right, right, up, across});
        }
    }
};

template <typename Value>
int addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, int8_t components,
                 draco::DataType type, const std::vector<Value>& values) {
    draco::GeometryAttribute description;
    description.Init(kind, nullptr, static_cast<uint8_t>(components), type, false, sizeof(Value), 0);
    const auto count = static_cast<uint32_t>(values.size());
    const int id = mesh.AddAttribute(description, true, count);
    for (uint32_t i = 0; i < count; ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
    return id;
}

struct Encoding {
    int method = draco::MESH_EDGEBREAKER_ENCODING;
    int submethod = draco::MESH_EDGEBREAKER_STANDARD_ENCODING;
    int positionBits = 14, normalBits = 10, uvBits = 12;
    bool withMetadata = false;
};

/// Encodes the attributes with unique numbers: 0 positions, 1 normals, 2 coordinates, 3 joints, 4 colours.
std::string encode(const Torus& torus, const Encoding& encoding) {
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(torus.positions.size()));
    for (size_t i = 0; i < torus.indices.size(); i += 3) {
        mesh.AddFace({draco::PointIndex(torus.indices[i]), draco::PointIndex(torus.indices[i + 1]),
                      draco::PointIndex(torus.indices[i + 2])});
    }
    addAttribute(mesh, draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, torus.positions);
    addAttribute(mesh, draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32, torus.normals);
    addAttribute(mesh, draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32, torus.uvs);
    addAttribute(mesh, draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT16, torus.joints);
    addAttribute(mesh, draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8, torus.colors);
    if (encoding.withMetadata) {
        auto metadata = std::make_unique<draco::GeometryMetadata>();
        metadata->AddEntryString("name", "torus");
        mesh.AddMetadata(std::move(metadata));
    }
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(encoding.method);
    if (encoding.method == draco::MESH_EDGEBREAKER_ENCODING) encoder.SetEncodingSubmethod(encoding.submethod);
    if (encoding.positionBits) encoder.SetAttributeQuantization(0, encoding.positionBits);
    if (encoding.normalBits) encoder.SetAttributeQuantization(1, encoding.normalBits);
    if (encoding.uvBits) encoder.SetAttributeQuantization(2, encoding.uvBits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw Error("Draco's encoder: " + status.error_msg_string());
    return {buffer.data(), buffer.size()};
}

/// A document with one Draco primitive and no uncompressed data.
GltfFile dracoFile(const std::string& stream, size_t vertices, size_t indices) {
    GltfFile file;
    const int view = file.addView(stream.data(), stream.size());
    const auto accessor = [&](const char* type, int componentType, size_t count, bool normalized = false) {
        return file.add(
            "accessors",
            {{"componentType", componentType}, {"count", count}, {"type", type}, {"normalized", normalized}});
    };
    json& primitive = file.primitive();
    primitive["attributes"] = {{"POSITION", accessor("VEC3", 5126, vertices)},
                               {"NORMAL", accessor("VEC3", 5126, vertices)},
                               {"TEXCOORD_0", accessor("VEC2", 5126, vertices)},
                               {"JOINTS_0", accessor("VEC4", 5123, vertices)},
                               {"COLOR_0", accessor("VEC4", 5121, vertices, true)}};
    primitive["indices"] = accessor("SCALAR", 5123, indices);
    primitive["extensions"][extensionName] = {
        {"bufferView", view},
        {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}, {"JOINTS_0", 3}, {"COLOR_0", 4}}}};
    file.document["extensionsUsed"] = file.document["extensionsRequired"] = {extensionName};
    return file;
}

GltfFile dracoFile(const Torus& torus, const Encoding& encoding = {}) {
    return dracoFile(encode(torus, encoding), torus.positions.size(), torus.indices.size());
}

/// Returns each triangle as its vertices' numbers, lowest first, sorted, for comparing two meshes.
std::vector<std::array<uint32_t, 3>> trianglesOf(const std::vector<uint32_t>& indices,
                                                 const std::vector<uint32_t>& numbers) {
    std::vector<std::array<uint32_t, 3>> triangles;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<uint32_t, 3> t{numbers[indices[i]], numbers[indices[i + 1]], numbers[indices[i + 2]]};
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        triangles.push_back(t);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

class DracoTest : public FolderTest {
  protected:
    DracoTest() { log::setLevel(log::Level::Error); }
    ~DracoTest() override { log::setLevel(log::Level::Info); }

    /// Returns the number of the torus vertex for each of the mesh's vertices, found by position.
    static std::vector<uint32_t> numbersOf(const Mesh& mesh, const Torus& torus) {
        std::vector<uint32_t> numbers;
        for (const vec3& p : mesh.positions) {
            const auto nearest = std::min_element(
                torus.positions.begin(), torus.positions.end(),
                [&](const vec3& a, const vec3& b) { return glm::distance(a, p) < glm::distance(b, p); });
            numbers.push_back(static_cast<uint32_t>(nearest - torus.positions.begin()));
        }
        return numbers;
    }

    void expectTorus(const fs::path& path, const Torus& torus, const Encoding& encoding) {
        const Scene scene = loadScene(path);
        const Mesh& mesh = scene.meshes.at(0);
        ASSERT_EQ(mesh.positions.size(), torus.positions.size());
        const std::vector<uint32_t> numbers = numbersOf(mesh, torus);
        // Half a quantisation step of the largest extent per coordinate, and a little for rounding.
        const float positionStep =
            encoding.positionBits ? 8.0f / static_cast<float>((1 << encoding.positionBits) - 1) : 0.0f;
        const float uvStep = encoding.uvBits ? 1.0f / static_cast<float>((1 << encoding.uvBits) - 1) : 0.0f;
        const float normalStep =
            encoding.normalBits ? 4.0f / static_cast<float>((1 << encoding.normalBits) - 1) : 0.0f;
        for (size_t i = 0; i < numbers.size(); ++i) {
            const uint32_t n = numbers[i];
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mesh.positions[i][c], torus.positions[n][c], 0.5f * positionStep + 2e-6f);
            for (int c = 0; c < 2; ++c) EXPECT_NEAR(mesh.uv0[i][c], torus.uvs[n][c], 0.5f * uvStep + 2e-7f);
            EXPECT_LT(glm::distance(mesh.normals[i], torus.normals[n]), normalStep + 1e-6f);
            for (int c = 0; c < 4; ++c)
                EXPECT_EQ(mesh.colors[i][c],
                          static_cast<float>(torus.colors[n][static_cast<size_t>(c)]) / 255.0f);
        }
        std::vector<uint32_t> own(torus.positions.size());
        for (uint32_t i = 0; i < own.size(); ++i) own[i] = i;
        EXPECT_EQ(trianglesOf(mesh.indices, numbers), trianglesOf(torus.indices, own));
    }
};

TEST_F(DracoTest, EveryMethodGivesTheGeometryBack) {
    const Torus torus(24);
    for (const Encoding& encoding :
         {Encoding{}, Encoding{.submethod = draco::MESH_EDGEBREAKER_VALENCE_ENCODING, .positionBits = 18},
          Encoding{.method = draco::MESH_SEQUENTIAL_ENCODING},
          Encoding{
              .method = draco::MESH_SEQUENTIAL_ENCODING, .positionBits = 0, .normalBits = 0, .uvBits = 0},
          Encoding{.withMetadata = true}}) {
        SCOPED_TRACE(encoding.method * 10 + encoding.submethod);
        expectTorus(dracoFile(torus, encoding).save(folder), torus, encoding);
        put(folder / "torus.glb", dracoFile(torus, encoding).glb());
        expectTorus(folder / "torus.glb", torus, encoding);
    }
}

/// Without quantisation, the sequential method changes nothing, not even the order.
TEST_F(DracoTest, LosslessIsExact) {
    const Torus torus(8);
    const Encoding lossless{
        .method = draco::MESH_SEQUENTIAL_ENCODING, .positionBits = 0, .normalBits = 0, .uvBits = 0};
    GltfFile file = dracoFile(torus, lossless);
    const fs::path path = file.save(folder);
    const Mesh mesh = loadScene(path).meshes.at(0);
    EXPECT_EQ(mesh.positions, torus.positions);
    EXPECT_EQ(mesh.uv0, torus.uvs);
    EXPECT_EQ(mesh.indices, torus.indices);
    // As skins read it: through the document's accessors.
    const gltf::Document document(path);
    const gltf::Object primitive = document.lists().meshes.at(0).objects("primitives").at(0);
    const auto joints = gltf::readJoints(
        document, primitive.object("attributes")->index("JOINTS_0", document.lists().accessors.size()));
    ASSERT_EQ(joints.size(), torus.joints.size());
    for (size_t i = 0; i < joints.size(); ++i) {
        for (int c = 0; c < 4; ++c) ASSERT_EQ(joints[i][c], torus.joints[i][static_cast<size_t>(c)]) << i;
    }
}

TEST_F(DracoTest, PrimitivesOfOneStreamShareAMesh) {
    GltfFile file = dracoFile(Torus(6));
    json& primitives = file.document["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    file.add("materials", {{"name", "other"}});
    primitives[1]["material"] = 0;
    const Scene scene = loadScene(file.save(folder));
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances.size(), 2u);
}

/// Two streams with the same accessors give two meshes.
TEST_F(DracoTest, StreamsMayShareAccessors) {
    Torus small(6), large(6);
    for (vec3& p : large.positions) p *= 10.0f;
    GltfFile file = dracoFile(small);
    const std::string other = encode(large, {});
    const int view = file.addView(other.data(), other.size());
    json& primitives = file.document["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1]["extensions"][extensionName]["bufferView"] = view;
    const Scene scene = loadScene(file.save(folder));
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_NEAR(glm::length(scene.meshes[1].positions[0]), 10.0f * glm::length(scene.meshes[0].positions[0]),
                0.01f);
}

TEST_F(DracoTest, AttributesBesideTheStream) {
    const Torus torus(6);
    const Encoding sequential{.method = draco::MESH_SEQUENTIAL_ENCODING};
    GltfFile file = dracoFile(torus, sequential);
    std::vector<float> second(torus.positions.size() * 2, 0.25f);
    file.primitive()["attributes"]["TEXCOORD_1"] = file.addFloats(second, "VEC2", 2);
    file.primitive()["targets"] = json::array(
        {{{"POSITION", file.addFloats(std::vector<float>(torus.positions.size() * 3, 1.0f), "VEC3", 3)}}});
    file.document["meshes"][0]["weights"] = {2.0};
    const Mesh mesh = loadScene(file.save(folder)).meshes.at(0);
    EXPECT_EQ(mesh.uv1.at(7), vec2(0.25f));
    EXPECT_LT(glm::distance(mesh.positions.at(7), torus.positions[7] + vec3(2.0f)), 1e-3f);
}

/// A flat regular grid compresses to almost nothing. The limit on expansion must still accept one of a
/// realistic size.
TEST_F(DracoTest, FlatGrid) {
    Torus grid(300);
    for (uint32_t i = 0; i < grid.positions.size(); ++i)
        grid.positions[i] = vec3(static_cast<float>(i % 300), 0, static_cast<float>(i / 300));
    const std::string stream = encode(grid, {.submethod = draco::MESH_EDGEBREAKER_VALENCE_ENCODING});
    EXPECT_EQ(
        loadScene(dracoFile(stream, grid.positions.size(), grid.indices.size()).save(folder)).triangleCount(),
        180'000u);
}

// --- malformed files
// -------------------------------------------------------------------------------------

TEST_F(DracoTest, RulesThatAreBroken) {
    const Torus torus(6);  // 36 vertices, 72 triangles
    const auto expectFault = [&](const char* place, const char* value, const std::string& fault) {
        SCOPED_TRACE(std::string(place) + " = " + value);
        GltfFile file = dracoFile(torus);
        file.document[json::json_pointer(place)] = json::parse(value);
        expectRefused(file.save(folder), fault);
    };
    const std::string primitive = "/meshes/0/primitives/0";
    const std::string extension = primitive + "/extensions/" + extensionName;
    const std::string view = extension + "/bufferView", attributes = extension + "/attributes";
    const std::string position = attributes + "/POSITION", mode = primitive + "/mode";
    expectFault(extension.c_str(), "3", "is not an object");
    expectFault(view.c_str(), "1", "there are only 1");
    expectFault(view.c_str(), "-1", "whole number");
    expectFault(attributes.c_str(), "{}", "none of its attributes");
    expectFault(attributes.c_str(), "[]", "is not an object");
    expectFault(attributes.c_str(), R"({"POSITION": 0, "_OTHER": 1, "NORMAL": 9})", "has no attribute 9");
    expectFault(position.c_str(), "9", "has no attribute 9");
    expectFault(position.c_str(), "4294967296", "has no attribute 4294967296");
    expectFault(position.c_str(), "-1", "whole number");
    expectFault(position.c_str(), "2", "has 2 components");
    expectFault(mode.c_str(), "1", "Draco has triangles only");
    expectFault("/bufferViews/0/byteLength", "4", "no Draco stream");
    expectFault("/bufferViews/0/byteLength", "0", "no Draco stream");
    expectFault("/bufferViews/0/byteLength", "1000000", "not inside its buffer");
    expectFault("/bufferViews/0/byteOffset", "1", "not inside its buffer");
    expectFault("/accessors/0/type", "\"VEC4\"", "has 3 components");
    expectFault("/accessors/0/count", "35", "differs from that of other attributes");
    expectFault("/accessors/5/count", "213", "has 72 triangles");
    expectFault("/accessors/5/count", "219", "is not the 216");
    expectFault("/accessors/5/count", "1099511627776", "accepted");
    for (const char* count : {"35", "37", "100000000", "0"}) {
        GltfFile file = dracoFile(torus);
        for (size_t i = 0; i < 5; ++i) file.document["accessors"][i]["count"] = json::parse(count);
        expectRefused(file.save(folder), "points");
    }
}

TEST_F(DracoTest, NoViewNoAttributesNoIndices) {
    const Torus torus(6);
    for (const char* key : {"bufferView", "attributes"}) {
        GltfFile file = dracoFile(torus);
        file.primitive()["extensions"][extensionName].erase(key);
        expectRefused(file.save(folder), std::string("has no ") + key);
    }
    GltfFile file = dracoFile(torus);
    file.primitive().erase("indices");  // the stream has its own indices
    EXPECT_EQ(loadScene(file.save(folder)).triangleCount(), 72u);
}

TEST_F(DracoTest, PointCloudsAreNoMeshes) {
    draco::PointCloudBuilder builder;
    builder.Start(3);
    const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (uint32_t i = 0; i < 3; ++i)
        builder.SetAttributeValueForPoint(id, draco::PointIndex(i), &Torus(6).positions[i]);
    const auto cloud = builder.Finalize(false);
    draco::ExpertEncoder encoder(*cloud);
    draco::EncoderBuffer buffer;
    ASSERT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
    expectRefused(dracoFile(std::string(buffer.data(), buffer.size()), 3, 3).save(folder), "holds no mesh");
}

/// The header and the accessors claim a billion triangles and as many vertices.
TEST_F(DracoTest, HugeCounts) {
    const auto varint = [](uint32_t value) {
        std::string text;
        for (; value >= 128; value >>= 7) text += static_cast<char>(value | 128);
        return text + static_cast<char>(value);
    };
    for (const int method : {0, 1}) {
        const std::string header =
            std::string("DRACO\x02\x02\x01") + static_cast<char>(method) + std::string(2, '\0');
        for (const uint32_t count : {80'000'000u, 1'000'000'000u}) {
            std::string stream = header + (method ? std::string(1, '\0') : "");
            stream += varint(count) + varint(count) + std::string(500, '\x01');
            expectRefused(dracoFile(stream, 100, 300).save(folder), "points or more");
            const size_t stated = std::min(count, 80'000'000u);
            expectRefused(dracoFile(stream, stated, 3 * stated).save(folder),
                          count > stated ? "points or more" : "is too short");
        }
    }
}

TEST_F(DracoTest, OldVersions) {
    std::string stream = encode(Torus(6), {});
    stream[6] = 1;
    expectRefused(dracoFile(stream, 36, 216).save(folder), "version 2.1");
    stream[5] = 9;
    EXPECT_THROW(loadScene(dracoFile(stream, 36, 216).save(folder)), InputError);
}

TEST_F(DracoTest, TruncatedStreams) {
    const Torus torus(10);
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const std::string stream = encode(torus, {.method = method});
        for (size_t length = 0; length + 1 < stream.size(); length += 1 + stream.size() / 150) {
            GltfFile file = dracoFile(stream.substr(0, length), torus.positions.size(), torus.indices.size());
            expectRefused(file.save(folder), "Draco");
        }
    }
}

TEST_F(DracoTest, DamagedStreams) {
    const Torus torus(10);
    int loaded = 0, refused = 0;
    const std::string whole[] = {encode(torus, {.method = 0}), encode(torus, {.method = 1})};
    for (unsigned seed = 0; seed < 1000; ++seed) {
        std::mt19937 random(seed);
        std::string stream = whole[seed % 2];
        for (int i = 0; i < 2; ++i)
            stream[11 + random() % (stream.size() - 11)] ^= static_cast<char>(1 << random() % 8);
        try {
            loadScene(dracoFile(stream, torus.positions.size(), torus.indices.size()).save(folder));
            ++loaded;
        } catch (const InputError&) {
            ++refused;
        }
    }
    EXPECT_GT(loaded, 50);
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace limpid::scene::test

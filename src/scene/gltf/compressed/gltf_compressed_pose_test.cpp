// Tests compressed skins, morph targets and animations: all views of a document with EXT_meshopt_compression,
// and a primitive with joints and weights with KHR_draco_mesh_compression.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>
#include <meshoptimizer.h>

#include <cmath>

#include "base/log.h"
#include "scene/load/loader_test_files.h"

namespace limpid::scene::test {
namespace {

constexpr uint32_t columns = 20, rows = 30, vertexCount = columns * rows;

std::vector<uint32_t> gridIndices() {
    std::vector<uint32_t> indices;
    for (uint32_t y = 0; y + 1 < rows; ++y) {
        for (uint32_t x = 0; x + 1 < columns; ++x) {
            const uint32_t a = y * columns + x, b = a + columns;
            indices.insert(indices.end(), {a, b, a + 1, a + 1, b, b + 1});
        }
    }
    return indices;
}

/// Returns `components` values for each vertex: value(vertex, component).
template <typename T, typename Value>
std::vector<T> perVertex(size_t components, const Value& value) {
    std::vector<T> values;
    for (uint32_t v = 0; v < vertexCount; ++v)
        for (size_t c = 0; c < components; ++c) values.push_back(static_cast<T>(value(v, c)));
    return values;
}

uint32_t jointOf(uint32_t vertex, size_t slot) {
    return slot < 2 ? (vertex / columns / 10 + static_cast<uint32_t>(slot)) % 3 : 0;
}

uint32_t weightOf(uint32_t vertex, size_t slot) {
    const uint32_t first = vertex * 37 % 256;
    return slot == 0 ? first : slot == 1 ? 255 - first : 0;
}

/// Nodes 1 to 3 are the joints of node 0, whose mesh also has a morph target; all data is quantised.
GltfFile actor() {
    GltfFile file;
    json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] = addPadded(
        file,
        perVertex<uint16_t>(
            3, [](uint32_t v, size_t c) { return c == 0   ? v % columns
                                                 : c == 1 ? v / columns
                                                          : v * v % 5; }),
        "VEC3", 3, false);
    attributes["NORMAL"] = addPadded(
        file, perVertex<int8_t>(3, [](uint32_t, size_t c) { return c == 2 ? 127 : 0; }), "VEC3", 3, true);
    attributes["JOINTS_0"] = addPadded(file, perVertex<uint8_t>(4, jointOf), "VEC4", 4, false);
    attributes["WEIGHTS_0"] = addPadded(file, perVertex<uint8_t>(4, weightOf), "VEC4", 4, true);
    const auto delta = [](uint32_t v, size_t c) { return static_cast<int>(v * (c + 3) % 90) - 45; };
    file.primitive()["targets"] =
        json::array({{{"POSITION", addPadded(file, perVertex<int16_t>(3, delta), "VEC3", 3, false)},
                      {"NORMAL", addPadded(file, perVertex<int8_t>(3, delta), "VEC3", 3, true)}}});
    file.primitive()["indices"] = file.addAccessor<uint32_t>(gridIndices(), "SCALAR", 1, 5125);
    std::vector<float> inverseBind;
    for (int joint = 0; joint < 3; ++joint) {
        const auto y = static_cast<float>(-10 * joint);
        inverseBind.insert(inverseBind.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, 0, 1});
    }
    file.document["skins"] = json::array(
        {{{"joints", {1, 2, 3}}, {"inverseBindMatrices", file.addFloats(inverseBind, "MAT4", 16)}}});
    file.document["nodes"] = json::parse(R"([{"mesh": 0, "skin": 0, "weights": [0.25]}, {"children": [2]},
        {"translation": [0, 10, 0], "children": [3]}, {"translation": [0, 10, 0]}])");
    file.document["scenes"][0]["nodes"] = {0, 1};
    return file;
}

/// Adds an animation of one second: the middle joint rotates (shorts), the morph weight grows (floats).
void animate(GltfFile& file) {
    constexpr int keys = 25;
    std::vector<float> times, weights;
    std::vector<int16_t> rotations;
    for (int i = 0; i < keys; ++i) {
        const float t = static_cast<float>(i) / (keys - 1);
        times.push_back(t);
        weights.push_back(t * t);
        rotations.insert(rotations.end(), {0, 0, static_cast<int16_t>(std::lround(32767 * std::sin(t))),
                                           static_cast<int16_t>(std::lround(32767 * std::cos(t)))});
    }
    const int input = file.addFloats(times, "SCALAR", 1), grown = file.addFloats(weights, "SCALAR", 1);
    const int turned = addPadded(file, rotations, "VEC4", 4, true);
    file.document["animations"] = json::array(
        {{{"samplers", {{{"input", input}, {"output", turned}}, {{"input", input}, {"output", grown}}}},
          {"channels",
           {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}},
            {{"sampler", 1}, {"target", {{"node", 0}, {"path", "weights"}}}}}}}});
}

/// Returns the bytes of one element of the accessor that reads the view, including padding.
size_t strideOf(const json& document, size_t view) {
    if (const json& v = document["bufferViews"][view]; v.contains("byteStride")) return v["byteStride"];
    for (const json& accessor : document["accessors"]) {
        if (accessor["bufferView"] == view)
            return document["bufferViews"][view]["byteLength"].get<size_t>() /
                   accessor["count"].get<size_t>();
    }
    throw Error("no accessor reads the view");
}

/// Saves the document with every view compressed and without the uncompressed buffer.
fs::path saveCompressed(const GltfFile& plain, const fs::path& folder) {
    json document = plain.document;
    std::string bytes;
    for (size_t i = 0; i < document["bufferViews"].size(); ++i) {
        json& view = document["bufferViews"][i];
        const size_t length = view["byteLength"], stride = strideOf(plain.document, i),
                     count = length / stride;
        std::string encoded(meshopt_encodeVertexBufferBound(count, stride), '\0');
        encoded.resize(
            meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(encoded.data()), encoded.size(),
                                       plain.bytes.data() + view["byteOffset"].get<size_t>(), count, stride));
        view["buffer"] = 1;
        view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                         {"byteOffset", bytes.size()},
                                                         {"byteLength", encoded.size()},
                                                         {"byteStride", stride},
                                                         {"count", count},
                                                         {"mode", "ATTRIBUTES"}};
        bytes += encoded;
    }
    document["buffers"] = {{{"byteLength", bytes.size()}, {"uri", "compressed.bin"}},
                           {{"byteLength", plain.bytes.size()}}};
    document["extensionsUsed"] =
        document["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    put(folder / "compressed.bin", bytes);
    put(folder / "compressed.gltf", document.dump());
    return folder / "compressed.gltf";
}

void expectSameMovement(const Scene& a, const Scene& b) {
    ASSERT_TRUE(a.meshes.at(0).deformation && b.meshes.at(0).deformation);
    const Deformation &da = *a.meshes[0].deformation, &db = *b.meshes[0].deformation;
    EXPECT_EQ(da.positions, db.positions);
    EXPECT_EQ(da.normals, db.normals);
    EXPECT_EQ(da.joints, db.joints);
    EXPECT_EQ(da.weights, db.weights);
    ASSERT_EQ(da.targets.size(), db.targets.size());
    EXPECT_EQ(da.targets.at(0).positions, db.targets.at(0).positions);
    EXPECT_EQ(da.targets.at(0).normals, db.targets.at(0).normals);
    EXPECT_EQ(a.rig.skins.at(0).inverseBind, b.rig.skins.at(0).inverseBind);
    for (size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(a.rig.clips.at(0).channels.at(i).times, b.rig.clips.at(0).channels.at(i).times);
        EXPECT_EQ(a.rig.clips.at(0).channels.at(i).values, b.rig.clips.at(0).channels.at(i).values);
    }
}

class CompressedPoseTest : public FolderTest {
  protected:
    CompressedPoseTest() { log::setLevel(log::Level::Error); }
    ~CompressedPoseTest() override { log::setLevel(log::Level::Info); }
};

TEST_F(CompressedPoseTest, MeshoptOfEveryView) {
    GltfFile file = actor();
    animate(file);
    const Scene plain = loadScene(file.save(folder)), compressed = loadScene(saveCompressed(file, folder));
    expectSameMovement(plain, compressed);
    EXPECT_EQ(compressed.meshes[0].positions, plain.meshes[0].positions) << "posed: morphed, then skinned";
    EXPECT_EQ(compressed.meshes[0].indices, plain.meshes[0].indices);
    EXPECT_LT(fs::file_size(folder / "compressed.bin"), fs::file_size(folder / "scene.bin"));
}

TEST_F(CompressedPoseTest, DamagedMatricesAndTimesAreRefused) {
    GltfFile file = actor();
    animate(file);
    const fs::path path = saveCompressed(file, folder);
    const json whole = json::parse(get(path));
    for (const char* list : {"skins", "animations"}) {
        const json& user = whole[list][0];
        const size_t accessor =
            user.contains("samplers") ? user["samplers"][0]["input"] : user["inverseBindMatrices"];
        json document = whole;
        json& view = document["bufferViews"][whole["accessors"][accessor]["bufferView"].get<size_t>()];
        json& length = view["extensions"]["EXT_meshopt_compression"]["byteLength"];
        length = length.get<size_t>() / 2;
        put(path, document.dump());
        expectRefused(path, "EXT_meshopt_compression");
    }
}

template <typename T>
void addAttribute(draco::Mesh& mesh, draco::GeometryAttribute::Type kind, int components,
                  draco::DataType type, bool normalized, const std::vector<T>& values) {
    draco::GeometryAttribute description;
    const size_t stride = static_cast<size_t>(components) * sizeof(T);
    description.Init(kind, nullptr, static_cast<uint8_t>(components), type, normalized,
                     static_cast<int64_t>(stride), 0);
    const int id = mesh.AddAttribute(description, true, vertexCount);
    for (uint32_t i = 0; i < vertexCount; ++i)
        mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                              &values[i * static_cast<size_t>(components)]);
}

std::string encodeDraco(int method) {
    draco::Mesh mesh;
    mesh.set_num_points(vertexCount);
    const std::vector<uint32_t> indices = gridIndices();
    for (size_t i = 0; i < indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(indices[i]), draco::PointIndex(indices[i + 1]),
                      draco::PointIndex(indices[i + 2])});
    // x is the vertex's number, which identifies it after the encoder has changed the order.
    addAttribute(mesh, draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32, false,
                 perVertex<float>(3, [](uint32_t v, size_t c) {
                     return c == 0 ? v : c == 1 ? v / columns : 0;
                 }));
    addAttribute(mesh, draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, false,
                 perVertex<uint8_t>(4, jointOf));
    addAttribute(mesh, draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8, true,
                 perVertex<uint8_t>(4, weightOf));
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(method);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeToBuffer(&buffer);
    if (!status.ok()) throw Error("Draco's encoder: " + status.error_msg_string());
    return {buffer.data(), buffer.size()};
}

GltfFile dracoActor(int method) {
    GltfFile file = actor();
    animate(file);
    const std::string stream = encodeDraco(method);
    const auto accessor = [&](const char* type, int componentType, size_t count, bool normalized) {
        return file.add(
            "accessors",
            {{"componentType", componentType}, {"count", count}, {"type", type}, {"normalized", normalized}});
    };
    json& primitive = file.primitive();
    primitive["attributes"] = {{"POSITION", accessor("VEC3", 5126, vertexCount, false)},
                               {"JOINTS_0", accessor("VEC4", 5121, vertexCount, false)},
                               {"WEIGHTS_0", accessor("VEC4", 5121, vertexCount, true)}};
    primitive["indices"] = accessor("SCALAR", 5125, gridIndices().size(), false);
    primitive["targets"][0].erase("NORMAL");
    primitive["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", file.addView(stream.data(), stream.size())},
        {"attributes", {{"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}}}};
    file.document["extensionsUsed"] =
        file.document["extensionsRequired"] = {"KHR_draco_mesh_compression", "KHR_mesh_quantization"};
    return file;
}

/// Joints and weights stay with their vertices, whatever order the method produces.
TEST_F(CompressedPoseTest, DracoSkins) {
    for (const int method : {draco::MESH_EDGEBREAKER_ENCODING, draco::MESH_SEQUENTIAL_ENCODING}) {
        const Scene scene = loadScene(dracoActor(method).save(folder));
        ASSERT_TRUE(scene.meshes.at(0).deformation);
        const Deformation& d = *scene.meshes[0].deformation;
        ASSERT_EQ(d.positions.size(), vertexCount);
        for (size_t i = 0; i < vertexCount; ++i) {
            const auto v = static_cast<uint32_t>(std::lround(d.positions[i].x));
            if (method == draco::MESH_SEQUENTIAL_ENCODING) {
                ASSERT_EQ(v, i) << "which morph targets beside the stream need";
            }
            for (size_t c = 0; c < 4; ++c) {
                ASSERT_EQ(d.joints[i][c], jointOf(v, c)) << i;
                ASSERT_NEAR(d.weights[i][static_cast<int>(c)], static_cast<float>(weightOf(v, c)) / 255.0f,
                            1e-6f);
            }
        }
        EXPECT_EQ(d.targets.at(0).positions.at(7), vec3(7 * 3 - 45, 7 * 4 - 45, 7 * 5 - 45));
    }
}

}  // namespace
}  // namespace limpid::scene::test

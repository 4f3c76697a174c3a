// Tests EXT_meshopt_compression: reads known geometry back that meshoptimizer's encoder wrote, and damaged
// files.
#include <meshoptimizer.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/log.h"
#include "scene/gltf/document/gltf_access.h"
#include "scene/gltf/document/gltf_document.h"
#include "scene/load/loader_test_files.h"

namespace limpid::scene::test {
namespace {

/// A bumpy sheet of size x size squares: positions, normals (not unit), coordinates, and indices in cache
/// order.
struct Sheet {
    std::vector<float> positions, uvs;
    std::vector<uint32_t> indices;
    size_t vertices = 0;

    explicit Sheet(size_t size) : vertices((size + 1) * (size + 1)) {
        for (size_t y = 0; y <= size; ++y) {
            for (size_t x = 0; x <= size; ++x) {
                const float u = static_cast<float>(x) / static_cast<float>(size);
                const float v = static_cast<float>(y) / static_cast<float>(size);
                positions.insert(positions.end(), {u, std::sin(5.0f * u) * std::cos(7.0f * v), v});
                uvs.insert(uvs.end(), {u, v});
            }
        }
        std::vector<uint32_t> order;
        for (size_t y = 0; y < size; ++y) {
            for (size_t x = 0; x < size; ++x) {
                const auto a = static_cast<uint32_t>(y * (size + 1) + x),
                           b = a + static_cast<uint32_t>(size + 1);
                order.insert(order.end(), {a, b, a + 1, a + 1, b, b + 1});
            }
        }
        indices.resize(order.size());
        meshopt_optimizeVertexCache(indices.data(), order.data(), order.size(), vertices);
    }

    template <typename Index>
    std::vector<Index> indicesAs() const {
        return {indices.begin(), indices.end()};
    }
};

std::string encodeAttributes(const void* data, size_t count, size_t stride) {
    std::string encoded(meshopt_encodeVertexBufferBound(count, stride), '\0');
    encoded.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(encoded.data()),
                                              encoded.size(), data, count, stride));
    return encoded;
}

std::string encodeTriangles(const std::vector<uint32_t>& indices, size_t vertices) {
    std::string encoded(meshopt_encodeIndexBufferBound(indices.size(), vertices), '\0');
    encoded.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(encoded.data()), encoded.size(),
                                             indices.data(), indices.size()));
    return encoded;
}

std::string encodeIndices(const std::vector<uint32_t>& indices, size_t vertices) {
    std::string encoded(meshopt_encodeIndexSequenceBound(indices.size(), vertices), '\0');
    encoded.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(encoded.data()),
                                               encoded.size(), indices.data(), indices.size()));
    return encoded;
}

constexpr const char* extensionName = "EXT_meshopt_compression";

/// A document with compressed views. Their uncompressed data would be in buffer 1, which has none.
struct CompressedFile : GltfFile {
    size_t decodedBytes = 0;

    int addCompressed(const std::string& encoded, size_t count, size_t stride, const char* mode,
                      const char* filter = nullptr) {
        const int view = addView(encoded.data(), encoded.size());
        json& target = document["bufferViews"][static_cast<size_t>(view)];
        json extension = {{"buffer", 0},
                          {"byteOffset", target["byteOffset"]},
                          {"byteLength", encoded.size()},
                          {"byteStride", stride},
                          {"count", count},
                          {"mode", mode}};
        if (filter) extension["filter"] = filter;
        target = {{"buffer", 1}, {"byteOffset", decodedBytes}, {"byteLength", count * stride}};
        if (std::string(mode) == "ATTRIBUTES") target["byteStride"] = stride;
        target["extensions"][extensionName] = extension;
        decodedBytes += count * stride;
        return view;
    }

    int accessor(int view, int componentType, size_t count, const char* type, bool normalized = false) {
        return add("accessors", {{"bufferView", view},
                                 {"componentType", componentType},
                                 {"count", count},
                                 {"type", type},
                                 {"normalized", normalized}});
    }

    /// Buffer 0 has the data, buffer 1 only a length.
    fs::path saveCompressed(const fs::path& folder, bool marked = true) {
        document["extensionsUsed"] = document["extensionsRequired"] = {extensionName};
        finishBuffer("scene.bin");
        json fallback = {{"byteLength", decodedBytes}};
        if (marked) fallback["extensions"][extensionName] = {{"fallback", true}};
        document["buffers"].push_back(fallback);
        put(folder / "scene.bin", bytes);
        put(folder / "scene.gltf", document.dump());
        return folder / "scene.gltf";
    }
};

CompressedFile compressedSheet(const Sheet& sheet, const char* mode, size_t indexSize) {
    CompressedFile file;
    json& attributes = file.primitive()["attributes"];
    const std::string positions = encodeAttributes(sheet.positions.data(), sheet.vertices, 12);
    const std::string uvs = encodeAttributes(sheet.uvs.data(), sheet.vertices, 8);
    const bool triangles = std::string(mode) == "TRIANGLES";
    const std::string indices = triangles ? encodeTriangles(sheet.indices, sheet.vertices)
                                          : encodeIndices(sheet.indices, sheet.vertices);
    attributes["POSITION"] = file.accessor(file.addCompressed(positions, sheet.vertices, 12, "ATTRIBUTES"),
                                           5126, sheet.vertices, "VEC3");
    attributes["TEXCOORD_0"] =
        file.accessor(file.addCompressed(uvs, sheet.vertices, 8, "ATTRIBUTES"), 5126, sheet.vertices, "VEC2");
    file.primitive()["indices"] =
        file.accessor(file.addCompressed(indices, sheet.indices.size(), indexSize, mode),
                      indexSize == 2 ? 5123 : 5125, sheet.indices.size(), "SCALAR");
    return file;
}

GltfFile plainSheet(const Sheet& sheet) {
    GltfFile file;
    json& attributes = file.primitive()["attributes"];
    attributes["POSITION"] = file.addFloats(sheet.positions, "VEC3", 3);
    attributes["TEXCOORD_0"] = file.addFloats(sheet.uvs, "VEC2", 2);
    file.primitive()["indices"] = file.addAccessor<uint32_t>(sheet.indices, "SCALAR", 1, 5125);
    return file;
}

/// The mode TRIANGLES keeps the order of triangles, but may rotate the corners of each.
std::vector<uint32_t> withMinFirst(std::vector<uint32_t> indices) {
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const auto first = indices.begin() + static_cast<std::ptrdiff_t>(i);
        std::rotate(first, std::min_element(first, first + 3), first + 3);
    }
    return indices;
}

class MeshoptTest : public FolderTest {
  protected:
    MeshoptTest() { log::setLevel(log::Level::Error); }
    ~MeshoptTest() override { log::setLevel(log::Level::Info); }
};

TEST_F(MeshoptTest, CompressedGeometryEqualsThePlain) {
    for (const size_t size : {1u, 3u, 20u, 100u}) {
        const Sheet sheet(size);
        const Mesh plain = loadScene(plainSheet(sheet).save(folder, "plain")).meshes.at(0);
        for (const char* mode : {"TRIANGLES", "INDICES"}) {
            for (const size_t indexSize : {2u, 4u}) {
                for (const bool marked : {false, true}) {
                    CompressedFile file = compressedSheet(sheet, mode, indexSize);
                    const Mesh mesh = loadScene(file.saveCompressed(folder, marked)).meshes.at(0);
                    EXPECT_EQ(mesh.positions, plain.positions);
                    EXPECT_EQ(mesh.uv0, plain.uv0);
                    EXPECT_EQ(withMinFirst(mesh.indices), withMinFirst(plain.indices));
                    if (std::string(mode) == "INDICES") {
                        EXPECT_EQ(mesh.indices, plain.indices);
                    }
                }
            }
        }
    }
}

TEST_F(MeshoptTest, ReadsGlb) {
    const Sheet sheet(9);
    CompressedFile file = compressedSheet(sheet, "TRIANGLES", 2);
    file.saveCompressed(folder);
    const json buffers = file.document["buffers"];
    std::string glb = file.glb();
    // glb() keeps only its own buffer, so put the fallback buffer back in at least as many bytes.
    file.document["buffers"] = {{{"byteLength", file.bytes.size()}}, buffers[1]};
    std::string text = file.document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](size_t value) {
        const auto number = static_cast<uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&number), 4);
    };
    glb = "glTF" + word(2) + word(28 + text.size() + file.bytes.size()) + word(text.size()) + "JSON" + text +
          word(file.bytes.size()) + std::string("BIN\0", 4) + file.bytes;
    put(folder / "scene.glb", glb);
    EXPECT_EQ(loadScene(folder / "scene.glb").meshes.at(0).positions,
              loadScene(plainSheet(sheet).save(folder, "plain")).meshes.at(0).positions);
}

/// Compressed data is preferred over uncompressed data; here they differ to show that.
TEST_F(MeshoptTest, PrefersTheCompressedData) {
    const Sheet sheet(2);
    CompressedFile file = compressedSheet(sheet, "TRIANGLES", 4);
    file.saveCompressed(folder);
    file.document.erase("extensionsRequired");
    file.document["buffers"][1] = {{"byteLength", file.decodedBytes}, {"uri", "zeros.bin"}};
    put(folder / "zeros.bin", std::string(file.decodedBytes, '\0'));
    put(folder / "scene.gltf", file.document.dump());
    EXPECT_EQ(loadScene(folder / "scene.gltf").meshes.at(0).positions,
              loadScene(plainSheet(sheet).save(folder, "plain")).meshes.at(0).positions);
}

// --- filters
// ----------------------------------------------------------------------------------------------

std::vector<vec4> someUnitVectors(size_t count, bool quaternions) {
    std::vector<vec4> vectors;
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    while (vectors.size() < count) {
        const vec4 v(normal(random), normal(random), normal(random), quaternions ? normal(random) : 0.0f);
        if (glm::length(v) > 0.1f) vectors.push_back(glm::normalize(v));
    }
    return vectors;
}

/// Returns what the accessor code reads from a document with one compressed accessor.
std::vector<vec4> readBack(const fs::path& folder, const std::string& encoded, size_t count, size_t stride,
                           const char* filter, int componentType) {
    CompressedFile file;
    const int accessor = file.accessor(file.addCompressed(encoded, count, stride, "ATTRIBUTES", filter),
                                       componentType, count, "VEC4", componentType != 5126);
    const gltf::Document document(file.saveCompressed(folder));
    return gltf::readVec4(document, accessor);
}

TEST_F(MeshoptTest, OctahedralFilter) {
    const std::vector<vec4> vectors = someUnitVectors(203, false);
    for (const size_t stride : {4u, 8u}) {
        const int bits = stride == 4 ? 8 : 12;
        std::string filtered(vectors.size() * stride, '\0');
        meshopt_encodeFilterOct(filtered.data(), vectors.size(), stride, bits, &vectors[0].x);
        const auto read = readBack(folder, encodeAttributes(filtered.data(), vectors.size(), stride),
                                   vectors.size(), stride, "OCTAHEDRAL", stride == 4 ? 5120 : 5122);
        ASSERT_EQ(read.size(), vectors.size());
        // A step on the octahedron's square is at most 3 times as long on the sphere. Both coordinates are
        // rounded to half a step, and the vector's again: 3 * sqrt(1/2) + sqrt(3/4) steps.
        const float tolerance = 3.0f / static_cast<float>((1 << (bits - 1)) - 1);
        for (size_t i = 0; i < read.size(); ++i)
            EXPECT_LT(glm::distance(vec3(read[i]), vec3(vectors[i])), tolerance) << i;
    }
}

TEST_F(MeshoptTest, QuaternionFilter) {
    const std::vector<vec4> vectors = someUnitVectors(101, true);
    std::string filtered(vectors.size() * 8, '\0');
    meshopt_encodeFilterQuat(filtered.data(), vectors.size(), 8, 12, &vectors[0].x);
    const auto read = readBack(folder, encodeAttributes(filtered.data(), vectors.size(), 8), vectors.size(),
                               8, "QUATERNION", 5122);
    ASSERT_EQ(read.size(), vectors.size());
    // Both signs are the same rotation. The extension allows an error of 1/32767 in each component of the
    // result.
    for (size_t i = 0; i < read.size(); ++i) {
        EXPECT_GT(std::abs(glm::dot(glm::normalize(read[i]), vectors[i])), 1.0f - 2e-6f) << i;
        EXPECT_NEAR(glm::length(read[i]), 1.0f, 2.0f / 32767.0f) << i;
    }
}

TEST_F(MeshoptTest, ExponentialFilter) {
    std::vector<vec4> vectors = someUnitVectors(77, true);
    for (size_t i = 0; i < vectors.size(); ++i)
        vectors[i] *= std::pow(10.0f, static_cast<float>(i % 9) - 4.0f);
    std::string filtered(vectors.size() * 16, '\0');
    // One exponent per number; 16 bits of mantissa including the sign.
    meshopt_encodeFilterExp(filtered.data(), vectors.size() * 4, 4, 16, &vectors[0].x);
    const auto read = readBack(folder, encodeAttributes(filtered.data(), vectors.size(), 16), vectors.size(),
                               16, "EXPONENTIAL", 5126);
    ASSERT_EQ(read.size(), vectors.size());
    for (size_t i = 0; i < read.size(); ++i) {
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(read[i][c], vectors[i][c], std::abs(vectors[i][c]) * 0x1p-14f) << i;
    }
}

/// Accessors of skins and animations instead of a mesh.
TEST_F(MeshoptTest, CompressedMatrices) {
    std::vector<float> numbers;
    for (int i = 0; i < 5 * 16; ++i) numbers.push_back(std::cos(static_cast<float>(i)));
    CompressedFile file;
    const int accessor = file.accessor(
        file.addCompressed(encodeAttributes(numbers.data(), 5, 64), 5, 64, "ATTRIBUTES"), 5126, 5, "MAT4");
    const gltf::Document document(file.saveCompressed(folder));
    const std::vector<mat4> matrices = gltf::readMat4(document, accessor, 5);
    ASSERT_EQ(matrices.size(), 5u);
    EXPECT_EQ(std::memcmp(matrices.data(), numbers.data(), numbers.size() * sizeof(float)), 0);
}

// --- malformed files
// -------------------------------------------------------------------------------------

TEST_F(MeshoptTest, RulesThatAreBroken) {
    const CompressedFile good = compressedSheet(Sheet(5), "TRIANGLES", 2);
    const auto expectFault = [&](size_t view, const char* key, const char* value, const std::string& fault,
                                 bool inExtension = true) {
        SCOPED_TRACE(std::to_string(view) + " " + key + " = " + value);
        CompressedFile file = good;
        file.saveCompressed(folder);
        json& target = file.document["bufferViews"][view];
        (inExtension ? target["extensions"][extensionName] : target)[key] = json::parse(value);
        put(folder / "scene.gltf", file.document.dump());
        expectRefused(folder / "scene.gltf", fault);
    };
    for (const size_t view : {0u, 2u}) {
        expectFault(view, "count", "-1", "count: is not a whole number");
        expectFault(view, "count", "39", "byteLength: is");
        expectFault(view, "count", "9007199254740990", "byteLength: is");
        expectFault(view, "byteStride", "0", "byteStride: is 0");
        expectFault(view, "byteStride", "9007199254740992", "which its mode and filter do not allow");
        expectFault(view, "byteLength", "1000000", "are not inside its buffer");
        expectFault(view, "byteLength", "9007199254740992", "are not inside its buffer");
        expectFault(view, "byteLength", "0", "");
        expectFault(view, "byteLength", "3", "");
        expectFault(view, "byteOffset", "9007199254740992", "are not inside its buffer");
        expectFault(view, "byteOffset", "1", "damaged");
        expectFault(view, "buffer", "1", "are not inside its buffer of 0");
        expectFault(view, "buffer", "2", "there are only 2");
        expectFault(view, "mode", "\"LINES\"", "mode: is 'LINES'");
        expectFault(view, "mode", "3", "mode: is not a text");
        expectFault(view, "filter", "\"COLOR\"", "filter: is 'COLOR'");
        expectFault(view, "byteLength", "12345", "byteLength: is 12345", false);
        expectFault(view, "byteStride", "20", "byteStride: is not the compressed data's", false);
    }
    expectFault(0, "byteStride", "14", "which its mode and filter do not allow");
    expectFault(0, "byteStride", "260", "which its mode and filter do not allow");
    expectFault(0, "filter", "\"OCTAHEDRAL\"", "which its mode and filter do not allow");
    expectFault(0, "filter", "\"QUATERNION\"", "which its mode and filter do not allow");
    expectFault(0, "mode", "\"TRIANGLES\"", "which its mode and filter do not allow");
    expectFault(2, "mode", "\"INDICES\"", "damaged");
    expectFault(2, "mode", "\"ATTRIBUTES\"", "which its mode and filter do not allow");
    expectFault(2, "filter", "\"EXPONENTIAL\"", "is for the mode ATTRIBUTES only");
    expectFault(2, "byteStride", "3", "which its mode and filter do not allow");
}

TEST_F(MeshoptTest, TrianglesInThrees) {
    CompressedFile file = compressedSheet(Sheet(5), "TRIANGLES", 2);
    file.saveCompressed(folder);
    json& view = file.document["bufferViews"][2];
    view["extensions"][extensionName]["count"] = 149;
    view["byteLength"] = 298;
    put(folder / "scene.gltf", file.document.dump());
    expectRefused(folder / "scene.gltf", "no multiple of 3");
}

/// A stream of a few bytes that claims a terabyte is rejected before anything is allocated.
TEST_F(MeshoptTest, HugeCounts) {
    for (const size_t stride : {4u, 256u}) {
        CompressedFile file;
        const size_t count = (size_t{1} << 40) / stride;
        const std::string few(100, '\xa0');
        const int accessor =
            file.accessor(file.addCompressed(few, count, stride, "ATTRIBUTES"), 5126, 1, "SCALAR");
        file.primitive()["attributes"]["POSITION"] = accessor;
        expectRefused(file.saveCompressed(folder), "too large together");
        json& view = file.document["bufferViews"][0];
        const size_t fewer = 60'000'000 / stride;
        view["byteLength"] = fewer * stride;
        view["extensions"][extensionName]["count"] = fewer;
        put(folder / "scene.gltf", file.document.dump());
        expectRefused(folder / "scene.gltf", "more than 100 bytes can hold");
    }
}

TEST_F(MeshoptTest, ManyViewsOfOneStreamAreBoundedTogether) {
    const std::vector<float> zeros(64 * 8192, 0.0f);
    const std::string encoded = encodeAttributes(zeros.data(), 8192, 256);
    CompressedFile file;
    for (int i = 0; i < 200; ++i) {
        file.addCompressed(encoded, 8192, 256, "ATTRIBUTES");
        json& view = file.document["bufferViews"].back();
        view["byteOffset"] = 0;
        view["extensions"][extensionName]["byteOffset"] = 0;
        file.bytes.resize(encoded.size());
        file.decodedBytes = 0;
    }
    file.decodedBytes = zeros.size() * sizeof(float);
    expectRefused(file.saveCompressed(folder), "too large together");
}

TEST_F(MeshoptTest, PlainViewsOfAPlaceholderAreRefused) {
    CompressedFile file = compressedSheet(Sheet(5), "TRIANGLES", 2);
    file.saveCompressed(folder);
    file.document["bufferViews"][0].erase("extensions");
    put(folder / "scene.gltf", file.document.dump());
    expectRefused(folder / "scene.gltf", "bufferViews[0]: its bytes 0 to 432 are not inside its buffer of 0");
}

TEST_F(MeshoptTest, TruncatedStreams) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
        CompressedFile file = compressedSheet(Sheet(9), mode, 4);
        file.saveCompressed(folder);
        const json whole = file.document;
        for (const size_t view : {0u, 2u}) {
            const size_t length = whole["bufferViews"][view]["extensions"][extensionName]["byteLength"];
            for (size_t shorter = 0; shorter < length; shorter += 1 + length / 64) {
                json document = whole;
                document["bufferViews"][view]["extensions"][extensionName]["byteLength"] = shorter;
                put(folder / "scene.gltf", document.dump());
                expectRefused(folder / "scene.gltf", extensionName);
            }
        }
    }
}

TEST_F(MeshoptTest, DamagedStreams) {
    int loaded = 0, refused = 0;
    CompressedFile file = compressedSheet(Sheet(9), "TRIANGLES", 4);
    const fs::path path = file.saveCompressed(folder);
    for (unsigned seed = 0; seed < 600; ++seed) {
        std::mt19937 random(seed);
        std::string damaged = file.bytes;
        for (int i = 0; i < 3; ++i)
            damaged[random() % damaged.size()] ^= static_cast<char>(1 << random() % 8);
        put(folder / "scene.bin", damaged);
        try {
            loadScene(path);
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

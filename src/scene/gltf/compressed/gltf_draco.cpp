#include "scene/gltf/compressed/gltf_draco.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <memory>

namespace limpid::scene::gltf {
namespace {

// A stream without entropy (a flat regular grid, or an attack) has the same length for a thousand triangles
// as for a billion. So expansion is limited to this; real meshes take several bits per triangle.
constexpr uint64_t trianglesOfAnyStream = uint64_t{1} << 18;
constexpr uint64_t trianglesPerByte = 32;
constexpr uint64_t maxBytesPerPoint =
    256;  // of all attributes; positions, normals, tangents and so on take about 150
constexpr uint32_t maxAttributes = 32;

/// The counts that a stream states before the connectivity.
struct Stated {
    uint32_t triangles = 0;
    uint32_t points = 0;  ///< or of vertices, which are fewer
    uint32_t attributes = 0;
};

/// Draco specification, section "Edgebreaker decoder".
bool readStated(const draco::MeshEdgebreakerDecoder&, draco::DecoderBuffer& buffer, Stated& stated) {
    uint8_t attributes = 0;
    if (!draco::DecodeVarint(&stated.points, &buffer) || !draco::DecodeVarint(&stated.triangles, &buffer) ||
        !buffer.Decode(&attributes)) {
        return false;
    }
    stated.attributes = attributes;
    return true;
}

/// Draco specification, section "Sequential decoder".
bool readStated(const draco::MeshSequentialDecoder&, draco::DecoderBuffer& buffer, Stated& stated) {
    return draco::DecodeVarint(&stated.triangles, &buffer) && draco::DecodeVarint(&stated.points, &buffer);
}

/// A Draco decoder that checks the size of each allocation beforehand.
template <typename Decoder>
class Guarded : public Decoder {
  public:
    Guarded(const DracoLimits& limits, size_t streamBytes)
        : limits_(limits), plausible_(trianglesOfAnyStream + trianglesPerByte * streamBytes) {}

    const std::string& fault() const { return fault_; }

  protected:
    bool DecodeConnectivity() override {
        draco::DecoderBuffer ahead = *this->buffer();
        Stated stated;
        if (!readStated(*this, ahead, stated)) return refuse("ends in its header");
        if (stated.triangles > limits_.triangles || stated.points > limits_.points) {
            return refuse(fmt::format("has {} triangles and {} points or more, the accessors {} and {}",
                                      stated.triangles, stated.points, limits_.triangles, limits_.points));
        }
        if (stated.triangles > plausible_ || stated.points > 3 * plausible_)
            return refuse(fmt::format("is too short for its {} triangles", stated.triangles));
        if (stated.attributes > maxAttributes)
            return refuse(fmt::format("has {} attributes, too many", stated.attributes));
        return Decoder::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        if (cloud.num_points() != limits_.points) {
            return refuse(fmt::format("has {} points, the accessors {}", cloud.num_points(), limits_.points));
        }
        uint64_t perPoint = 0;
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& a = *cloud.attribute(i);
            perPoint +=
                uint64_t{a.num_components()} * static_cast<uint64_t>(draco::DataTypeLength(a.data_type()));
        }
        if (perPoint > maxBytesPerPoint || perPoint * limits_.points > limits_.bytes)
            return refuse(fmt::format("has {} bytes a point, too many", perPoint));
        return Decoder::DecodeAllAttributes();
    }

  private:
    bool refuse(std::string fault) {
        fault_ = std::move(fault);
        return false;
    }

    DracoLimits limits_;
    uint64_t plausible_;
    std::string fault_;
};

void initialize(draco::DecoderBuffer& buffer, std::span<const std::byte> stream) {
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
}

template <typename Decoder>
void decodeWith(const Object& extension, std::span<const std::byte> stream, const DracoLimits& limits,
                draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    initialize(buffer, stream);
    Guarded<Decoder> decoder(limits, stream.size());
    std::string fault;
    try {
        const draco::DecoderOptions options;
        const draco::Status status = decoder.Decode(options, &buffer, &mesh);
        if (!status.ok()) fault = status.error_msg_string();
    } catch (const std::exception& error) {
        fault = error.what();
    }
    if (!decoder.fault().empty()) extension.fail("its Draco stream " + decoder.fault());
    if (!fault.empty()) extension.fail("its Draco stream is damaged: " + fault);
}

uint64_t componentTypeOf(const Object& extension, const draco::PointAttribute& attribute) {
    switch (attribute.data_type()) {
        case draco::DT_INT8:
            return 5120;
        case draco::DT_UINT8:
            return 5121;
        case draco::DT_INT16:
            return 5122;
        case draco::DT_UINT16:
            return 5123;
        case draco::DT_UINT32:
            return 5125;
        case draco::DT_FLOAT32:
            return 5126;
        default:
            extension.fail(fmt::format("its Draco attribute {} has a type that glTF does not have",
                                       attribute.unique_id()));
    }
}

/// Returns the values in the order of the points. Checks every index, since the stream is untrusted.
DracoAttribute readAttribute(const Object& extension, const draco::Mesh& mesh, uint64_t number) {
    const draco::PointAttribute* source =
        number <= UINT32_MAX ? mesh.GetAttributeByUniqueId(static_cast<uint32_t>(number)) : nullptr;
    if (!source) extension.fail(fmt::format("its Draco stream has no attribute {}", number));
    DracoAttribute result;
    result.componentType = componentTypeOf(extension, *source);
    result.components = source->num_components();
    const size_t size = result.components * static_cast<size_t>(draco::DataTypeLength(source->data_type()));
    const size_t available = source->buffer() ? source->buffer()->data_size() : 0;
    const bool mapped = source->is_mapping_identity() || source->indices_map_size() == mesh.num_points();
    result.values.resize(mesh.num_points() * size);
    for (uint32_t point = 0; point < mesh.num_points(); ++point) {
        const auto at =
            mapped ? source->mapped_index(draco::PointIndex(point)) : draco::kInvalidAttributeValueIndex;
        const uint64_t position =
            at.value() < source->size() ? static_cast<uint64_t>(source->GetBytePos(at)) : available;
        if (position > available || size > available - position)
            extension.fail(fmt::format("its Draco attribute {} has no value for point {}", number, point));
        std::memcpy(result.values.data() + point * size, source->buffer()->data() + position, size);
    }
    return result;
}

std::vector<uint32_t> readTriangles(const Object& extension, const draco::Mesh& mesh) {
    std::vector<uint32_t> indices;
    indices.reserve(size_t{3} * mesh.num_faces());
    for (uint32_t i = 0; i < mesh.num_faces(); ++i) {
        for (const draco::PointIndex& point : mesh.face(draco::FaceIndex(i))) {
            if (point.value() >= mesh.num_points())
                extension.fail(fmt::format("its Draco triangle {} has no such point", i));
            indices.push_back(point.value());
        }
    }
    return indices;
}

}  // namespace

bool canDecodeDraco() {
    return true;
}

DracoMesh decodeDraco(const Object& extension, std::span<const std::byte> stream,
                      std::span<const uint64_t> wanted, const DracoLimits& limits) {
    draco::DecoderBuffer buffer;
    initialize(buffer, stream);
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&buffer, &header).ok())
        extension.fail("its buffer view holds no Draco stream");
    if (header.encoder_type != draco::TRIANGULAR_MESH) extension.fail("its Draco stream holds no mesh");
    if (header.version_major != 2 || header.version_minor != 2) {
        extension.fail(fmt::format("its Draco stream has version {}.{}, only 2.2 is supported",
                                   header.version_major, header.version_minor));
    }
    draco::Mesh mesh;
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        decodeWith<draco::MeshEdgebreakerDecoder>(extension, stream, limits, mesh);
    } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
        decodeWith<draco::MeshSequentialDecoder>(extension, stream, limits, mesh);
    } else {
        extension.fail("its Draco stream has an unknown method");
    }
    DracoMesh result;
    result.indices = readTriangles(extension, mesh);
    for (const uint64_t number : wanted) result.attributes.push_back(readAttribute(extension, mesh, number));
    return result;
}

}  // namespace limpid::scene::gltf

#include "neural/tensor_file.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>

#include "base/error.h"
#include "base/files/file.h"
#include "base/text/format.h"

namespace limpid::neural {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "tensors are stored as they lie in memory");

constexpr uint64_t lengthBytes = 8, maxHeaderBytes = uint64_t{16} << 20;
constexpr size_t maxDimensions = 8;
constexpr const char* metadataKey = "__metadata__";
constexpr const char* checksumKey = "crc32";

std::string nameOf(ElementType type) {
    return type == ElementType::Float16 ? "F16" : "F32";
}

std::optional<ElementType> typeNamed(const std::string& name) {
    for (const ElementType type : {ElementType::Float16, ElementType::Float32}) {
        if (name == nameOf(type)) return type;
    }
    return std::nullopt;
}

/// Returns nothing if the size does not fit in 64 bits.
std::optional<uint64_t> sizeOf(ElementType type, std::span<const uint64_t> shape) {
    uint64_t bytes = bytesOf(type);
    for (const uint64_t extent : shape) {
        if (__builtin_mul_overflow(bytes, extent, &bytes)) return std::nullopt;
    }
    return bytes;
}

uint32_t addToChecksum(uint32_t checksum, std::span<const std::byte> bytes) {
    return static_cast<uint32_t>(
        crc32_z(checksum, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()));
}

std::string textOf(uint32_t checksum) {
    std::string text(8, '0');
    for (size_t i = text.size(); i-- > 0; checksum >>= 4) text[i] = "0123456789abcdef"[checksum & 15u];
    return text;
}

/// A tensor's description in the header.
struct Entry {
    std::string name;
    ElementType type = ElementType::Float32;
    std::vector<uint64_t> shape;
    uint64_t begin = 0, end = 0;  ///< bytes from the end of the header
};

class Reader {
  public:
    explicit Reader(const std::filesystem::path& path) : path_(path), bytes_(readFile(path)) {}

    TensorFile read() {
        const json header = parseHeader();
        TensorFile file;
        std::vector<Entry> entries;
        for (const auto& [name, value] : header.items()) {
            if (name == metadataKey)
                file.metadata = metadataOf(value);
            else
                entries.push_back(entryOf(name, value));
        }
        checkPlaces(entries);
        if (const auto stated = file.metadata.find(checksumKey); stated != file.metadata.end()) {
            const std::string actual = textOf(addToChecksum(0, data_));
            if (actual != stated->second)
                fail(formatText("is damaged: the checksum of its elements is {}, it states {}", actual,
                                stated->second));
        }
        for (const Entry& entry : entries) {
            const auto bytes = data_.subspan(entry.begin, entry.end - entry.begin);
            file.tensors[entry.name] = {entry.type, entry.shape, {bytes.begin(), bytes.end()}};
        }
        return file;
    }

  private:
    [[noreturn]] void fail(const std::string& fault) const { throw InputError(path_, fault); }

    json parseHeader() {
        if (bytes_.size() < lengthBytes) fail("is no safetensors file: it is shorter than 8 bytes");
        uint64_t length = 0;
        std::memcpy(&length, bytes_.data(), lengthBytes);
        if (length > maxHeaderBytes) fail(formatText("is no safetensors file: a header of {} bytes", length));
        if (length > bytes_.size() - lengthBytes) fail("is cut off within its header");
        const auto text = std::span(bytes_).subspan(lengthBytes, length);
        data_ = std::span(bytes_).subspan(lengthBytes + length);
        std::set<std::string> names;
        // The parser would silently keep the last of two values with one name.
        const auto checkName = [&](int depth, json::parse_event_t event, json& parsed) {
            if (depth == 1 && event == json::parse_event_t::key &&
                !names.insert(parsed.get<std::string>()).second)
                fail(formatText("'{}' occurs twice in its header", parsed.get<std::string>()));
            return true;
        };
        const auto* first = reinterpret_cast<const char*>(text.data());
        try {
            json header = json::parse(first, first + text.size(), checkName);
            if (!header.is_object()) fail("its header is no JSON object");
            return header;
        } catch (const json::exception& fault) {
            fail(formatText("its header is no JSON: {}", fault.what()));
        }
    }

    std::map<std::string, std::string> metadataOf(const json& value) const {
        std::map<std::string, std::string> metadata;
        if (!value.is_object()) fail("its metadata is not a JSON object");
        for (const auto& [name, text] : value.items()) {
            if (!text.is_string()) fail(formatText("the metadata value '{}' is not a string", name));
            metadata[name] = text.get<std::string>();
        }
        return metadata;
    }

    std::vector<uint64_t> numbersOf(const std::string& name, const json& value, const char* key) const {
        std::vector<uint64_t> numbers;
        const auto found = value.find(key);
        if (found == value.end() || !found->is_array()) fail(formatText("'{}' has no {}", name, key));
        for (const json& number : *found) {
            if (!number.is_number_unsigned())
                fail(formatText("'{}': its {} are no whole numbers", name, key));
            numbers.push_back(number.get<uint64_t>());
        }
        return numbers;
    }

    Entry entryOf(const std::string& name, const json& value) const {
        if (!value.is_object()) fail(formatText("'{}' is no JSON object", name));
        const auto type = value.find("dtype");
        if (type == value.end() || !type->is_string()) fail(formatText("'{}' has no dtype", name));
        const std::optional<ElementType> known = typeNamed(type->get<std::string>());
        if (!known)
            fail(formatText("'{}' has elements of type {}; F16 and F32 can be read", name,
                            type->get<std::string>()));
        const std::vector<uint64_t> offsets = numbersOf(name, value, "data_offsets");
        if (offsets.size() != 2)
            fail(formatText("'{}' has {} data_offsets in place of 2", name, offsets.size()));
        Entry entry{name, *known, numbersOf(name, value, "shape"), offsets[0], offsets[1]};
        if (entry.shape.size() > maxDimensions)
            fail(formatText("'{}' has {} dimensions, more than {}", name, entry.shape.size(), maxDimensions));
        if (entry.begin > entry.end || entry.end > data_.size())
            fail(formatText("'{}' ends at byte {} of {}: the file is cut off, or its header wrong", name,
                            entry.end, data_.size()));
        const std::optional<uint64_t> size = sizeOf(entry.type, entry.shape);
        if (!size || *size != entry.end - entry.begin)
            fail(formatText("'{}': its shape does not fit its {} bytes", name, entry.end - entry.begin));
        return entry;
    }

    /// Checks that tensors lie one after the other, from the first byte to the last.
    void checkPlaces(std::vector<Entry>& entries) const {
        std::ranges::sort(entries, {}, [](const Entry& entry) { return std::pair(entry.begin, entry.end); });
        uint64_t place = 0;
        for (const Entry& entry : entries) {
            if (entry.begin != place)
                fail(formatText("'{}' begins at byte {}, the tensor before it ends at {}", entry.name,
                                entry.begin, place));
            place = entry.end;
        }
        if (place != data_.size()) fail(formatText("its tensors end at byte {} of {}", place, data_.size()));
    }

    const std::filesystem::path& path_;
    std::vector<std::byte> bytes_;
    std::span<const std::byte> data_;
};

std::string headerOf(const TensorFile& file) {
    json header = json::object();
    uint64_t place = 0;
    uint32_t checksum = 0;
    for (const auto& [name, tensor] : file.tensors) {
        if (name == metadataKey || sizeOf(tensor.type, tensor.shape) != tensor.bytes.size())
            throw Error(formatText("tensor '{}' has {} bytes, which do not fit its shape", name,
                                   tensor.bytes.size()));
        const uint64_t end = place + tensor.bytes.size();
        header[name] = {
            {"dtype", nameOf(tensor.type)}, {"shape", tensor.shape}, {"data_offsets", {place, end}}};
        place = end;
        checksum = addToChecksum(checksum, tensor.bytes);
    }
    std::map<std::string, std::string> metadata = file.metadata;
    metadata[checksumKey] = textOf(checksum);
    header[metadataKey] = metadata;
    std::string text = header.dump();
    text.resize((text.size() + 7) / 8 * 8, ' ');  // aligns the elements
    return text;
}

}  // namespace

size_t bytesOf(ElementType type) {
    return type == ElementType::Float16 ? 2 : 4;
}

uint64_t Tensor::elements() const {
    return bytes.size() / bytesOf(type);
}

Tensor makeTensor(ElementType type, std::vector<uint64_t> shape, const std::vector<float>& values) {
    Tensor tensor{type, std::move(shape), std::vector<std::byte>(values.size() * bytesOf(type))};
    if (sizeOf(type, tensor.shape) != tensor.bytes.size())
        throw Error(formatText("{} values do not fit a tensor's shape", values.size()));
    for (size_t i = 0; i < values.size(); ++i) {
        const uint16_t half = glm::packHalf1x16(values[i]);
        const void* const element =
            type == ElementType::Float16 ? static_cast<const void*>(&half) : &values[i];
        std::memcpy(tensor.bytes.data() + i * bytesOf(type), element, bytesOf(type));
    }
    return tensor;
}

std::vector<float> valuesOf(const Tensor& tensor) {
    std::vector<float> values(tensor.elements());
    for (size_t i = 0; i < values.size(); ++i) {
        const std::byte* const element = tensor.bytes.data() + i * bytesOf(tensor.type);
        if (tensor.type == ElementType::Float32) {
            std::memcpy(&values[i], element, sizeof(float));
            continue;
        }
        uint16_t half = 0;
        std::memcpy(&half, element, sizeof half);
        values[i] = glm::unpackHalf1x16(half);
    }
    return values;
}

void writeTensorFile(const std::filesystem::path& path, const TensorFile& file) {
    const std::string header = headerOf(file);
    writeAtomically(path, [&](const std::filesystem::path& temporary) {
        std::ofstream stream(temporary, std::ios::binary);
        const uint64_t length = header.size();
        stream.write(reinterpret_cast<const char*>(&length), lengthBytes);
        stream << header;
        for (const auto& [name, tensor] : file.tensors)
            stream.write(reinterpret_cast<const char*>(tensor.bytes.data()),
                         static_cast<std::streamsize>(tensor.bytes.size()));
        stream.close();
        if (!stream) throw OutputError(path, "could not be written");
    });
}

TensorFile readTensorFile(const std::filesystem::path& path) {
    return Reader(path).read();
}

}  // namespace limpid::neural

// Named tensors in files: the format safetensors (https://github.com/huggingface/safetensors, "Format"),
// which PyTorch's users know: 8 bytes of length, so much JSON, then the tensors' elements, all little-endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace limpid::neural {

enum class ElementType { Float16, Float32 };

size_t bytesOf(ElementType type);

struct Tensor {
    ElementType type = ElementType::Float32;
    std::vector<uint64_t> shape;   ///< slowest first; none: a single element
    std::vector<std::byte> bytes;  ///< elements without gaps, the last dimension fastest

    uint64_t elements() const;
    bool operator==(const Tensor&) const = default;
};

/// Of values in the order of Tensor::bytes. Float16 is rounded to the nearest. Throws Error if there are more
/// or fewer than the shape says.
Tensor makeTensor(ElementType type, std::vector<uint64_t> shape, const std::vector<float>& values);

/// In the order of Tensor::bytes.
std::vector<float> valuesOf(const Tensor& tensor);

struct TensorFile {
    std::map<std::string, std::string> metadata;
    std::map<std::string, Tensor> tensors;
};

/// Written so that an earlier file survives a failure (base/files/file.h), with the checksum of all elements,
/// CRC-32 in hexadecimal, as metadata "crc32". Tensors lie in the order of their names. Throws OutputError,
/// or Error where a tensor's bytes do not fit its shape.
void writeTensorFile(const std::filesystem::path& path, const TensorFile& file);

/// Throws InputError for a file that cannot be read or is no such file: a header that is cut off, over 16 MiB
/// or not the format's JSON; names that stand twice; element types other than F16 and F32; more than 8
/// dimensions; tensors that overlap, leave gaps or do not fill the file; elements that do not have the
/// checksum that the metadata states (other writers state none).
TensorFile readTensorFile(const std::filesystem::path& path);

}  // namespace limpid::neural

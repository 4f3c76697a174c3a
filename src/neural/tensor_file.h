// Reads and writes named tensors in the safetensors format (https://github.com/huggingface/safetensors,
// "Format"), which is common in the PyTorch world: 8 bytes with the header's length, the header as JSON, then
// the tensors' elements, all little-endian.
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
    std::vector<uint64_t> shape;   ///< slowest dimension first; empty: a single element
    std::vector<std::byte> bytes;  ///< elements without gaps, the last dimension fastest

    uint64_t elements() const;
    bool operator==(const Tensor&) const = default;
};

/// `values` are in the order of Tensor::bytes. Float16 is rounded to nearest. Throws Error if their number
/// does not match the shape.
Tensor makeTensor(ElementType type, std::vector<uint64_t> shape, const std::vector<float>& values);

/// Returns the values in the order of Tensor::bytes.
std::vector<float> valuesOf(const Tensor& tensor);

struct TensorFile {
    std::map<std::string, std::string> metadata;
    std::map<std::string, Tensor> tensors;
};

/// Writes the file atomically, so that an earlier file survives a failure (base/files/file.h). Stores the
/// checksum of all elements, CRC-32 in hexadecimal, as metadata "crc32". Sorts tensors by name. Throws
/// OutputError, or Error if a tensor's bytes do not fit its shape.
void writeTensorFile(const std::filesystem::path& path, const TensorFile& file);

/// Throws InputError if the file cannot be read or is invalid: a header that is truncated, over 16 MiB or not
/// the format's JSON; duplicate names; element types other than F16 and F32; more than 8 dimensions; tensors
/// that overlap, leave gaps or do not fill the file; elements that do not match the checksum in the metadata
/// (other programs write none).
TensorFile readTensorFile(const std::filesystem::path& path);

}  // namespace limpid::neural

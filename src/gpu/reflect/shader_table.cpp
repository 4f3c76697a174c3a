#include "gpu/reflect/shader_table.h"

#include <ostream>

namespace limpid::gpu {
namespace {

const char* enumerator(ShaderStage stage) {
    switch (stage) {
        case ShaderStage::Compute:
            return "gpu::ShaderStage::Compute";
        case ShaderStage::RayGeneration:
            return "gpu::ShaderStage::RayGeneration";
        case ShaderStage::Miss:
            return "gpu::ShaderStage::Miss";
        case ShaderStage::ClosestHit:
            return "gpu::ShaderStage::ClosestHit";
        case ShaderStage::AnyHit:
            return "gpu::ShaderStage::AnyHit";
    }
    return "";
}

const char* enumerator(BindingKind kind) {
    switch (kind) {
        case BindingKind::StorageImage:
            return "gpu::BindingKind::StorageImage";
        case BindingKind::SampledImage:
            return "gpu::BindingKind::SampledImage";
        case BindingKind::StorageTexelBuffer:
            return "gpu::BindingKind::StorageTexelBuffer";
        case BindingKind::StorageBuffer:
            return "gpu::BindingKind::StorageBuffer";
        case BindingKind::UniformBuffer:
            return "gpu::BindingKind::UniformBuffer";
        case BindingKind::AccelerationStructure:
            return "gpu::BindingKind::AccelerationStructure";
    }
    return "";
}

const char* enumerator(Format format) {
    switch (format) {
        case Format::R32Float:
            return "gpu::Format::R32Float";
        case Format::R32Uint:
            return "gpu::Format::R32Uint";
        case Format::RG32Float:
            return "gpu::Format::RG32Float";
        case Format::RG32Uint:
            return "gpu::Format::RG32Uint";
        case Format::RGBA32Float:
            return "gpu::Format::RGBA32Float";
        case Format::RGBA32Uint:
            return "gpu::Format::RGBA32Uint";
        case Format::R16Float:
            return "gpu::Format::R16Float";
        case Format::RGBA16Float:
            return "gpu::Format::RGBA16Float";
        case Format::RGBA8Unorm:
            return "gpu::Format::RGBA8Unorm";
    }
    return "";
}

void write(std::ostream& out, const ShaderBinding& b) {
    out << "    {\"" << b.name << "\", " << b.binding << ", " << enumerator(b.kind) << ", "
        << enumerator(b.format) << ", " << (b.readable ? "true" : "false") << ", "
        << (b.writable ? "true" : "false") << ", " << b.blockSize << "},\n";
}

void write(std::ostream& out, const ShaderConstant& constant) {
    out << "    {\"" << constant.name << "\", " << constant.id << "},\n";
}

/// An array must not be empty, but a span may be.
template <typename Row>
void writeRows(std::ostream& out, const char* type, const char* name, std::span<const Row> rows) {
    if (rows.empty()) {
        out << "constexpr std::span<const " << type << "> " << name << "{};\n";
        return;
    }
    out << "constexpr " << type << " " << name << "[] = {\n";
    for (const Row& row : rows) write(out, row);
    out << "};\n";
}

void write(std::ostream& out, const std::array<uint32_t, 3>& numbers) {
    out << "{" << numbers[0] << "u, " << numbers[1] << "u, " << numbers[2] << "u}";
}

}  // namespace

void writeWords(std::ostream& out, std::span<const uint32_t> words) {
    out << "constexpr uint32_t words[] = {";
    for (size_t i = 0; i < words.size(); ++i) out << (i % 8 == 0 ? "\n    " : " ") << words[i] << "u,";
    out << "\n};\n";
}

void writeReflection(std::ostream& out, const ShaderReflection& reflection) {
    writeRows(out, "gpu::ShaderBinding", "bindings", reflection.bindings);
    writeRows(out, "gpu::ShaderConstant", "constants", reflection.constants);
    out << "constexpr gpu::ShaderReflection reflection{\n    " << enumerator(reflection.stage)
        << ", bindings, constants, ";
    write(out, reflection.workgroupSize);
    out << ", ";
    write(out, reflection.workgroupSizeIds);
    out << "};\n";
}

void writeHash(std::ostream& out, uint64_t hash) {
    out << "constexpr uint64_t hash = " << hash << "u;\n";
}

}  // namespace limpid::gpu

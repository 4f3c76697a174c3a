// A shader as data: its SPIR-V and what it declares. The build makes such tables (src/gpu/reflect); this
// header is light, because each embedded shader includes it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace limpid::gpu {

enum class ShaderStage { Compute, RayGeneration, Miss, ClosestHit, AnyHit };

enum class BindingKind {
    StorageImage,
    SampledImage,  ///< read by texelFetch(), any format; `format` tells float from unsigned components
    StorageTexelBuffer,
    StorageBuffer,
    UniformBuffer,
    AccelerationStructure
};
inline constexpr size_t bindingKindCount = 6;

/// Pixel and texel formats that Limpid uses. Names like Float32x4 stand for the components of an image as the
/// shader declares it.
enum class Format {
    R32Float,
    R32Uint,
    RG32Float,
    RG32Uint,
    RGBA32Float,
    RGBA32Uint,
    R16Float,
    RGBA16Float,
    RGBA8Unorm
};

uint32_t bytesPerTexel(Format format);
uint32_t componentCount(Format format);
bool hasUnsignedComponents(Format format);
std::string_view toString(Format format);
std::span<const Format> allFormats();

/// One resource that the shader declares, named as in GLSL.
struct ShaderBinding {
    std::string_view name;
    uint32_t binding = 0;
    BindingKind kind = BindingKind::StorageImage;
    Format format = Format::RGBA32Float;  ///< for images and texel buffers
    bool readable = true;                 ///< false if declared `writeonly`
    bool writable = true;                 ///< false if declared `readonly`
    uint32_t blockSize = 0;               ///< bytes, for uniform buffers

    bool operator==(const ShaderBinding&) const = default;
};

/// A specialisation constant: layout(constant_id = id) const T name = ...;
struct ShaderConstant {
    std::string_view name;
    uint32_t id = 0;

    bool operator==(const ShaderConstant&) const = default;
};

/// Everything that a shader declares, used or not. It views static tables, or tables that another object
/// owns.
struct ShaderReflection {
    ShaderStage stage = ShaderStage::Compute;
    std::span<const ShaderBinding> bindings;  ///< of descriptor set 0, sorted by binding number
    std::span<const ShaderConstant> constants;
    std::array<uint32_t, 3> workgroupSize{};  ///< for compute shaders
    /// The constant ids of layout(local_size_x_id = ...); noConstant if the size is fixed.
    std::array<uint32_t, 3> workgroupSizeIds{noConstant, noConstant, noConstant};

    static constexpr uint32_t noConstant = UINT32_MAX;
    const ShaderBinding* find(std::string_view name) const;
};

/// One shader. limpid_shaders() (cmake/LimpidTargets.cmake) embeds it as a static constant: SPIR-V that is
/// optimised and stripped, and the reflection of glslc's original output. A view, like ShaderReflection.
struct ShaderCode {
    std::string_view name;  ///< path of the source below src/, for messages
    std::span<const uint32_t> words;
    ShaderReflection reflection;
    uint64_t hash = 0;  ///< of words and reflection; equal hashes mean the same shader
};

}  // namespace limpid::gpu

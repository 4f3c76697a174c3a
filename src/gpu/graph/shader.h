// Shaders as data: their SPIR-V and what reflection says of it. Needs neither a device nor SPIRV-Cross: the
// tables are made at build time (src/gpu/reflect).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limpid::gpu {

enum class ShaderStage { Compute, RayGeneration, Miss, ClosestHit, AnyHit };

enum class BindingKind {
    StorageImage,
    SampledImage,  ///< read by texelFetch(), of any format: float components, or unsigned ones (Format tells)
    StorageTexelBuffer,
    StorageBuffer,
    UniformBuffer,
    AccelerationStructure
};
inline constexpr size_t bindingKindCount = 6;

/// Pixel and texel formats that Limpid uses. Float32x4 etc.: components of an image as the shader declares
/// it.
enum class Format {
    R32Float,
    R32Uint,
    RG32Float,
    RG32Uint,
    RGBA32Float,
    RGBA32Uint,
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
    Format format = Format::RGBA32Float;  ///< of images and texel buffers
    bool readable = true;                 ///< false if declared `writeonly`
    bool writable = true;                 ///< false if declared `readonly`
    uint32_t blockSize = 0;               ///< bytes, of a uniform buffer

    bool operator==(const ShaderBinding&) const = default;
};

/// A specialisation constant: layout(constant_id = id) const T name = ...;
struct ShaderConstant {
    std::string_view name;
    uint32_t id = 0;

    bool operator==(const ShaderConstant&) const = default;
};

/// What a shader declares, used or not. A view: of static tables, or of what else owns names and lists.
struct ShaderReflection {
    ShaderStage stage = ShaderStage::Compute;
    std::span<const ShaderBinding> bindings;  ///< of descriptor set 0, in the order of their numbers
    std::span<const ShaderConstant> constants;
    std::array<uint32_t, 3> workgroupSize{};  ///< of compute shaders
    /// The constant ids of layout(local_size_x_id = ...); noConstant where the size is fixed.
    std::array<uint32_t, 3> workgroupSizeIds{noConstant, noConstant, noConstant};

    static constexpr uint32_t noConstant = UINT32_MAX;
    const ShaderBinding* find(std::string_view name) const;
};

/// One shader. limpid_shaders() (cmake/LimpidTargets.cmake) embeds it as a constant of static lifetime, its
/// SPIR-V optimised and stripped, with the reflection of what glslc wrote. A view, like ShaderReflection.
struct ShaderCode {
    std::string_view name;  ///< path of the source below src/, for messages
    std::span<const uint32_t> words;
    ShaderReflection reflection;
    uint64_t hash = 0;  ///< of words and reflection; equal: the same shader
};

/// Whether code that binds and dispatches the one can do so with the other.
bool sameInterface(const ShaderReflection& a, const ShaderReflection& b);

/// Shaders by the names of those that they take the place of. Each pointer owns all that its ShaderCode
/// views.
using ShaderReplacements = std::map<std::string, std::shared_ptr<const ShaderCode>, std::less<>>;

/// What several stages of one pipeline declare together, bindings in the order of their numbers.
struct MergedDeclarations {
    std::vector<ShaderBinding> bindings;
    std::vector<ShaderConstant> constants;
};

/// Adds what a stage declares. Throws Error naming `shader`, which the stage is from, if it and those before
/// it disagree about a binding or a constant.
void merge(MergedDeclarations& into, const ShaderReflection& stage, std::string_view shader);

}  // namespace limpid::gpu

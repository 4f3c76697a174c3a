// Shaders as data: their SPIR-V and what reflection says of it. Needs no device.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace limpid::gpu {

/// SPIR-V embedded at build time by limpid_shaders() (cmake/LimpidTargets.cmake).
struct ShaderCode {
    std::string_view name;  ///< path of the source below src/, for messages
    std::span<const uint32_t> words;
};

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
    std::string name;
    uint32_t binding = 0;
    BindingKind kind = BindingKind::StorageImage;
    Format format = Format::RGBA32Float;  ///< of images and texel buffers
    bool readable = true;                 ///< false if declared `writeonly`
    bool writable = true;                 ///< false if declared `readonly`
    uint32_t blockSize = 0;               ///< bytes, of a uniform buffer
};

/// A specialisation constant: layout(constant_id = id) const T name = ...;
struct ShaderConstant {
    std::string name;
    uint32_t id = 0;
};

struct ShaderReflection {
    ShaderStage stage = ShaderStage::Compute;
    std::vector<ShaderBinding> bindings;  ///< descriptor set 0 only; another set is an error
    std::vector<ShaderConstant> constants;
    std::array<uint32_t, 3> workgroupSize{};  ///< of compute shaders
    /// The constant ids of layout(local_size_x_id = ...); noConstant where the size is fixed.
    std::array<uint32_t, 3> workgroupSizeIds{noConstant, noConstant, noConstant};

    static constexpr uint32_t noConstant = UINT32_MAX;
    const ShaderBinding* find(std::string_view name) const;
};

/// Reads the bindings of a shader with SPIRV-Cross: all that the SPIR-V declares, used or not (glslc
/// without -O keeps unused ones), in the order of their binding numbers. A buffer block is named by its
/// instance, or by the block if it has none. Constants that have no GLSL name are left out. Throws Error
/// naming the shader if it uses what Limpid does not (samplers, push constants, arrays of resources,
/// another set than 0, an unlisted format, several uniform blocks, two variables at one binding).
ShaderReflection reflect(const ShaderCode& code);

/// Whether code that binds and dispatches the one can do so with the other.
bool sameInterface(const ShaderReflection& a, const ShaderReflection& b);

/// SPIR-V by the names of the shaders that it takes the place of.
using ShaderReplacements = std::map<std::string, std::vector<uint32_t>, std::less<>>;

/// What several stages of one pipeline declare together. Throws Error naming `other` if the two disagree
/// about a binding or a constant.
void merge(ShaderReflection& into, const ShaderReflection& from, std::string_view other);

}  // namespace limpid::gpu

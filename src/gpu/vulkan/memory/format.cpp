#include "gpu/vulkan/memory/format.h"

#include "base/error.h"

namespace limpid::gpu {
namespace {

struct Row {
    Format format;
    std::string_view name;
    uint32_t bytes, components;
    VkFormat vulkan;
};

constexpr Row rows[] = {
    {Format::R32Float, "R32Float", 4, 1, VK_FORMAT_R32_SFLOAT},
    {Format::R32Uint, "R32Uint", 4, 1, VK_FORMAT_R32_UINT},
    {Format::RG32Float, "RG32Float", 8, 2, VK_FORMAT_R32G32_SFLOAT},
    {Format::RG32Uint, "RG32Uint", 8, 2, VK_FORMAT_R32G32_UINT},
    {Format::RGBA32Float, "RGBA32Float", 16, 4, VK_FORMAT_R32G32B32A32_SFLOAT},
    {Format::RGBA32Uint, "RGBA32Uint", 16, 4, VK_FORMAT_R32G32B32A32_UINT},
    {Format::RGBA16Float, "RGBA16Float", 8, 4, VK_FORMAT_R16G16B16A16_SFLOAT},
    {Format::RGBA8Unorm, "RGBA8Unorm", 4, 4, VK_FORMAT_R8G8B8A8_UNORM},
};

constexpr Format formats[] = {Format::R32Float,    Format::R32Uint,     Format::RG32Float,
                              Format::RG32Uint,    Format::RGBA32Float, Format::RGBA32Uint,
                              Format::RGBA16Float, Format::RGBA8Unorm};

const Row& row(Format format) {
    for (const Row& r : rows) {
        if (r.format == format) return r;
    }
    throw Error("not a pixel format: " + std::to_string(static_cast<int>(format)));
}

}  // namespace

uint32_t bytesPerTexel(Format format) {
    return row(format).bytes;
}

uint32_t componentCount(Format format) {
    return row(format).components;
}

std::string_view toString(Format format) {
    return row(format).name;
}

VkFormat toVulkan(Format format) {
    return row(format).vulkan;
}

std::span<const Format> allFormats() {
    return formats;
}

}  // namespace limpid::gpu

// The sizes and names of formats.
#include "base/error.h"
#include "gpu/graph/shader_code.h"

namespace limpid::gpu {
namespace {

struct Row {
    Format format;
    std::string_view name;
    uint32_t bytes, components;
};

constexpr Row rows[] = {
    {Format::R32Float, "R32Float", 4, 1},        {Format::R32Uint, "R32Uint", 4, 1},
    {Format::RG32Float, "RG32Float", 8, 2},      {Format::RG32Uint, "RG32Uint", 8, 2},
    {Format::RGBA32Float, "RGBA32Float", 16, 4}, {Format::RGBA32Uint, "RGBA32Uint", 16, 4},
    {Format::R16Float, "R16Float", 2, 1},        {Format::RGBA16Float, "RGBA16Float", 8, 4},
    {Format::RGBA8Unorm, "RGBA8Unorm", 4, 4},
};

constexpr Format formats[] = {Format::R32Float, Format::R32Uint,     Format::RG32Float,
                              Format::RG32Uint, Format::RGBA32Float, Format::RGBA32Uint,
                              Format::R16Float, Format::RGBA16Float, Format::RGBA8Unorm};

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

bool hasUnsignedComponents(Format format) {
    return format == Format::R32Uint || format == Format::RG32Uint || format == Format::RGBA32Uint;
}

std::string_view toString(Format format) {
    return row(format).name;
}

std::span<const Format> allFormats() {
    return formats;
}

}  // namespace limpid::gpu

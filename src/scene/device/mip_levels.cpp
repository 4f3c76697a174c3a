#include "scene/device/mip_levels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "image/color.h"

namespace limpid::scene {
namespace {

struct Level {
    uint32_t width, height;
    std::vector<vec4> texels;  ///< linear
};

uint32_t encodeByte(float linear, bool srgb) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    const float encoded = srgb ? image::srgbEncode(x) : x;
    return static_cast<uint32_t>(encoded * 255.0f + 0.5f);
}

vec4 texelAt(const Texture& texture, uint32_t x, uint32_t y) {
    const uint8_t* p = &texture.rgba[(size_t{y} * texture.width + x) * 4];
    const auto color = [&](uint8_t byte) {
        return texture.srgb ? srgbToLinear(byte) : static_cast<float>(byte) / 255.0f;
    };
    return {color(p[0]), color(p[1]), color(p[2]), static_cast<float>(p[3]) / 255.0f};
}

/// `texel(x, y)` returns the linear values of the level above, which has the given size.
template <typename Texel>
Level halve(uint32_t width, uint32_t height, const Texel& texel) {
    Level to{std::max(1u, width / 2), std::max(1u, height / 2), {}};
    to.texels.resize(size_t{to.width} * to.height);
    for (uint32_t y = 0; y < to.height; ++y) {
        // A plain 2x2 average would drop an odd row or column, so the last cell extends to the edge.
        const uint32_t y0 = std::min(2 * y, height - 1), y1 = y + 1 == to.height ? height : 2 * y + 2;
        for (uint32_t x = 0; x < to.width; ++x) {
            const uint32_t x0 = std::min(2 * x, width - 1), x1 = x + 1 == to.width ? width : 2 * x + 2;
            vec4 sum(0.0f);
            for (uint32_t j = y0; j < y1; ++j) {
                for (uint32_t i = x0; i < x1; ++i) sum += texel(i, j);
            }
            to.texels[size_t{y} * to.width + x] = sum / static_cast<float>((x1 - x0) * (y1 - y0));
        }
    }
    return to;
}

uint32_t wrapped(float coordinate, uint32_t size, Wrap wrap) {
    const auto n = static_cast<float>(size);
    float x = std::isfinite(coordinate) ? coordinate : 0.0f;
    if (wrap == Wrap::Repeat) x -= std::floor(x);
    if (wrap == Wrap::MirroredRepeat) x = 1.0f - std::abs(std::fmod(std::abs(x), 2.0f) - 1.0f);
    return static_cast<uint32_t>(std::clamp(x * n, 0.0f, n - 1.0f));
}

}  // namespace

float srgbToLinear(uint8_t encoded) {
    static const auto table = [] {
        std::array<float, 256> values{};
        for (size_t i = 0; i < values.size(); ++i)
            values[i] = image::srgbDecode(static_cast<float>(i) / 255.0f);
        return values;
    }();
    return table[encoded];
}

uint32_t mipLevelCount(const Texture& texture) {
    return static_cast<uint32_t>(std::bit_width(std::max(texture.width, texture.height)));
}

uint64_t mipTexelCount(const Texture& texture) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < mipLevelCount(texture); ++i)
        sum += uint64_t{std::max(1u, texture.width >> i)} * std::max(1u, texture.height >> i);
    return sum;
}

void writeMipLevels(const Texture& texture, std::span<uint32_t> result) {
    const uint8_t* p = texture.rgba.data();
    auto out = result.begin();
    for (size_t i = 0; i < size_t{texture.width} * texture.height; ++i, p += 4)
        *out++ = uint32_t{p[0]} | uint32_t{p[1]} << 8 | uint32_t{p[2]} << 16 | uint32_t{p[3]} << 24;
    Level level{texture.width, texture.height, {}};
    for (uint32_t i = 1; i < mipLevelCount(texture); ++i) {
        // The first level is never stored as floats, which would take four times the picture's memory.
        level = i == 1 ? halve(level.width, level.height,
                               [&](uint32_t x, uint32_t y) { return texelAt(texture, x, y); })
                       : halve(level.width, level.height, [&](uint32_t x, uint32_t y) {
                             return level.texels[size_t{y} * level.width + x];
                         });
        for (const vec4& t : level.texels) {
            *out++ = encodeByte(t.r, texture.srgb) | encodeByte(t.g, texture.srgb) << 8 |
                     encodeByte(t.b, texture.srgb) << 16 | encodeByte(t.a, false) << 24;
        }
    }
}

std::vector<uint32_t> withMipLevels(const Texture& texture) {
    std::vector<uint32_t> result(mipTexelCount(texture));
    writeMipLevels(texture, result);
    return result;
}

vec4 nearestTexel(const Texture& texture, vec2 uv) {
    return texelAt(texture, wrapped(uv.x, texture.width, texture.sampler.wrapU),
                   wrapped(uv.y, texture.height, texture.sampler.wrapV));
}

}  // namespace limpid::scene

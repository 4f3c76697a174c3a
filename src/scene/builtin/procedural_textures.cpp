#include "scene/builtin/procedural_textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace limpid::scene {
namespace {

uint32_t hash(uint32_t x, uint32_t y, uint32_t seed) {
    uint32_t h = x * 0x9e3779b1u ^ (y + 0x7f4a7c15u) * 0x85ebca77u ^ (seed + 1u) * 0xc2b2ae3du;
    h = (h ^ (h >> 15)) * 0x2c1b3c6du;
    h = (h ^ (h >> 12)) * 0x297a2d39u;
    return h ^ (h >> 15);
}

float random01(uint32_t x, uint32_t y, uint32_t seed) {
    return static_cast<float>(hash(x, y, seed) >> 8) * 0x1p-24f;
}

uint8_t toByte(float value) {
    return static_cast<uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Makes a texture with the colour paint(uv) at the centre of every texel.
template <typename Paint>
Texture painted(std::string name, uint32_t width, uint32_t height, bool srgb, const Paint& paint) {
    Texture texture;
    texture.name = std::move(name);
    texture.width = width;
    texture.height = height;
    texture.srgb = srgb;
    texture.rgba.resize(size_t{4} * width * height);
    tbb::parallel_for(uint32_t{0}, height, [&](uint32_t y) {
        uint8_t* texel = &texture.rgba[size_t{4} * width * y];
        for (uint32_t x = 0; x < width; ++x, texel += 4) {
            const vec3 color = paint(vec2((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                                          (static_cast<float>(y) + 0.5f) / static_cast<float>(height)));
            texel[0] = toByte(color.r);
            texel[1] = toByte(color.g);
            texel[2] = toByte(color.b);
            texel[3] = 255;
        }
    });
    return texture;
}

float smoothstep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

/// Smooth noise, 0 to 1, from random values at the corners of cells.x by cells.y cells; tiles over 0 to 1.
float valueNoise(const vec2& uv, const uvec2& cells, uint32_t seed) {
    const vec2 p = (uv - glm::floor(uv)) * vec2(cells);
    const uvec2 first = uvec2(p) % cells;
    const vec2 inside = p - glm::floor(p);
    const float tx = smoothstep(0.0f, 1.0f, inside.x), ty = smoothstep(0.0f, 1.0f, inside.y);
    const auto corner = [&](uint32_t dx, uint32_t dy) {
        return random01((first.x + dx) % cells.x, (first.y + dy) % cells.y, seed);
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), tx), glm::mix(corner(0, 1), corner(1, 1), tx), ty);
}

/// Noise of five octaves, 0 to 1.
float cloudNoise(const vec2& uv, uint32_t cells, uint32_t seed) {
    float sum = 0.0f, weight = 0.5f;
    for (uint32_t octave = 0; octave < 5; ++octave, weight *= 0.5f)
        sum += weight * valueNoise(uv, uvec2(cells << octave), seed + octave);
    return sum / 0.96875f;
}

/// Makes a normal map of a height field with central differences; `depth` is in units of the picture's size.
template <typename Height>
Texture normalsOf(std::string name, uint32_t size, float depth, const Height& height) {
    const float step = 1.0f / static_cast<float>(size);
    return painted(std::move(name), size, size, false, [&](const vec2& uv) {
        const float alongU = height(uv + vec2(step, 0.0f)) - height(uv - vec2(step, 0.0f));
        const float alongV = height(uv + vec2(0.0f, step)) - height(uv - vec2(0.0f, step));
        // Green points up the picture, against v.
        const vec3 n = glm::normalize(vec3(-alongU * depth, alongV * depth, 2.0f * step));
        return 0.5f * n + 0.5f;
    });
}

struct BrickPoint {
    uint32_t column = 0, course = 0;
    float height = 0.0f;  ///< 0 in the mortar, about 1 on a brick
};

BrickPoint brickAt(const vec2& at) {
    constexpr uint32_t columns = 4, courses = 8;
    vec2 uv = at - glm::floor(at);
    BrickPoint point;
    point.course = std::min(static_cast<uint32_t>(uv.y * courses), courses - 1);
    const float shifted = uv.x * columns + (point.course % 2 == 0 ? 0.0f : 0.5f);
    point.column = static_cast<uint32_t>(shifted) % columns;
    const vec2 inside(shifted - std::floor(shifted), uv.y * courses - static_cast<float>(point.course));
    // Distance to the brick's edge, in units of a course's height; a brick is twice as long as high.
    const float edge =
        std::min(2.0f * std::min(inside.x, 1.0f - inside.x), std::min(inside.y, 1.0f - inside.y));
    point.height = smoothstep(0.05f, 0.14f, edge) * (0.85f + 0.3f * cloudNoise(uv, 16, 7));
    return point;
}

/// Returns whether `uv` is on ink of a printed text: each character is a random pattern of 5 x 7 dots.
bool isInk(const vec2& uv, uint32_t columns, uint32_t lines) {
    const vec2 p = uv * vec2(columns, lines);
    const auto column = static_cast<uint32_t>(p.x), line = static_cast<uint32_t>(p.y);
    const vec2 inside = p - glm::floor(p);
    const auto dotX = static_cast<uint32_t>(inside.x * 6.0f), dotY = static_cast<uint32_t>(inside.y * 9.0f);
    const bool gap = dotX >= 5 || dotY >= 7 || hash(column / 2, line, 11) % 7 == 0;
    // Mirror-symmetric, like many letters.
    return !gap && hash(std::min(dotX, 4 - dotX) + 8 * dotY, column + 64 * line, 13) % 2 == 0;
}

vec3 hueColor(float hue) {
    const auto ramp = [&](float offset) {
        const float h = hue + offset - std::floor(hue + offset);
        return std::clamp(std::abs(h * 6.0f - 3.0f) - 1.0f, 0.0f, 1.0f);
    };
    return {ramp(0.0f), ramp(2.0f / 3.0f), ramp(1.0f / 3.0f)};
}

vec3 checkerPatch(const vec2& uv) {
    // The size of squares halves from column to column.
    const auto column = static_cast<uint32_t>(uv.x * 4.0f);
    const float squares = static_cast<float>(8u << column);
    const auto x = static_cast<uint32_t>(uv.x * squares), y = static_cast<uint32_t>(uv.y * squares * 0.75f);
    return (x + y) % 2 == 0 ? vec3(0.9f) : vec3(0.12f, 0.12f, 0.2f);
}

vec3 printPatch(const vec2& uv) {
    const bool ink = uv.y < 0.4f ? isInk(uv * vec2(1.0f, 2.5f), 12, 3)
                                 : isInk((uv - vec2(0.0f, 0.4f)) * vec2(1.0f, 1.0f / 0.6f), 36, 12);
    return ink ? vec3(0.1f, 0.08f, 0.08f) : vec3(0.92f, 0.9f, 0.82f);
}

vec3 colorPatch(const vec2& uv) {
    return glm::mix(vec3(0.85f), 0.85f * hueColor(uv.x), smoothstep(0.0f, 0.6f, uv.y)) *
           (1.0f - 0.8f * smoothstep(0.6f, 1.0f, uv.y));
}

vec3 ringPatch(const vec2& uv) {
    const vec2 p = (uv - vec2(0.5f)) * vec2(4.0f / 3.0f, 1.0f);
    const float wave = 0.5f + 0.5f * std::cos(140.0f * glm::dot(p, p));
    return glm::mix(vec3(0.55f, 0.12f, 0.1f), vec3(0.95f, 0.85f, 0.55f), wave);
}

}  // namespace

Texture checkerTexture(uint32_t squares, const vec3& first, const vec3& second) {
    return painted("checker", 256, 256, true, [&](const vec2& uv) {
        const auto x = static_cast<uint32_t>(uv.x * static_cast<float>(squares)),
                   y = static_cast<uint32_t>(uv.y * static_cast<float>(squares));
        return (x + y) % 2 == 0 ? first : second;
    });
}

Texture brickTexture() {
    return painted("bricks", 512, 512, true, [](const vec2& uv) {
        const BrickPoint point = brickAt(uv);
        const float shade = random01(point.column, point.course, 3),
                    tint = random01(point.column, point.course, 4);
        const vec3 clay = glm::mix(vec3(0.55f, 0.25f, 0.18f), vec3(0.75f, 0.42f, 0.3f), shade) +
                          vec3(0.0f, 0.06f * tint, 0.03f * tint);
        const float grain = 0.8f + 0.4f * cloudNoise(uv, 32, 5);
        return glm::mix(vec3(0.72f, 0.7f, 0.66f), clay, std::min(point.height, 1.0f)) * grain;
    });
}

Texture brickNormalTexture() {
    return normalsOf("brick normals", 512, 0.012f, [](const vec2& uv) { return brickAt(uv).height; });
}

Texture noiseTexture(uint32_t cells, const vec3& dark, const vec3& bright) {
    return painted("noise", 256, 256, true, [&](const vec2& uv) {
        return glm::mix(dark, bright, smoothstep(0.2f, 0.8f, cloudNoise(uv, cells, 21)));
    });
}

Texture woodTexture() {
    Texture texture = painted("wood", 512, 512, true, [](const vec2& uv) {
        const vec2 wave(0.06f * (cloudNoise(uv, 3, 31) - 0.5f), 0.12f * (cloudNoise(uv, 2, 37) - 0.5f));
        const vec2 p = (uv + wave - vec2(0.45f, -0.2f)) * vec2(1.0f, 0.25f);
        const float ring = 22.0f * glm::length(p), phase = ring - std::floor(ring);
        // Late wood darkens slowly and ends abruptly.
        const float late = smoothstep(0.1f, 0.9f, phase) * (1.0f - smoothstep(0.92f, 1.0f, phase));
        const float fibre = valueNoise(uv, {128, 16}, 41);
        return glm::mix(vec3(0.8f, 0.62f, 0.42f), vec3(0.58f, 0.38f, 0.23f), late) * (0.85f + 0.2f * fibre);
    });
    texture.sampler.wrapU = texture.sampler.wrapV = Wrap::MirroredRepeat;
    return texture;
}

Texture hammeredNormalTexture() {
    const auto height = [](const vec2& at) {
        constexpr uint32_t cells = 12;
        const vec2 p = (at - glm::floor(at)) * static_cast<float>(cells);
        const auto x = static_cast<uint32_t>(p.x), y = static_cast<uint32_t>(p.y);
        float nearest = 2.0f;
        for (uint32_t i = 0; i < 9; ++i) {
            const uint32_t cx = x + i % 3, cy = y + i / 3;  // one more than the cell's index
            const uint32_t wx = (cx + cells - 1) % cells, wy = (cy + cells - 1) % cells;
            const vec2 dent(static_cast<float>(cx) - 1.0f + random01(wx, wy, 51),
                            static_cast<float>(cy) - 1.0f + random01(wx, wy, 52));
            nearest = std::min(nearest, glm::distance(p, dent));
        }
        return nearest * nearest;
    };
    return normalsOf("hammered normals", 256, 0.02f, height);
}

Texture wornRoughnessTexture(float smooth, float rough) {
    return painted("worn", 512, 512, false, [&](const vec2& uv) {
        const float patches = smoothstep(0.4f, 0.6f, cloudNoise(uv, 6, 61));
        // Stretched noise looks like scratches.
        const float scratches = smoothstep(0.86f, 0.9f, valueNoise(uv, {8, 128}, 67));
        return vec3(1.0f, glm::mix(smooth, rough, std::max(patches, 0.7f * scratches)), 1.0f);
    });
}

Texture testPictureTexture() {
    Texture texture = painted("test picture", 1024, 768, true, [](const vec2& uv) {
        const vec2 fromEdge = glm::min(uv, vec2(1.0f) - uv) * vec2(4.0f / 3.0f, 1.0f);
        if (std::min(fromEdge.x, fromEdge.y) < 0.02f) return vec3(0.85f);
        const vec2 patch = 2.0f * uv - glm::floor(2.0f * uv);
        if (uv.y < 0.5f) return uv.x < 0.5f ? checkerPatch(patch) : printPatch(patch);
        return uv.x < 0.5f ? colorPatch(patch) : ringPatch(patch);
    });
    texture.sampler.wrapU = texture.sampler.wrapV = Wrap::ClampToEdge;
    return texture;
}

}  // namespace limpid::scene

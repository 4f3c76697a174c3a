#include "shot/motion/guide_pyramid.h"

#include <algorithm>
#include <cmath>

#include "shot/frame/pixel_layers.h"

namespace limpid::shot {
namespace {

constexpr int smallestSide = 24;

uint8_t byteOf(float value) {
    return static_cast<uint8_t>(std::clamp(std::isfinite(value) ? value : 0.0f, 0.0f, 255.0f) + 0.5f);
}

GuideLevel finestLevel(const ShotLayers& layers) {
    const image::Image* const albedo = layers.find("albedo");
    const image::Image* const normal = layers.find("normal");
    const image::Image* const depth = layers.find("depth");
    GuideLevel level{static_cast<int>(layers.width), static_cast<int>(layers.height), {}};
    level.texels.resize(size_t{layers.width} * layers.height);
    forEachPixel(level.texels.size(), [&](size_t p) {
        GuideTexel texel{};
        for (size_t c = 0; c < 3; ++c) {
            if (albedo) texel[c] = byteOf(255.0f * std::sqrt(std::max(albedo->pixels[3 * p + c], 0.0f)));
            if (normal) texel[3 + c] = byteOf(127.5f + 127.5f * normal->pixels[3 * p + c]);
        }
        const float z = depth ? depth->pixels[p] : 0.0f;
        if (depth) texel[6] = z > 0.0f ? byteOf(128.0f + 10.0f * std::log2(std::min(z, 1e30f))) : uint8_t{0};
        level.texels[p] = texel;
    });
    return level;
}

/// With the weights 1 2 1 in both directions.
GuideLevel smoothed(const GuideLevel& from) {
    GuideLevel to = from;
    forEachPixel(to.texels.size(), [&](size_t p) {
        const int x = static_cast<int>(p) % from.width, y = static_cast<int>(p) / from.width;
        std::array<int, 8> sum{};
        for (int v = -1; v <= 1; ++v)
            for (int u = -1; u <= 1; ++u) {
                const GuideTexel& texel = from.clamped(x + u, y + v);
                for (size_t c = 0; c < sum.size(); ++c) sum[c] += texel[c] << (2 - std::abs(u) - std::abs(v));
            }
        for (size_t c = 0; c < sum.size(); ++c) to.texels[p][c] = static_cast<uint8_t>((sum[c] + 8) / 16);
    });
    return to;
}

GuideLevel halved(const GuideLevel& from) {
    GuideLevel to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
    to.texels.resize(static_cast<size_t>(to.width) * static_cast<size_t>(to.height));
    forEachPixel(to.texels.size(), [&](size_t p) {
        const int x = 2 * (static_cast<int>(p) % to.width), y = 2 * (static_cast<int>(p) / to.width);
        const GuideTexel* const four[] = {&from.at(x, y), &from.clamped(x + 1, y), &from.clamped(x, y + 1),
                                          &from.clamped(x + 1, y + 1)};
        for (size_t c = 0; c < to.texels[p].size(); ++c) {
            int sum = 2;
            for (const GuideTexel* texel : four) sum += (*texel)[c];
            to.texels[p][c] = static_cast<uint8_t>(sum / 4);
        }
    });
    return to;
}

}  // namespace

const GuideTexel& GuideLevel::clamped(int x, int y) const {
    return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
}

std::vector<GuideLevel> guidePyramid(const ShotLayers& layers) {
    std::vector<GuideLevel> levels;
    if (!layers.find("albedo") && !layers.find("normal")) return levels;
    levels.push_back(smoothed(finestLevel(layers)));
    while (std::min(levels.back().width, levels.back().height) > smallestSide)
        levels.push_back(halved(levels.back()));
    return levels;
}

}  // namespace limpid::shot

// Tests the textures of the built-in scenes: deterministic, with the expected range of values, and seamless.
#include "scene/builtin/procedural_textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace limpid::scene::test {
namespace {

struct Painter {
    const char* name;
    std::function<Texture()> paint;
    bool repeats = true;
    bool normals = false;
};

std::vector<Painter> painters() {
    return {{"checker", [] { return checkerTexture(8, vec3(1.0f), vec3(0.0f)); }, false},
            {"bricks", brickTexture},
            {"brick normals", brickNormalTexture, true, true},
            {"noise", [] { return noiseTexture(4, vec3(0.1f), vec3(0.9f)); }},
            {"wood", woodTexture, false},
            {"hammered normals", hammeredNormalTexture, true, true},
            {"worn", [] { return wornRoughnessTexture(0.1f, 0.6f); }},
            {"test picture", testPictureTexture, false}};
}

uint8_t texel(const Texture& texture, uint32_t x, uint32_t y, size_t channel) {
    return texture.rgba[4 * (size_t{y} * texture.width + x) + channel];
}

/// Returns the mean difference between two columns of texels over all channels.
double difference(const Texture& texture, uint32_t column, uint32_t other) {
    double sum = 0.0;
    for (uint32_t y = 0; y < texture.height; ++y) {
        for (size_t c = 0; c < 3; ++c)
            sum += std::abs(int{texel(texture, column, y, c)} - int{texel(texture, other, y, c)});
    }
    return sum / (3.0 * texture.height);
}

TEST(ProceduralTextures, AreTheSameEveryTimeAndOpaque) {
    for (const Painter& painter : painters()) {
        SCOPED_TRACE(painter.name);
        const Texture first = painter.paint(), second = painter.paint();
        EXPECT_EQ(first.rgba, second.rgba);
        ASSERT_EQ(first.rgba.size(), size_t{4} * first.width * first.height);
        EXPECT_EQ(first.srgb, !painter.normals && first.name != "worn");
        for (size_t i = 3; i < first.rgba.size(); i += 4) ASSERT_EQ(first.rgba[i], 255);
        const auto [low, high] = std::minmax_element(first.rgba.begin(), first.rgba.end());
        EXPECT_LT(*low + 50, *high) << "shows something";
    }
}

/// The difference between the last and first column is like that between neighbouring columns.
TEST(ProceduralTextures, RepeatWithoutASeam) {
    for (const Painter& painter : painters()) {
        if (!painter.repeats) continue;
        const Texture texture = painter.paint();
        double largest = 0.0;
        for (uint32_t x = 0; x + 1 < texture.width; ++x)
            largest = std::max(largest, difference(texture, x, x + 1));
        EXPECT_LE(difference(texture, texture.width - 1, 0), largest) << painter.name;
    }
}

TEST(ProceduralTextures, NormalsAreUnitAndLeanBothWays) {
    for (const Painter& painter : painters()) {
        if (!painter.normals) continue;
        SCOPED_TRACE(painter.name);
        const Texture texture = painter.paint();
        vec3 low(1.0f), high(-1.0f);
        for (uint32_t y = 0; y < texture.height; ++y) {
            for (uint32_t x = 0; x < texture.width; ++x) {
                const vec3 n =
                    vec3(texel(texture, x, y, 0), texel(texture, x, y, 1), texel(texture, x, y, 2)) / 127.5f -
                    1.0f;
                ASSERT_NEAR(glm::length(n), 1.0f, 0.02f);
                low = glm::min(low, n);
                high = glm::max(high, n);
            }
        }
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_LT(low[axis], -0.2f);
            EXPECT_GT(high[axis], 0.2f);
        }
        EXPECT_GT(low.z, 0.0f);
    }
}

TEST(ProceduralTextures, CheckerAlternates) {
    const Texture texture = checkerTexture(4, vec3(1.0f), vec3(0.0f));
    const uint32_t square = texture.width / 4;
    for (uint32_t y = 0; y < 4; ++y) {
        for (uint32_t x = 0; x < 4; ++x)
            EXPECT_EQ(texel(texture, x * square, y * square, 0), (x + y) % 2 == 0 ? 255 : 0);
    }
}

}  // namespace
}  // namespace limpid::scene::test

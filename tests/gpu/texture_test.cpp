// Compares texture look-up with a plain C++ version in double precision, written from OpenGL ES 3.0, section
// 3.8.10, which glTF's samplers refer to.
#include <algorithm>
#include <cmath>
#include <random>

#include "scene/builtin/mesh_builder.h"
#include "tests/gpu/gpu_fixture.h"
#include "texture_test.comp.h"

namespace limpid::test {
namespace {

using dvec4 = glm::dvec4;
using scene::MipFilter;
using scene::Sampler;
using scene::Texture;
using scene::Wrap;

struct Query {
    vec2 uv;
    float lod;  ///< for a texture of one texel, as for sampleTexture()
    uint32_t ref;
};

double decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

int64_t wrap(int64_t x, int64_t size, Wrap mode) {
    switch (mode) {
        case Wrap::Repeat:
            return ((x % size) + size) % size;
        case Wrap::ClampToEdge:
            return std::clamp<int64_t>(x, 0, size - 1);
        case Wrap::MirroredRepeat:
            break;
    }
    const int64_t m = ((x % (2 * size)) + 2 * size) % (2 * size);
    return m < size ? m : 2 * size - 1 - m;
}

/// One mip level as stored on the device.
struct Level {
    int64_t width, height;
    const uint32_t* texels;
};

dvec4 texel(const Level& level, const Texture& texture, int64_t x, int64_t y) {
    const int64_t column = wrap(x, level.width, texture.sampler.wrapU),
                  row = wrap(y, level.height, texture.sampler.wrapV);
    const uint32_t word = level.texels[row * level.width + column];
    dvec4 result;
    for (int i = 0; i < 4; ++i) {
        const double value = (word >> (8 * i) & 255u) / 255.0;
        result[i] = texture.srgb && i < 3 ? decode(value) : value;
    }
    return result;
}

dvec4 sampleLevel(const Level& level, const Texture& texture, const vec2& uv, bool linear) {
    const double u = double{uv.x} * static_cast<double>(level.width),
                 v = double{uv.y} * static_cast<double>(level.height);
    if (!linear) {
        return texel(level, texture, static_cast<int64_t>(std::floor(u)),
                     static_cast<int64_t>(std::floor(v)));
    }
    const double i = std::floor(u - 0.5), j = std::floor(v - 0.5), a = u - 0.5 - i, b = v - 0.5 - j;
    const auto at = [&](int di, int dj) {
        return texel(level, texture, static_cast<int64_t>(i) + di, static_cast<int64_t>(j) + dj);
    };
    return (1 - a) * (1 - b) * at(0, 0) + a * (1 - b) * at(1, 0) + (1 - a) * b * at(0, 1) + a * b * at(1, 1);
}

dvec4 reference(const std::vector<Level>& levels, const Texture& texture, const Query& query) {
    const double area = static_cast<double>(levels[0].width) * static_cast<double>(levels[0].height);
    const double lambda = double{query.lod} + 0.5 * std::log2(area);
    const Sampler& s = texture.sampler;
    if (lambda <= 0.0) return sampleLevel(levels[0], texture, query.uv, s.magLinear);
    const double last = static_cast<double>(levels.size()) - 1.0, level = std::min(lambda, last);
    if (s.mip == MipFilter::None) return sampleLevel(levels[0], texture, query.uv, s.minLinear);
    if (s.mip == MipFilter::Nearest) {
        return sampleLevel(levels[static_cast<size_t>(std::ceil(level + 0.5) - 1.0)], texture, query.uv,
                           s.minLinear);
    }
    const auto low = static_cast<size_t>(level);
    const double f = level - std::floor(level);
    const dvec4 a = sampleLevel(levels[low], texture, query.uv, s.minLinear);
    return f > 0.0 ? (1.0 - f) * a + f * sampleLevel(levels[low + 1], texture, query.uv, s.minLinear) : a;
}

std::string describe(const Texture& t) {
    const Sampler& s = t.sampler;
    return fmt::format("{}x{} srgb {} wrap {} {} mag {} min {} mip {}", t.width, t.height, t.srgb,
                       static_cast<int>(s.wrapU), static_cast<int>(s.wrapV), s.magLinear, s.minLinear,
                       static_cast<int>(s.mip));
}

/// Textures of noise with every combination of wrap modes and filters, in sizes that are not powers of two.
std::vector<Texture> allTextures() {
    std::vector<Texture> textures;
    std::mt19937 random(7);
    constexpr uint32_t sizes[][2] = {{1, 1}, {3, 5}, {8, 4}, {13, 29}, {33, 17}, {1, 7}};
    size_t next = 0;
    for (const Wrap u : {Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat}) {
        for (const Wrap v : {Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat}) {
            for (const MipFilter mip : {MipFilter::None, MipFilter::Nearest, MipFilter::Linear}) {
                for (int filters = 0; filters < 4; ++filters) {
                    Texture t;
                    const auto& size = sizes[next++ % std::size(sizes)];
                    t.width = size[0];
                    t.height = size[1];
                    t.srgb = next % 2 == 0;
                    t.sampler = {u, v, (filters & 1) != 0, (filters & 2) != 0, mip};
                    t.rgba.resize(size_t{t.width} * t.height * 4);
                    for (uint8_t& byte : t.rgba) byte = static_cast<uint8_t>(random());
                    textures.push_back(std::move(t));
                }
            }
        }
    }
    return textures;
}

class TextureTest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped()) build(allTextures());
    }

    void build(std::vector<Texture> textures) {
        scene_.textures = std::move(textures);
        for (size_t i = 0; i < scene_.textures.size(); ++i) {
            scene_.materials.emplace_back();
            scene_.materials[i].baseColorTexture.texture = static_cast<int>(i);
        }
        scene_.meshes.push_back(
            scene::MeshBuilder("triangle").triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).take());
        scene_.instances.emplace_back();
        data_ = scene::buildSceneData(scene_);
        gpuScene_ = std::make_unique<scene::GpuScene>(device(), data_);
    }

    /// Returns the levels of texture i: one reference per material, in order.
    std::vector<Level> levels(size_t i) const {
        const uvec4* ref = &data_.textureRefs[i * layout::TEXTURE_REF_TEXELS];
        const uint32_t* texels = &data_.texels[0][ref[0].w];
        std::vector<Level> result;
        int64_t width = ref[2].x, height = ref[2].y;
        for (uint32_t level = 0; level < ref[2].z; ++level) {
            result.push_back({width, height, texels});
            texels += width * height;
            width = std::max<int64_t>(width / 2, 1);
            height = std::max<int64_t>(height / 2, 1);
        }
        return result;
    }

    std::vector<vec4> look(const std::vector<Query>& queries) {
        const auto count = static_cast<uint32_t>(queries.size());
        const gpu::Buffer buffer = upload("queries", queries);
        const Job job{.shader = shaders::texture_test_comp,
                      .scene = gpuScene_.get(),
                      .buffers = {{"queries", &buffer}},
                      .params = gpu::paramsOf(count),
                      .count = count};
        return run<vec4>(job, count);
    }

    /// If float32 cannot decide on which side of an edge between two texels (or levels) a point lies, either
    /// result is accepted.
    bool matches(const Query& query, const vec4& found) const {
        const Texture& texture = scene_.textures[query.ref];
        const std::vector<Level> all = levels(query.ref);
        for (const float lodShift : {0.0f, -1e-5f, 1e-5f}) {
            for (int shift = 0; shift < 9; ++shift) {
                Query q = query;
                const float step = 1e-6f;
                q.lod += lodShift;
                q.uv.x += static_cast<float>(shift % 3 - 1) * step * std::max(1.0f, std::abs(q.uv.x));
                q.uv.y += static_cast<float>(shift / 3 - 1) * step * std::max(1.0f, std::abs(q.uv.y));
                const dvec4 expected = reference(all, texture, q);
                const dvec4 difference = glm::abs(expected - dvec4(found));
                // A linear filter's weights change with the rounding of uv times the size.
                const double size = std::max(texture.width, texture.height);
                const double rounding = 4e-7 * size * double{std::max(std::abs(q.uv.x), std::abs(q.uv.y))};
                const double tolerance = 1e-3 + rounding;
                if (std::max({difference.x, difference.y, difference.z, difference.w}) < tolerance)
                    return true;
            }
        }
        return false;
    }

    void check(const std::vector<Query>& queries) {
        const std::vector<vec4> found = look(queries);
        int failures = 0;
        for (size_t i = 0; i < queries.size() && failures < 5; ++i) {
            if (matches(queries[i], found[i])) continue;
            ++failures;
            const Query& q = queries[i];
            const Texture& texture = scene_.textures[q.ref];
            const dvec4 expected = reference(levels(q.ref), texture, q);
            ADD_FAILURE() << describe(texture)
                          << fmt::format(" uv {} {} lod {}: {} {} {} {}, expected {} {} {} {}", q.uv.x,
                                         q.uv.y, q.lod, found[i].x, found[i].y, found[i].z, found[i].w,
                                         expected.x, expected.y, expected.z, expected.w);
        }
        // Repeating gives the same bits.
        const std::vector<vec4> again = look(queries);
        EXPECT_EQ(std::memcmp(found.data(), again.data(), found.size() * sizeof(vec4)), 0);
    }

    const scene::Scene& scene() const { return scene_; }

  private:
    scene::Scene scene_;
    scene::SceneData data_;
    std::unique_ptr<scene::GpuScene> gpuScene_;
};

TEST_F(TextureTest, EveryWrapFilterAndLevel) {
    std::vector<Query> queries;
    std::mt19937 random(1);
    for (uint32_t i = 0; i < scene().textures.size(); ++i) {
        for (int n = 0; n < 200; ++n) {
            const auto uniform = [&](float low, float high) {
                return std::uniform_real_distribution<float>(low, high)(random);
            };
            queries.push_back({{uniform(-3, 4), uniform(-3, 4)}, uniform(-7, 3), i});
        }
    }
    check(queries);
}

/// Texel centres and exact repetitions, where incorrect rounding becomes visible.
TEST_F(TextureTest, CentresAndWholePeriods) {
    std::vector<Query> queries;
    for (uint32_t i = 0; i < scene().textures.size(); ++i) {
        const auto width = static_cast<float>(scene().textures[i].width),
                   height = static_cast<float>(scene().textures[i].height);
        for (int period = -40; period <= 40; period += 5) {
            for (int n = 0; n < 8; ++n) {
                const float x = (static_cast<float>(n % 4) + 0.5f) / width,
                            y = (static_cast<float>(n) + 0.5f) / height;
                queries.push_back(
                    {{static_cast<float>(period) + x, static_cast<float>(-period) + y}, -20.0f, i});
            }
        }
    }
    check(queries);
}

TEST_F(TextureTest, FarCoordinates) {
    std::vector<Query> queries;
    std::mt19937 random(2);
    for (uint32_t i = 0; i < scene().textures.size(); ++i) {
        const Texture& texture = scene().textures[i];
        if (texture.width * texture.height > 40) continue;
        for (int n = 0; n < 40; ++n) {
            // Multiples of 1/64: exact in float32, as is their product with a small size.
            const auto coordinate = [&] {
                return static_cast<float>(static_cast<int>(random() % 400000) - 200000) / 64.0f;
            };
            queries.push_back({{coordinate() + 1 / 128.0f, coordinate() + 1 / 128.0f}, -20.0f, i});
        }
    }
    check(queries);
    // Beyond any precision: returns some texel of the picture, without a crash or NaN.
    for (Query& q : queries) q.uv = {1e30f, -3e12f};
    for (const vec4& value : look(queries)) {
        for (int k = 0; k < 4; ++k) ASSERT_TRUE(value[k] >= 0.0f && value[k] <= 1.0001f) << value[k];
    }
}

}  // namespace
}  // namespace limpid::test

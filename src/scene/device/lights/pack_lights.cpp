#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "scene/device/lights/lamps.h"
#include "scene/device/lights/light_tree.h"
#include "scene/device/mip_levels.h"
#include "scene/device/pack.h"
#include "scene/device/tables/weight_pyramid.h"
#include "scene/model/transform.h"

namespace limpid::scene {
namespace {

/// The probability of sampling the environment in next-event estimation if there are other lights.
constexpr float environmentShare = 0.5f;
/// The same for an even environment, which directions of the material find as well.
constexpr float evenEnvironmentShare = 0.25f;
/// An environment of less contrast() is sampled by the cosine at the surface. Sampling a diffuse surface that
/// sees half of the sphere by texel, the cosine alone gives a relative variance of 5/3.
constexpr double maxEvenContrast = 1.0;
/// The minimum probabilities of triangles and of punctual lights among the other samples, if there are both.
constexpr double minTriangleShare = 0.2, minPunctualShare = 0.35;
/// A lamp of emissive triangles that power would give fewer of all samples needs the tree: near it, it may
/// cause all the light.
constexpr double minLampProbability = 0.1;
/// With fewer point and spot lights there is no choice in which distance maps could help.
constexpr size_t minMappedLights = 2;
/// The share of triangle samples that is divided equally among all lamps; the rest is distributed by power.
constexpr double uniformShare = 0.25;

double luminance(const vec3& c) {
    return 0.2126 * double{c.r} + 0.7152 * double{c.g} + 0.0722 * double{c.b};
}

vec2 transformed(const TextureRef& ref, const vec2& uv) {
    const vec3 p(uv, 1.0f);
    return {glm::dot(ref.rowU, p), glm::dot(ref.rowV, p)};
}

/// The mean radiance of a triangle, by luminance and by strengthOf().
struct MeanRadiance {
    double luminance = 0.0, strength = 0.0;
};

MeanRadiance meanOf(const vec3& radiance) {
    return {luminance(radiance), strengthOf(radiance)};
}

/// Returns the mean of the emission texture over a triangle, from points as dense as its texels (16 to 1,024
/// points).
MeanRadiance meanOfTexture(const Texture& texture, const TextureRef& ref, const vec3& factor, vec2 a, vec2 b,
                           vec2 c) {
    a = transformed(ref, a);
    b = transformed(ref, b);
    c = transformed(ref, c);
    const vec2 e1 = (b - a) * vec2(texture.width, texture.height),
               e2 = (c - a) * vec2(texture.width, texture.height);
    const double texels = 0.5 * std::abs(e1.x * e2.y - e1.y * e2.x);
    const int side =
        static_cast<int>(std::clamp(std::sqrt(2.0 * (std::isfinite(texels) ? texels : 0.0)), 5.0, 45.0));
    MeanRadiance sum;
    int count = 0;
    for (int i = 0; i < side; ++i) {
        for (int j = 0; i + j < side; ++j) {
            const float u = (static_cast<float>(i) + 1.0f / 3.0f) / static_cast<float>(side);
            const float v = (static_cast<float>(j) + 1.0f / 3.0f) / static_cast<float>(side);
            const MeanRadiance at =
                meanOf(vec3(nearestTexel(texture, a + u * (b - a) + v * (c - a))) * factor);
            sum.luminance += at.luminance;
            sum.strength += at.strength;
            ++count;
        }
    }
    return {sum.luminance / count, sum.strength / count};
}

class LightPacker {
  public:
    LightPacker(const Scene& scene, SceneData& data) : scene_(scene), data_(data) {}

    void pack(std::optional<bool> hasTree) {
        for (size_t i = 0; i < scene_.instances.size(); ++i) packInstance(i);
        data_.features.triangleLights = !weights_.empty();
        packPunctuals();
        const WeightPyramid table = buildWeightPyramid(triangleWeights());
        data_.lightPyramid = table.records;
        setProbabilities(table);
        for (MovingLights& moving : data_.motion.lights) {
            for (size_t i = 0; i < moving.triangles.size(); ++i)
                moving.probabilities.push_back(table.probabilities[moving.firstLight + i]);
        }
        data_.lightDensity.resize(lightOfPrimitive_.size(), 0.0f);
        for (size_t i = 0; i < lightOfPrimitive_.size(); ++i) {
            const uint32_t light = lightOfPrimitive_[i];
            if (light != layout::NONE && areas_[light] > 0.0f) {
                data_.lightDensity[i] = table.probabilities[light] / areas_[light];
            }
        }
        data_.params.triangleLightCount = static_cast<uint32_t>(weights_.size());
        data_.features.lightTree = hasTree.value_or(needsTree(table));
        packTree();
    }

  private:
    /// True if power would starve a lamp. An even environment, which takes fewer samples, counts as any
    /// other.
    bool needsTree(const WeightPyramid& table) const {
        if (scene_.lights.size() - suns_.size() > maxEvaluatedLights) return true;
        std::vector<double> ofLamp(lampCount_);
        for (size_t i = 0; i < weights_.size(); ++i) ofLamp[lamps_[i]] += double{table.probabilities[i]};
        double share = scene_.environment.empty() ? 1.0 : 1.0 - double{environmentShare};
        if (data_.features.punctualLights) share *= double{data_.params.triangleLightProbability};
        return std::ranges::any_of(
            ofLamp, [&](double lamp) { return lamp > 0.0 && share * lamp < minLampProbability; });
    }

    /// Packs nodes, trails, and the list of directional lights.
    void packTree() {
        data_.features.suns = !suns_.empty();
        data_.features.lightDistances = scene_.lights.size() - suns_.size() >= minMappedLights;
        if (!data_.features.lightTree) return;
        LightTree tree(bounds_, weights_.size());
        data_.lightTree = packLightTree(tree);
        data_.params.firstLightTrail = static_cast<uint32_t>(data_.lightTree.size());
        for (const uint32_t light : lightOfPrimitive_) {
            data_.lightTree.push_back(light == layout::NONE ? uvec4(0u) : tree.trail(light));
        }
        data_.params.firstSun = static_cast<uint32_t>(data_.lightTree.size());
        data_.params.sunCount = static_cast<uint32_t>(suns_.size());
        for (const uint32_t sun : suns_) data_.lightTree.emplace_back(sun, 0u, 0u, 0u);
        const bool moves =
            !data_.motion.lights.empty() ||
            std::ranges::any_of(scene_.lights, [](const auto& light) { return light.node != none; });
        if (moves) data_.motion.lightTree = std::move(tree);
    }

    /// Of triangles.
    void setProbabilities(const WeightPyramid& table) {
        for (size_t i = 0; i < table.probabilities.size(); ++i)
            data_.lights[i * layout::LIGHT_TEXELS + 1].w = bits(table.probabilities[i]);
    }

    /// Weights by power, and partly equal for every lamp, since it is unknown how much of a lamp's power
    /// reaches a surface.
    std::vector<double> triangleWeights() const {
        const double sum = std::accumulate(weights_.begin(), weights_.end(), 0.0);
        std::vector<double> ofLamp(lampCount_);
        for (size_t i = 0; i < weights_.size(); ++i) ofLamp[lamps_[i]] += weights_[i];
        const auto lamps =
            std::count_if(ofLamp.begin(), ofLamp.end(), [](double power) { return power > 0.0; });
        if (lamps < 2) return weights_;
        std::vector<double> result;
        for (size_t i = 0; i < weights_.size(); ++i) {
            const double power = weights_[i], whole = std::max(ofLamp[lamps_[i]], 1e-300);
            result.push_back((1.0 - uniformShare) * power / sum +
                             uniformShare * power / whole / static_cast<double>(lamps));
        }
        return result;
    }

    void packPunctuals() {
        const double triangles = std::accumulate(weights_.begin(), weights_.end(), 0.0);
        std::vector<double> powers;
        for (const PunctualLight& light : scene_.lights) powers.push_back(packPunctual(light));
        data_.features.punctualLights = !scene_.lights.empty();
        data_.params.punctualCount = static_cast<uint32_t>(scene_.lights.size());
        const double sum = std::accumulate(powers.begin(), powers.end(), triangles);
        const double share = sum > 0.0 ? triangles / sum : 0.5;
        data_.params.triangleLightProbability =
            weights_.empty()
                ? 0.0f
                : static_cast<float>(std::clamp(share, minTriangleShare, 1.0 - minPunctualShare));
    }

    void packInstance(size_t index) {
        const Instance& instance = scene_.instances[index];
        const Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
        const std::vector<uint32_t> emitters = emissiveTriangles(instance, mesh);
        if (emitters.empty()) return;
        const std::vector<uint32_t> lamps = lampsOf(mesh, emitters);
        const size_t tableStart = lightOfPrimitive_.size();
        MovingLights moving{static_cast<uint32_t>(index),
                            static_cast<uint32_t>(weights_.size()),
                            static_cast<uint32_t>(tableStart),
                            {},
                            {},
                            {}};
        lightOfPrimitive_.resize(tableStart + mesh.triangleCount(), layout::NONE);
        for (size_t i = 0; i < emitters.size(); ++i) {
            lightOfPrimitive_[tableStart + emitters[i]] =
                packTriangle(index, instance, mesh, emitters[i], lampCount_ + lamps[i]);
            moving.triangles.push_back(emitters[i]);
            moving.radiances.push_back(radiances_.back());
        }
        lampCount_ += 1 + *std::ranges::max_element(lamps);
        data_.instances[index * layout::INSTANCE_TEXELS + 3].y = static_cast<uint32_t>(tableStart);
        if (instance.movement != Movement::Still) data_.motion.lights.push_back(std::move(moving));
    }

    static uint32_t materialOf(const Instance& instance, const Mesh& mesh, size_t triangle) {
        const size_t slot = mesh.materialSlots.empty() ? 0 : mesh.materialSlots[triangle];
        return static_cast<uint32_t>(static_cast<size_t>(instance.material) + slot);
    }

    std::vector<uint32_t> emissiveTriangles(const Instance& instance, const Mesh& mesh) const {
        std::vector<uint32_t> result;
        for (size_t t = 0; t < mesh.triangleCount(); ++t) {
            if (isEmitter(scene_.materials[materialOf(instance, mesh, t)]))
                result.push_back(static_cast<uint32_t>(t));
        }
        return result;
    }

    uint32_t packTriangle(size_t instanceIndex, const Instance& instance, const Mesh& mesh, size_t t,
                          size_t lamp) {
        const uint32_t materialIndex = materialOf(instance, mesh, t);
        const Material& material = scene_.materials[materialIndex];
        const uint32_t* index = &mesh.indices[3 * t];
        std::array<vec3, 3> own{}, v{};
        for (size_t k = 0; k < 3; ++k) {
            own[k] = mesh.positions[index[k]];
            v[k] = transformPoint(instance.transform, own[k]);
        }
        const uvec4& record = data_.instances[instanceIndex * layout::INSTANCE_TEXELS + 3];
        // Rays meet triangles of the static tree in the world.
        const bool hasTree = (record.w & layout::INSTANCE_HAS_TREE) != 0u;
        const uint32_t magnitude = hasTree ? packMagnitude(instance.transform, own, v) : 0u;
        if (glm::determinant(mat3(instance.transform)) < 0.0f) std::swap(v[1], v[2]);
        MeanRadiance radiance = meanOf(material.emission);
        const TextureRef& ref = material.emissionTexture;
        if (ref) {
            const std::vector<vec2>& uv = ref.uvSet == 1 ? mesh.uv1 : mesh.uv0;
            const vec2 zero(0.0f);
            radiance = meanOfTexture(scene_.textures[static_cast<size_t>(ref.texture)], ref,
                                     material.emission, uv.empty() ? zero : uv[index[0]],
                                     uv.empty() ? zero : uv[index[1]], uv.empty() ? zero : uv[index[2]]);
        }
        const double area = triangleArea(v);
        const double sides = material.doubleSided ? 2.0 : 1.0;
        const uint32_t kind =
            material.doubleSided ? layout::LIGHT_TRIANGLE_TWO_SIDED : layout::LIGHT_TRIANGLE;
        const uint32_t firstTriangle = record.z;
        const bool mirrored = glm::determinant(mat3(instance.transform)) < 0.0f;
        data_.lights.push_back(bits(v[0], kind | (mirrored ? layout::LIGHT_MIRRORED : 0u) | magnitude));
        data_.lights.push_back(bits(v[1], 0u));
        data_.lights.push_back(bits(v[2], firstTriangle + static_cast<uint32_t>(t)));
        // Varies between points or with direction, or is not all there.
        const bool changes = ref || material.clearcoat > 0.0f || material.alphaMode != AlphaMode::Opaque;
        data_.lights.push_back(bits(material.emission, changes ? materialIndex : layout::NONE));
        areas_.push_back(static_cast<float>(area));
        radiances_.push_back(static_cast<float>(radiance.strength));
        bounds_.push_back(triangleLightBounds(v, radiance.strength, material.doubleSided));
        return addWeight(std::numbers::pi * area * sides * radiance.luminance, lamp);
    }

    /// Returns its power. A spot counts as if it shone in all directions: outside its cone other lights
    /// matter, but inside it is that bright.
    double packPunctual(const PunctualLight& light) {
        const double strength = luminance(light.intensity);
        uint32_t kind = light.kind == PunctualLight::Kind::Spot ? layout::LIGHT_SPOT : layout::LIGHT_POINT;
        double power = 4.0 * std::numbers::pi * strength;
        if (light.kind == PunctualLight::Kind::Directional) {
            kind = layout::LIGHT_DIRECTIONAL;
            power = std::numbers::pi * double{data_.params.sceneRadius} * data_.params.sceneRadius * strength;
        }
        data_.lights.push_back(bits(light.position, kind));
        data_.lights.push_back(bits(light.direction, 0u));
        data_.lights.push_back(
            bits(vec3(std::cos(light.innerCone), std::cos(light.outerCone), light.range), 0u));
        data_.lights.push_back(bits(light.intensity, 0u));
        if (light.kind == PunctualLight::Kind::Directional) {
            suns_.push_back(static_cast<uint32_t>(bounds_.size()));
            bounds_.emplace_back().inTree = false;
        } else {
            bounds_.push_back(punctualLightBounds(light));
        }
        return finite(power);
    }

    static double finite(double weight) { return std::isfinite(weight) ? std::max(weight, 0.0) : 0.0; }

    uint32_t addWeight(double weight, size_t lamp) {
        weights_.push_back(finite(weight));
        lamps_.push_back(lamp);
        return static_cast<uint32_t>(weights_.size() - 1);
    }

    const Scene& scene_;
    SceneData& data_;
    std::vector<double> weights_;  ///< powers of the triangle lights, which come first
    std::vector<size_t> lamps_;    ///< the lamp that each belongs to (lamps.h)
    size_t lampCount_ = 0;
    std::vector<float> areas_, radiances_;    ///< of the triangle lights
    std::vector<LightBounds> bounds_;         ///< of all lights; empty ones of directional lights
    std::vector<uint32_t> suns_;              ///< the directional lights
    std::vector<uint32_t> lightOfPrimitive_;  ///< index of the light, or NONE, for every primitive of an
                                              ///< emissive instance
};

/// Weights each texel by what a bilinear look-up can return there: a tent filter over the neighbours, times
/// the texel's solid angle.
std::vector<double> environmentWeights(const Environment& env) {
    const auto width = static_cast<int>(env.width), height = static_cast<int>(env.height);
    std::vector<double> weights(size_t{env.width} * env.height);
    tbb::parallel_for(0, height, [&](int y) {
        const double sine = std::sin(std::numbers::pi * (y + 0.5) / height);
        for (int x = 0; x < width; ++x) {
            double sum = 0.0;
            for (int dy = -1; dy <= 1; ++dy) {
                const int row = std::clamp(y + dy, 0, height - 1);
                for (int dx = -1; dx <= 1; ++dx) {
                    const int column = (x + dx + width) % width;
                    sum +=
                        (2 - std::abs(dx)) * (2 - std::abs(dy)) / 16.0 *
                        luminance(
                            env.radiance[static_cast<size_t>(row) * env.width + static_cast<size_t>(column)]);
                }
            }
            weights[static_cast<size_t>(y) * env.width + static_cast<size_t>(x)] = std::max(sum, 0.0) * sine;
        }
    });
    return weights;
}

/// The variance of its luminance over all directions, relative to the squared mean; 0 if it is black.
double contrast(const Environment& env) {
    double weights = 0.0, sum = 0.0, squares = 0.0;
    for (uint32_t y = 0; y < env.height; ++y) {
        const double sine = std::sin(std::numbers::pi * (y + 0.5) / env.height);
        for (uint32_t x = 0; x < env.width; ++x) {
            const double value = luminance(env.radiance[size_t{y} * env.width + x]);
            weights += sine;
            sum += sine * value;
            squares += sine * value * value;
        }
    }
    return sum > 0.0 ? squares * weights / (sum * sum) - 1.0 : 0.0;
}

void packEnvironment(const Environment& env, SceneData& data) {
    data.features.environment = true;
    data.params.environmentIsEven = contrast(env) < maxEvenContrast ? 1u : 0u;
    // Free memory early: an environment of 8,192 by 4,096 pixels has 400 MB of weights.
    WeightPyramid pyramid = buildWeightPyramid(environmentWeights(env), env.width, env.height);
    data.environmentPyramid = std::move(pyramid.records);
    data.environment.reserve(env.radiance.size());
    for (size_t i = 0; i < env.radiance.size(); ++i) {
        data.environment.emplace_back(env.radiance[i], pyramid.probabilities[i]);
    }
    setEnvironmentParams(env, data.params);
    data.params.environmentWidth = env.width;
    data.params.environmentHeight = env.height;
}

float largestIn(const std::array<vec3, 3>& points) {
    const vec3 largest = glm::max(glm::abs(points[0]), glm::max(glm::abs(points[1]), glm::abs(points[2])));
    return std::max(largest.x, std::max(largest.y, largest.z));
}

}  // namespace

double triangleArea(const std::array<vec3, 3>& corners) {
    const vec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
    const float largest = largestIn({edge1, edge2, vec3(0.0f)});
    if (!(largest > 0.0f)) return 0.0;
    // A power of two changes no digit.
    const int exponent = std::max(std::ilogb(largest), -126);
    const float scale = std::ldexp(1.0f, -exponent);
    return std::ldexp(0.5 * double{glm::length(glm::cross(scale * edge1, scale * edge2))}, 2 * exponent);
}

uint32_t packMagnitude(const mat4& toWorld, const std::array<vec3, 3>& own,
                       const std::array<vec3, 3>& world) {
    const vec3 largest = glm::max(glm::abs(own[0]), glm::max(glm::abs(own[1]), glm::abs(own[2])));
    float magnitude = 0.0f;
    for (int row = 0; row < 3; ++row) {
        float sum = std::abs(toWorld[3][row]);
        for (int column = 0; column < 3; ++column) sum += std::abs(toWorld[column][row]) * largest[column];
        magnitude = std::max(magnitude, sum);
    }
    if (!(magnitude > largestIn(world)) || !std::isfinite(magnitude)) return 0;
    const uint32_t unused = ~layout::LIGHT_MAGNITUDE_MASK;
    return (bits(magnitude) + unused) & layout::LIGHT_MAGNITUDE_MASK;  // rounded up
}

void packLamps(const Scene& scene, SceneData& data, std::optional<bool> hasTree) {
    LightPacker(scene, data).pack(hasTree);
}

void setEnvironmentParams(const Environment& env, layout::SceneParams& params) {
    params.environmentScale = env.scale;
    params.environmentTurn = env.turn;
    // Do not sample a black environment if there are other lights.
    float share = params.environmentIsEven != 0u ? evenEnvironmentShare : environmentShare;
    if (env.scale == vec3(0.0f)) share = 0.0f;
    params.environmentProbability = params.triangleLightCount + params.punctualCount > 0 ? share : 1.0f;
}

void packLights(const Scene& scene, SceneData& data, std::optional<bool> hasTree) {
    packLamps(scene, data, hasTree);
    if (!scene.environment.empty()) packEnvironment(scene.environment, data);
}

}  // namespace limpid::scene

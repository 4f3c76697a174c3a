// Computes directional albedos of microfacet reflection, and the distribution of a metal's multiple
// scattering, by quasi-random integration. The formulas are those of shaders/material/bsdf.glsl, which reads
// the table.
#include <tbb/parallel_for.h>

#include <array>

#include "scene/device/pack.h"
#include "scene/device/tables/microfacet_quadrature.h"

namespace limpid::scene {
namespace {

constexpr uint32_t size = layout::GGX_TABLE_SIZE;
constexpr uint32_t sampleCount = 1024;
constexpr float step = 1.0f / static_cast<float>(size - 1);

/// The reflection from one view direction to a direction with this cosine.
struct Reflected {
    float cosine, weight;
};

/// Returns (A, B): the albedo is F0 A + F90 B with Schlick's Fresnel term. Stores the samples in `reflected`.
vec2 reflectionAlbedo(float cosine, float alpha, Reflected* reflected) {
    const vec3 wo = directionAt(cosine);
    const float out = smithLambda(wo.z, alpha);
    const VisibleNormals normals(wo, alpha);
    static const std::vector<vec2> disk = diskPoints(sampleCount);
    double a = 0.0, b = 0.0;
    for (uint32_t i = 0; i < sampleCount; ++i) {
        const vec3 m = normals(disk[i]);
        const float vdoth = glm::dot(wo, m);
        const vec3 wi = 2.0f * vdoth * m - wo;
        reflected[i] = {.cosine = 0.0f, .weight = 0.0f};
        if (wi.z <= 0.0f) continue;
        const float weight = (1.0f + out) / (1.0f + out + smithLambda(wi.z, alpha));
        const float schlick = std::pow(std::clamp(1.0f - vdoth, 0.0f, 1.0f), 5.0f);
        a += double{weight} * (1.0 - double{schlick});
        b += double{weight} * double{schlick};
        reflected[i] = {.cosine = std::min(wi.z, 1.0f), .weight = weight / sampleCount};
    }
    return {a / sampleCount, b / sampleCount};
}

/// Returns 2 * integral of f(c) c dc over [0, 1] of the piecewise linear function that the shader
/// interpolates.
template <typename Function>
auto cosineAverage(const Function& f) {
    decltype(f(0u)) sum{0.0f};
    for (uint32_t i = 0; i + 1 < size; ++i) {
        const float c0 = static_cast<float>(i) * step, c1 = c0 + step;
        sum += step / 3.0f * (f(i) * (2.0f * c0 + c1) + f(i + 1) * (c0 + 2.0f * c1));
    }
    return sum;
}

/// Finds q such that the integral of f q(wo) q(wi) is 1 - E(wo), where f is the lobe of one facet without
/// Fresnel term and E its albedo. Then the lobe f (1 + q q) reflects all energy and is reciprocal.
/// Fixed-point iteration (R. Sinkhorn, 1964).
void solveFollowing(const std::vector<Reflected>& reflected, vec4* entries) {
    std::array<float, size> q{};
    for (uint32_t i = 0; i < size; ++i) {
        const float albedo = entries[i].x + entries[i].y;
        q[i] = std::sqrt(std::max(1.0f - albedo, 0.0f) / albedo);
    }
    for (uint32_t round = 0; round < 16; ++round) {
        std::array<float, size> next{};
        for (uint32_t i = 0; i < size; ++i) {
            float sum = 0.0f;
            for (uint32_t k = i * sampleCount; k < (i + 1) * sampleCount; ++k) {
                const float x = reflected[k].cosine / step;
                const uint32_t low = std::min(static_cast<uint32_t>(x), size - 2);
                sum += reflected[k].weight * glm::mix(q[low], q[low + 1], x - static_cast<float>(low));
            }
            const float missing = std::max(1.0f - entries[i].x - entries[i].y, 0.0f);
            next[i] = sum > 0.0f ? std::sqrt(q[i] * missing / sum) : 0.0f;
        }
        q = next;
    }
    for (uint32_t i = 0; i < size; ++i) entries[i].z = q[i];
}

/// Fills d, which corrects the diffuse-like lobe of a metal. The product m(wo) m(wi) of missing energies is
/// changed by d(wo) d(wi) without changing any albedo: light that arrives at grazing angles leaves at grazing
/// angles more often than the product says, and light from above leaves upwards. Shape and amount are fitted
/// to random walks (tests/reference/microfacet_walk.h).
void fillCorrection(float roughness, vec4* entries) {
    const auto missing = [&](uint32_t i) { return std::max(1.0f - entries[i].x - entries[i].y, 0.0f); };
    const auto shape = [](uint32_t i) { return 1.0f / (1.0f + 3.0f * static_cast<float>(i) * step); };
    const float all = cosineAverage(missing);
    const float mean =
        cosineAverage([&](uint32_t i) { return missing(i) * shape(i); }) / std::max(all, 1e-20f);
    const float amount = std::sqrt(std::max(6.9f - 13.0f * (1.0f - roughness), 0.0f));
    for (uint32_t i = 0; i < size; ++i) entries[i].w = amount * missing(i) * (shape(i) - mean);
}

}  // namespace

void fillGgxTable(std::vector<vec4>& table) {
    table.resize(size_t{size} * size + size);
    tbb::parallel_for(0u, size, [&](uint32_t row) {
        vec4* entries = &table[size_t{row} * size];
        const float roughness = static_cast<float>(row) * step;
        const float alpha = std::max(roughness * roughness, 1e-4f);
        std::vector<Reflected> reflected(size_t{size} * sampleCount);
        for (uint32_t i = 0; i < size; ++i) {
            const float cosine = std::max(static_cast<float>(i) * step, 1e-3f);
            entries[i] =
                vec4(reflectionAlbedo(cosine, alpha, &reflected[size_t{i} * sampleCount]), 0.0f, 0.0f);
        }
        solveFollowing(reflected, entries);
        fillCorrection(roughness, entries);
        const float following = followingShare(roughness);
        for (uint32_t i = 0; i < size; ++i) entries[i].z *= std::sqrt(following);
        const vec2 average = cosineAverage([&](uint32_t i) { return vec2(entries[i]); });
        table[size_t{size} * size + row] = vec4(average, 1.0f - following, 0.0f);
    });
}

}  // namespace limpid::scene

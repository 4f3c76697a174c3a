// Directional albedos of microfacet reflection and refraction, by quasi-random integration over visible
// normals. The formulas are those of shaders/bsdf.glsl, which reads the tables; visible normals after E.
// Heitz, "Sampling the GGX distribution of visible normals", JCGT 2018.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "scene/pack.h"

namespace limpid::scene {
namespace {

constexpr uint32_t sampleCount = 1024;

/// Point i of the Hammersley set.
vec2 hammersley(uint32_t i, uint32_t count) {
    uint32_t reversed = 0;
    for (uint32_t bit = 0; bit < 32; ++bit) reversed |= (i >> bit & 1u) << (31 - bit);
    return {(static_cast<float>(i) + 0.5f) / static_cast<float>(count),
            static_cast<float>(reversed) * 0x1p-32f};
}

vec3 sampleVisibleNormal(const vec3& wo, float alpha, const vec2& u) {
    const vec3 v = glm::normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const float length2 = v.x * v.x + v.y * v.y;
    const vec3 t1 = length2 > 0.0f ? vec3(-v.y, v.x, 0.0f) / std::sqrt(length2) : vec3(1, 0, 0);
    const vec3 t2 = glm::cross(v, t1);
    const float r = std::sqrt(u.x), phi = 2.0f * pi * u.y, s = 0.5f * (1.0f + v.z);
    const float p1 = r * std::cos(phi);
    const float p2 = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * r * std::sin(phi);
    const vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * v;
    return glm::normalize(vec3(alpha * n.x, alpha * n.y, std::max(0.0f, n.z)));
}

/// Smith's Lambda for GGX.
float lambda(float cosine, float alpha) {
    const float c2 = cosine * cosine;
    return 0.5f * (std::sqrt(1.0f + alpha * alpha * (1.0f - c2) / std::max(c2, 1e-12f)) - 1.0f);
}

/// Unpolarised Fresnel reflectance; eta = index behind the surface over index before it.
float fresnelDielectric(float cosine, float eta) {
    const float sin2 = (1.0f - cosine * cosine) / (eta * eta);
    if (sin2 >= 1.0f) return 1.0f;
    const float transmitted = std::sqrt(1.0f - sin2);
    const float s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const float p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return 0.5f * (s * s + p * p);
}

float tableCosine(uint32_t column, uint32_t size) {
    return std::max(static_cast<float>(column) / static_cast<float>(size - 1), 1e-3f);
}

float tableAlpha(uint32_t row, uint32_t size) {
    const float roughness = static_cast<float>(row) / static_cast<float>(size - 1);
    return std::max(roughness * roughness, 1e-4f);
}

/// (A, B): the albedo is F0 A + F90 B with Schlick's Fresnel term.
vec2 reflectionAlbedo(float cosine, float alpha) {
    const vec3 wo(std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
    double a = 0.0, b = 0.0;
    for (uint32_t i = 0; i < sampleCount; ++i) {
        const vec3 m = sampleVisibleNormal(wo, alpha, hammersley(i, sampleCount));
        const float vdoth = glm::dot(wo, m);
        const vec3 wi = 2.0f * vdoth * m - wo;
        if (wi.z <= 0.0f) continue;
        const float lo = lambda(wo.z, alpha);
        const float weight = (1.0f + lo) / (1.0f + lo + lambda(wi.z, alpha));
        const float schlick = std::pow(std::clamp(1.0f - vdoth, 0.0f, 1.0f), 5.0f);
        a += double{weight} * (1.0 - schlick);
        b += double{weight} * schlick;
    }
    return {a / sampleCount, b / sampleCount};
}

/// Reflected plus transmitted energy, with the separable masking term that the shader uses for refraction.
float dielectricAlbedo(float cosine, float alpha, float eta) {
    const vec3 wo(std::sqrt(std::max(0.0f, 1.0f - cosine * cosine)), 0.0f, cosine);
    double sum = 0.0;
    for (uint32_t i = 0; i < sampleCount / 4; ++i) {
        const vec3 m = sampleVisibleNormal(wo, alpha, hammersley(i, sampleCount / 4));
        const float vdoth = glm::dot(wo, m);
        const float reflectance = fresnelDielectric(vdoth, eta);
        const vec3 reflected = 2.0f * vdoth * m - wo;
        if (reflected.z > 0.0f) sum += double{reflectance} / (1.0 + lambda(reflected.z, alpha));
        if (reflectance >= 1.0f) continue;
        const float transmitted = std::sqrt(1.0f - (1.0f - vdoth * vdoth) / (eta * eta));
        const vec3 refracted = (vdoth / eta - transmitted) * m - wo / eta;
        if (refracted.z < 0.0f) sum += (1.0 - reflectance) / (1.0 + lambda(-refracted.z, alpha));
    }
    return static_cast<float>(sum / (sampleCount / 4));
}

/// 2 * integral of E(c) c dc over [0, 1] of the piecewise linear function that the shader interpolates.
vec2 cosineAverage(const vec4* row, uint32_t size) {
    vec2 sum(0.0f);
    const float h = 1.0f / static_cast<float>(size - 1);
    for (uint32_t i = 0; i + 1 < size; ++i) {
        const float c0 = static_cast<float>(i) * h, c1 = c0 + h;
        const vec2 e0(row[i]), e1(row[i + 1]);
        sum += h / 3.0f * (e0 * (2.0f * c0 + c1) + e1 * (c0 + 2.0f * c1));
    }
    return sum;
}

}  // namespace

void fillGgxTable(std::vector<vec4>& table) {
    constexpr uint32_t size = layout::GGX_TABLE_SIZE;
    table.resize(size_t{size} * size);
    tbb::parallel_for(0u, size, [&](uint32_t row) {
        vec4* entries = &table[size_t{row} * size];
        for (uint32_t column = 0; column < size; ++column) {
            entries[column] =
                vec4(reflectionAlbedo(tableCosine(column, size), tableAlpha(row, size)), 0.0f, 0.0f);
        }
        const vec2 average = cosineAverage(entries, size);
        for (uint32_t column = 0; column < size; ++column) {
            entries[column].z = average.x;
            entries[column].w = average.y;
        }
    });
}

void fillDielectricTable(std::vector<float>& table) {
    constexpr uint32_t size = layout::DIELECTRIC_TABLE_SIZE, nodes = layout::DIELECTRIC_ETA_NODES;
    table.resize(size_t{2} * nodes * size * size);
    tbb::parallel_for(0u, 2 * nodes * size, [&](uint32_t line) {
        const uint32_t etaIndex = line / size;
        const float coordinate = static_cast<float>(etaIndex % nodes) / static_cast<float>(nodes - 1);
        const float exponent = (etaIndex < nodes ? -1.0f : 1.0f) * coordinate * coordinate;
        const float eta = std::pow(layout::DIELECTRIC_ETA_MAX, exponent);
        for (uint32_t column = 0; column < size; ++column) {
            table[size_t{line} * size + column] =
                dielectricAlbedo(tableCosine(column, size), tableAlpha(line % size, size), eta);
        }
    });
}

}  // namespace limpid::scene

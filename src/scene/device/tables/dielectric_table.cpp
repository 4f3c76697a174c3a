#include "scene/device/tables/dielectric_table.h"

#include <tbb/parallel_for.h>

#include <array>

#include "scene/device/pack.h"
#include "scene/device/tables/microfacet_quadrature.h"

namespace limpid::scene {
namespace {

constexpr uint32_t size = layout::DIELECTRIC_TABLE_SIZE, nodes = layout::DIELECTRIC_ETA_NODES;

constexpr std::array<uint8_t, share::count> shares{
#include "scene/device/tables/dielectric_share.inc"
};

/// The nodes of the index ratio: log(1 + (|log eta| - first) / scale) is proportional to the node's number.
struct EtaNodes {
    uint32_t count;
    float scale;

    float last() const { return std::log(1.0f + (std::log(layout::DIELECTRIC_ETA_MAX) - first()) / scale); }
    /// The smallest |log eta| that counts as a boundary.
    static float first() { return std::log(1.0f + layout::SMOOTH_IOR_DIFFERENCE); }
    /// Returns a node's eta. The first half of the nodes is below 1.
    float eta(uint32_t node) const {
        const float coordinate = static_cast<float>(node % count) / static_cast<float>(count - 1);
        const float logarithm = first() + scale * (std::exp(coordinate * last()) - 1.0f);
        return std::exp(node < count ? -logarithm : logarithm);
    }
    /// Returns 0 at the first node to 1 at the last.
    float coordinate(float eta) const {
        return std::log(1.0f + std::max(std::abs(std::log(eta)) - first(), 0.0f) / scale) / last();
    }
};
constexpr EtaNodes tableEtas{.count = nodes, .scale = layout::DIELECTRIC_ETA_SCALE};
constexpr EtaNodes shareEtas{.count = share::etas, .scale = 0.02f};

/// Returns the critical cosine of total reflection, on the side where it occurs.
float criticalCosine(float eta) {
    const float below = std::min(eta, 1.0f / eta);
    return std::sqrt((1.0f - below) * (1.0f + below));
}

/// Maps the cosine to 0 to 1 so that total reflection begins near the middle for every eta. This allows
/// tables to be interpolated between values of eta.
float columnOf(float cosine, float eta) {
    const float critical = criticalCosine(eta);
    return cosine * (1.0f + critical) / (cosine + critical);
}
float cosineAt(float column, float eta) {
    const float critical = criticalCosine(eta);
    return column * critical / (1.0f + critical - column);
}
float cosineOfNode(uint32_t node, uint32_t count, float eta) {
    return std::clamp(cosineAt(static_cast<float>(node) / static_cast<float>(count - 1), eta), 1e-3f, 1.0f);
}

float fresnelDielectric(float cosine, float eta) {
    const float transmitted2 = (cosine * cosine + (eta - 1.0f) * (eta + 1.0f)) / (eta * eta);
    if (transmitted2 <= 0.0f) return 1.0f;
    const float transmitted = std::sqrt(transmitted2);
    const float s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const float p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return 0.5f * (s * s + p * p);
}

/// Returns 2 * integral of f(c) c dc over [0, 1] of the function that the shader interpolates.
vec2 cosineAverage(const vec4* texels, float eta) {
    constexpr uint32_t parts = 8;
    vec2 sum(0.0f);
    for (uint32_t i = 0; i + 1 < size; ++i) {
        for (uint32_t k = 0; k < parts; ++k) {
            const auto cosine = [&](float part) {
                return cosineAt((static_cast<float>(i) + part / parts) / static_cast<float>(size - 1), eta);
            };
            const float middle = static_cast<float>(k) + 0.5f;
            const float width = cosine(static_cast<float>(k + 1)) - cosine(static_cast<float>(k));
            const vec2 f = glm::mix(vec2(texels[2 * i + 1]), vec2(texels[2 * i + 3]), middle / parts);
            sum += 2.0f * width * cosine(middle) * f;
        }
    }
    return sum;
}

/// Fills the two texels of an entry, without the averages.
void fillEntry(float cosine, float roughness, float eta, vec4* texels) {
    static const std::vector<vec2> disk = halfDisk(1024);
    const FirstFacet first = firstFacet(cosine, std::max(roughness * roughness, 1e-4f), eta, disk);
    const float missing = std::max(first.missing(), 0.0f);
    const float part = reflectedShare(cosine, roughness, eta);
    const vec2 several(missing * part, missing * (1.0f - part));
    // If the indices are similar, light keeps almost the same direction, however many facets it hits.
    const float rough = followingShare(roughness);
    const float following = rough + (1.0f - rough) * std::exp(-10.0f * std::abs(std::log(eta)));
    const vec2 facet(first.reflected, first.transmitted);
    const vec2 gain = glm::min(following * several / (facet + 0.05f), vec2(4.0f));
    const vec2 diffuse = glm::max(several - gain * facet, vec2(0.0f));
    texels[0] = vec4(gain, diffuse);
    texels[1] = vec4(diffuse, 0.0f, 0.0f);
}

}  // namespace

namespace share {
float cosine(uint32_t node, float eta) {
    return cosineOfNode(node, cosines, eta);
}
float roughness(uint32_t node) {
    return static_cast<float>(node + 1) / roughnesses;
}
float eta(uint32_t node) {
    return shareEtas.eta(node);
}
}  // namespace share

std::vector<vec2> halfDisk(uint32_t count) {
    return diskPoints(count, -0.25f, 0.25f);
}

FirstFacet firstFacet(float cosine, float alpha, float eta, std::span<const vec2> disk) {
    const vec3 wo = directionAt(cosine);
    const VisibleNormals normals(wo, alpha);
    const float out = smithLambda(wo.z, alpha);
    FirstFacet sum;
    for (const vec2& point : disk) {
        const vec3 m = normals(point);
        const float vdoth = glm::dot(wo, m);
        const float reflectance = fresnelDielectric(vdoth, eta);
        const float reflected = 2.0f * vdoth * m.z - wo.z;
        if (reflected > 0.0f) {
            sum.reflected += reflectance;
            sum.reflectedOnce += reflectance * (1.0f + out) / (1.0f + out + smithLambda(reflected, alpha));
        }
        if (reflectance >= 1.0f) continue;
        const float transmitted = std::sqrt(vdoth * vdoth + (eta - 1.0f) * (eta + 1.0f));
        const float refracted = ((vdoth - transmitted) * m.z - wo.z) / eta;
        if (refracted < 0.0f) {
            sum.transmitted += 1.0f - reflectance;
            sum.transmittedOnce +=
                (1.0f - reflectance) * transmittedMasking(out, smithLambda(refracted, alpha));
        }
    }
    const float each = 1.0f / static_cast<float>(disk.size());
    return {sum.reflected * each, sum.transmitted * each, sum.reflectedOnce * each,
            sum.transmittedOnce * each};
}

float reflectedShare(float cosine, float roughness, float eta) {
    const std::array<float, 3> p{columnOf(cosine, eta) * (share::cosines - 1),
                                 roughness * share::roughnesses - 1.0f,
                                 shareEtas.coordinate(eta) * (share::etas - 1)};
    constexpr std::array<uint32_t, 3> lengths{share::cosines, share::roughnesses, share::etas};
    float sum = 0.0f;
    for (uint32_t corner = 0; corner < 8; ++corner) {
        float weight = 1.0f;
        uint32_t index = 0, stride = 1;
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const float x = std::clamp(p[axis], 0.0f, static_cast<float>(lengths[axis] - 1));
            const uint32_t low = std::min(static_cast<uint32_t>(x), lengths[axis] - 2);
            const float fraction = x - static_cast<float>(low);
            const uint32_t up = corner >> axis & 1u;
            weight *= up != 0 ? fraction : 1.0f - fraction;
            index += (low + up) * stride;
            stride *= lengths[axis];
        }
        sum += weight * static_cast<float>(shares[index + (eta < 1.0f ? 0 : stride)]);
    }
    return sum / 255.0f;
}

namespace {

std::vector<vec4> makeTable() {
    std::vector<vec4> table(size_t{2} * nodes * size * size * 2);
    tbb::parallel_for(0u, 2 * nodes * size, [&](uint32_t line) {
        vec4* texels = &table[size_t{line} * size * 2];
        const float roughness = static_cast<float>(line % size) / static_cast<float>(size - 1);
        const float eta = tableEtas.eta(line / size);
        for (uint32_t column = 0; column < size; ++column)
            fillEntry(cosineOfNode(column, size, eta), roughness, eta, &texels[2 * column]);
        const vec2 average = cosineAverage(texels, eta);
        for (uint32_t column = 0; column < size; ++column) {
            texels[2 * column + 1].z = average.x;
            texels[2 * column + 1].w = average.y;
        }
    });
    return table;
}

}  // namespace

void fillDielectricTable(std::vector<vec4>& table) {
    // Computed once: the table is the same for all scenes and takes a second.
    static const std::vector<vec4> made = makeTable();
    table = made;
}

}  // namespace limpid::scene

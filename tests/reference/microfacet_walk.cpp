#include "tests/reference/microfacet_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace limpid::test {
namespace {

using glm::dvec2;
using glm::dvec3;

/// A walk ends after this many facets: white metal at roughness 1 then loses less than 1e-4.
constexpr int maxOrder = 64;

double uniform(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

/// Returns the area of the facets visible from v, projected along v, for a surface of area 1; v may point
/// below the surface.
double projectedArea(const dvec3& v, double alpha) {
    return 0.5 * (v.z + std::sqrt(v.z * v.z + alpha * alpha * (v.x * v.x + v.y * v.y)));
}

/// Returns Smith's Lambda, also for directions below the surface (Heitz et al., equation 9 and its
/// supplement).
double lambda(const dvec3& v, double alpha) {
    return projectedArea(v, alpha) / v.z - 1.0;
}

double distribution(const dvec3& m, double alpha) {
    const double d = m.x * m.x + m.y * m.y + alpha * alpha * m.z * m.z;
    return alpha * alpha / (std::numbers::pi * d * d);
}

/// E. Heitz, JCGT 2018: the projection of the upper hemisphere seen from v is a disc minus half an ellipse,
/// which also holds for v below the surface.
dvec3 visibleNormal(const dvec3& wo, double alpha, std::mt19937_64& random) {
    const dvec3 v = glm::normalize(dvec3(alpha * wo.x, alpha * wo.y, wo.z));
    const double length = std::hypot(v.x, v.y);
    const dvec3 t1 = length > 0.0 ? dvec3(-v.y, v.x, 0.0) / length : dvec3(1, 0, 0);
    const dvec3 t2 = glm::cross(v, t1);
    const double r = std::sqrt(uniform(random)), phi = 2.0 * std::numbers::pi * uniform(random);
    const double p1 = r * std::cos(phi), s = 0.5 * (1.0 + v.z);
    const double p2 = (1.0 - s) * std::sqrt(std::max(0.0, 1.0 - p1 * p1)) + s * r * std::sin(phi);
    const dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * v;
    return glm::normalize(dvec3(alpha * n.x, alpha * n.y, std::max(1e-12, n.z)));
}

double fresnelDielectric(double cosine, double eta) {
    const double transmitted2 = 1.0 - (1.0 - cosine * cosine) / (eta * eta);
    if (transmitted2 <= 0.0) return 1.0;
    const double transmitted = std::sqrt(transmitted2);
    const double s = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    const double p = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    return 0.5 * (s * s + p * p);
}

double fresnelSchlick(double f0, double cosine) {
    return f0 + (1.0 - f0) * std::pow(std::clamp(1.0 - cosine, 0.0, 1.0), 5.0);
}

dvec3 refract(const dvec3& v, const dvec3& m, double eta) {
    const double cosine = glm::dot(v, m);
    const double transmitted = std::sqrt(std::max(0.0, 1.0 - (1.0 - cosine * cosine) / (eta * eta)));
    return glm::normalize((cosine / eta - transmitted) * m - v / eta);
}

/// Returns the height of the next facet along w, as the share of the surface below it, starting at the share
/// c; above 1: the ray leaves the surface.
double nextHeight(const dvec3& w, double c, double alpha, std::mt19937_64& random) {
    const double l = lambda(w, alpha);
    const double u = 1.0 - uniform(random);
    if (w.z > 0.0 && u <= std::pow(c, l)) return 2.0;
    return std::clamp(c / std::pow(u, 1.0 / l), 1e-300, 1.0);
}

/// Keeps the walk off the horizon, where a ray would stay at its height for ever.
dvec3 offHorizon(dvec3 w) {
    if (std::abs(w.z) < 1e-7) w.z = w.z < 0.0 ? -1e-7 : 1e-7;
    return w;
}

}  // namespace

WalkExit walkDielectric(const dvec3& wo, double alpha, double eta, std::mt19937_64& random) {
    dvec3 w = offHorizon(-wo);  // direction of travel, in the frame of its side: up is away from the facets
    double c = 1.0, sideEta = eta, side = 1.0;
    for (int order = 0; order < maxOrder; ++order) {
        c = nextHeight(w, c, alpha, random);
        if (c > 1.0) return {.direction = w * side, .order = order};
        const dvec3 m = visibleNormal(-w, alpha, random);
        const double cosine = -glm::dot(w, m);
        if (uniform(random) < fresnelDielectric(cosine, sideEta)) {
            w = offHorizon(w + 2.0 * cosine * m);
            continue;
        }
        // Passing through the facet flips the surface upside down.
        w = offHorizon(-refract(-w, m, sideEta));
        c = 1.0 - c;
        sideEta = 1.0 / sideEta;
        side = -side;
    }
    return {};
}

DielectricEnergy dielectricEnergy(double cosine, double alpha, double eta, int count, uint64_t seed) {
    std::mt19937_64 random(seed);
    const dvec3 wo(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    DielectricEnergy energy;
    for (int i = 0; i < count; ++i) {
        const WalkExit exit = walkDielectric(wo, alpha, eta, random);
        const bool up = exit.direction.z > 0.0;
        if (exit.order == 0) continue;
        (up ? energy.reflected : energy.transmitted) += 1.0 / count;
        if (exit.order == 1) (up ? energy.reflectedOnce : energy.transmittedOnce) += 1.0 / count;
    }
    return energy;
}

std::vector<double> metalEnergy(const dvec3& wo, double alpha, std::span<const double> f0, const dvec3& half,
                                int count, uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<double> energy(f0.size(), 0.0), weight(f0.size());
    for (int i = 0; i < count; ++i) {
        dvec3 w = offHorizon(-wo);
        double c = 1.0;
        std::ranges::fill(weight, 1.0 / count);
        for (int order = 0; order < maxOrder; ++order) {
            c = nextHeight(w, c, alpha, random);
            if (c > 1.0) break;
            const dvec3 m = visibleNormal(-w, alpha, random);
            const double cosine = -glm::dot(w, m);
            for (size_t j = 0; j < f0.size(); ++j) weight[j] *= fresnelSchlick(f0[j], cosine);
            w = offHorizon(w + 2.0 * cosine * m);
        }
        if (c > 1.0 && glm::dot(w, half) > 0.0)
            for (size_t j = 0; j < f0.size(); ++j) energy[j] += weight[j];
    }
    return energy;
}

std::vector<double> metalMultiple(const dvec3& wo, double alpha, std::span<const double> f0,
                                  std::span<const dvec3> directions, int count, uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<double> values(directions.size() * f0.size(), 0.0), weight(f0.size());
    for (int i = 0; i < count; ++i) {
        dvec3 w = offHorizon(-wo);
        double c = 1.0;
        std::ranges::fill(weight, 1.0 / count);
        for (int order = 0; order < maxOrder; ++order) {
            c = nextHeight(w, c, alpha, random);
            if (c > 1.0) break;
            for (size_t k = 0; order > 0 && k < directions.size(); ++k) {
                const dvec3 m = glm::normalize(directions[k] - w);
                if (m.z <= 0.0) continue;
                const double seen = distribution(m, alpha) / (4.0 * projectedArea(-w, alpha)) *
                                    std::pow(c, lambda(directions[k], alpha));
                for (size_t j = 0; j < f0.size(); ++j)
                    values[k * f0.size() + j] += weight[j] * seen * fresnelSchlick(f0[j], -glm::dot(w, m));
            }
            const dvec3 m = visibleNormal(-w, alpha, random);
            const double cosine = -glm::dot(w, m);
            for (size_t j = 0; j < f0.size(); ++j) weight[j] *= fresnelSchlick(f0[j], cosine);
            w = offHorizon(w + 2.0 * cosine * m);
        }
    }
    return values;
}

}  // namespace limpid::test

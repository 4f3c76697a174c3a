// Light between microfacets as a random walk, in double precision: E. Heitz, J. Hanika, E. d'Eon, C.
// Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", SIGGRAPH 2016. GGX facets,
// height-correlated Smith masking, visible normals. A height h is kept as its share c = C1(h) of the surface
// that lies below: the walk then needs no distribution of heights, and gives the same for all of them
// (section 4 of the paper).
#pragma once

#include <random>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::test {

/// Where a walk left the surface, after how many facets; no order: it was cut off.
struct WalkExit {
    glm::dvec3 direction{0.0};
    int order = 0;
};

/// A walk that began in `wo` (pointing away from the surface, z > 0) through dielectric facets; eta: the
/// index behind the surface over the one before it. Energy: nothing is absorbed, and no factor eta^2 is
/// applied.
WalkExit walkDielectric(const glm::dvec3& wo, double alpha, double eta, std::mt19937_64& random);

/// Of `count` walks from the cosine: energy reflected and transmitted, by the first facet and in all.
struct DielectricEnergy {
    double reflected = 0.0, transmitted = 0.0;
    double reflectedOnce = 0.0, transmittedOnce = 0.0;
};
DielectricEnergy dielectricEnergy(double cosine, double alpha, double eta, int count, uint64_t seed);

/// Of `count` walks from wo through the facets of a metal: what they bring out into directions d with dot(d,
/// half) > 0, by all facets, for each F0 (Schlick, F90 = 1).
std::vector<double> metalEnergy(const glm::dvec3& wo, double alpha, std::span<const double> f0,
                                const glm::dvec3& half, int count, uint64_t seed);

/// What a metal scatters from direction to direction by two facets or more: f cos for each of `directions` (z
/// > 0) and each F0 (Schlick, F90 = 1), as values[direction * f0.size() + colour]. The mean of `count` walks
/// from wo, each connected to all directions at each facet.
std::vector<double> metalMultiple(const glm::dvec3& wo, double alpha, std::span<const double> f0,
                                  std::span<const glm::dvec3> directions, int count, uint64_t seed);

}  // namespace limpid::test

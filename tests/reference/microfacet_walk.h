// Light between microfacets as a random walk, in double precision: E. Heitz, J. Hanika, E. d'Eon, C.
// Dachsbacher, "Multiple-scattering microfacet BSDFs with the Smith model", SIGGRAPH 2016. GGX facets,
// height-correlated Smith masking, visible normals. A height h is represented by c = C1(h), the share of the
// surface below it: then the walk needs no distribution of heights, and its result holds for all of them
// (section 4 of the paper).
#pragma once

#include <random>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::test {

/// The direction in which a walk left the surface, and after how many facets; order 0: it was cut off.
struct WalkExit {
    glm::dvec3 direction{0.0};
    int order = 0;
};

/// Simulates a walk that starts in `wo` (pointing away from the surface, z > 0) through dielectric facets.
/// `eta`: index behind the surface over the index in front of it. Values are energy: nothing is absorbed, and
/// no factor eta^2 is applied.
WalkExit walkDielectric(const glm::dvec3& wo, double alpha, double eta, std::mt19937_64& random);

/// Energy reflected and transmitted in `count` walks from the cosine: by the first facet, and in total.
struct DielectricEnergy {
    double reflected = 0.0, transmitted = 0.0;
    double reflectedOnce = 0.0, transmittedOnce = 0.0;
};
DielectricEnergy dielectricEnergy(double cosine, double alpha, double eta, int count, uint64_t seed);

/// Returns the energy of `count` walks from wo through the facets of a metal that leaves in directions d with
/// dot(d, half) > 0, over all facets, for each F0 (Schlick, F90 = 1).
std::vector<double> metalEnergy(const glm::dvec3& wo, double alpha, std::span<const double> f0,
                                const glm::dvec3& half, int count, uint64_t seed);

/// Returns the scattering of a metal by two facets or more: f cos for each of `directions` (z > 0) and each
/// F0 (Schlick, F90 = 1), as values[direction * f0.size() + colour]. The mean of `count` walks from wo, each
/// connected to all directions at each facet.
std::vector<double> metalMultiple(const glm::dvec3& wo, double alpha, std::span<const double> f0,
                                  std::span<const glm::dvec3> directions, int count, uint64_t seed);

}  // namespace limpid::test

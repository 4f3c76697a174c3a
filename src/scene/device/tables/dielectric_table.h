// Rough boundaries between dielectrics: the reflection and transmission of a single facet, and the reflected
// share of the light that is scattered by several facets. That share comes from random walks
// (dielectric_share.inc).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// Light from one direction after the first facet: the part sent to the correct side, and the part of that
/// which escapes unshadowed, with the masking of shaders/material/bsdf.glsl.
struct FirstFacet {
    float reflected = 0.0f, transmitted = 0.0f;
    float reflectedOnce = 0.0f, transmittedOnce = 0.0f;

    float missing() const { return 1.0f - reflectedOnce - transmittedOnce; }
};

/// Returns the points of the unit disk that firstFacet() integrates over. Half the disk is enough, since it
/// is symmetric about the plane of incidence.
std::vector<vec2> halfDisk(uint32_t count);

/// `eta`: refractive index behind the surface divided by the index in front of it.
FirstFacet firstFacet(float cosine, float alpha, float eta, std::span<const vec2> disk);

/// The nodes of the table of shares: [eta][roughness][cosine], in units of 1/255. The first half is for eta
/// below 1.
namespace share {
constexpr uint32_t cosines = 18, roughnesses = 8, etas = 20;
constexpr uint32_t count = 2 * etas * roughnesses * cosines;

float cosine(uint32_t node, float eta);
float roughness(uint32_t node);
float eta(uint32_t node);
}  // namespace share

/// Returns the reflected share, interpolated.
float reflectedShare(float cosine, float roughness, float eta);

}  // namespace limpid::scene

// Rough boundaries between dielectrics: what one facet reflects and transmits, and which share of the rest,
// which meets several facets, is reflected in the end. The share comes from random walks
// (dielectric_share.inc).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

/// Of light from one direction: what the first facet sends to the right side, and what of that escapes
/// unhindered, as shaders/material/bsdf.glsl masks it.
struct FirstFacet {
    float reflected = 0.0f, transmitted = 0.0f;
    float reflectedOnce = 0.0f, transmittedOnce = 0.0f;

    float missing() const { return 1.0f - reflectedOnce - transmittedOnce; }
};

/// The points of the disk with which firstFacet() integrates. Half of it is enough: the other side of the
/// plane of incidence is its mirror image.
std::vector<vec2> halfDisk(uint32_t count);

/// eta: index behind the surface over the one before it.
FirstFacet firstFacet(float cosine, float alpha, float eta, std::span<const vec2> disk);

/// The nodes of the table of shares: [eta][roughness][cosine], in 255ths. The first half is for eta below 1.
namespace share {
constexpr uint32_t cosines = 18, roughnesses = 8, etas = 20;
constexpr uint32_t count = 2 * etas * roughnesses * cosines;

float cosine(uint32_t node, float eta);
float roughness(uint32_t node);
float eta(uint32_t node);
}  // namespace share

/// The share that is reflected, interpolated.
float reflectedShare(float cosine, float roughness, float eta);

}  // namespace limpid::scene

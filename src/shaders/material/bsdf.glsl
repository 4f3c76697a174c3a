// The material's BSDF: glTF 2.0 metallic-roughness with transmission, below sheen (sheen.glsl), below a clear coat
// (clearcoat.glsl).
//
//   f = metallic * metal + (1 - metallic) * ((1 - transmission) * plastic + transmission * glass)
//
// With iridescence, metal and plastic lie below a film (thin_film.glsl). With diffuse transmission, plastic's base
// sends a share of its light to the other side of the surface. With anisotropy, all facets have two roughnesses, and
// multiple scattering is left out (docs/gltf.md).
//
// metal: GGX reflection plus multiple scattering between the facets (multipleReflection). plastic: GGX
// reflection over a diffuse base that gets exactly the energy that the coat transmits, in and out. glass:
// thin (a pane: the transmitted lobe is the reflected one mirrored behind the surface) or a refracting
// boundary, plus multiple scattering (addDielectricMultiple). Both multiple-scattering terms are fitted to a
// random walk on microfacets (E. Heitz et al., "Multiple-scattering microfacet BSDFs with the Smith model",
// SIGGRAPH 2016; tests/reference/microfacet_walk.h; docs/gltf.md). A white surface of any kind reflects and
// transmits all energy. Energy form: crossing a boundary does not scale radiance by eta^2; the factors cancel
// for every path that leaves the body again.
//
// All f below include the cosine. Directions are local: the shading normal is +Z.
#ifndef LIMPID_BSDF_GLSL
#define LIMPID_BSDF_GLSL

#include "shaders/material/bsdf_sample.glsl"

/// Returns the specular lobes' reflection and transmission of uniform light: the albedoSpecular layer.
vec3 specularAlbedo(Bsdf b) {
    if (!HAS_SPECULAR) return vec3(0.0);
    const float missing = 1.0 - b.albedo.x - b.albedo.y;
    const float reflectance = fresnelDielectric(b.wo.z, b.eta);
    vec3 base = reflectedAlbedo(b) + b.multiple * missing + b.through * (1.0 - b.coatLoss) +
                      b.glassWeight * mix(b.glass, vec3(1.0), reflectance);
    if (HAS_SHEEN) base = base * (1.0 - b.sheen.albedo) + b.sheen.color * min(b.sheen.outside, 1.0);
    return HAS_CLEARCOAT ? base * (1.0 - b.clearcoat.albedo) + b.clearcoat.albedo : base;
}

#endif

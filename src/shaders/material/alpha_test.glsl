// Textures of a material, and whether a ray passes where they say that nothing is there.
#ifndef LIMPID_ALPHA_TEST_GLSL
#define LIMPID_ALPHA_TEST_GLSL

#include "shaders/material/surface.glsl"

/// Looks up a material's texture over the footprint; white if it has none.
vec4 materialTexture(uint index, VertexData data, Footprint footprint) {
    vec4 result = vec4(1.0);
    if (index != NONE) {
        const TextureRef ref = loadTextureRef(index);
        const bool second = (ref.flags & TEXTURE_UV1) != 0u;
        const vec3 uv = vec3(second ? data.uv1 : data.uv0, 1.0);
        const vec4 edges = second ? data.uv1Edges : data.uv0Edges;
        const mat2 toTexture = mat2(ref.rowU.x, ref.rowV.x, ref.rowU.y, ref.rowV.y) * mat2(edges.xy, edges.zw);
        result = sampleFootprint(ref, vec2(dot(ref.rowU, uv), dot(ref.rowV, uv)), toTexture * footprint.across,
                                 toTexture * footprint.along, footprint.exact);
    }
    return result;
}

/// Like above, but at the point itself, in the finest level.
vec4 materialTexture(uint index, VertexData data) {
    vec4 result = vec4(1.0);
    if (index != NONE) {
        const TextureRef ref = loadTextureRef(index);
        const vec3 uv = vec3((ref.flags & TEXTURE_UV1) != 0u ? data.uv1 : data.uv0, 1.0);
        result = sampleTexture(ref, vec2(dot(ref.rowU, uv), dot(ref.rowV, uv)), -1.0);
    }
    return result;
}

/// The share of the surface that is there: 0 or 1 for MASK, any share for BLEND, 1 for other materials. `at`: position
/// in `materials`.
float coverageOf(int at, uvec3 indices, vec2 barycentrics, out bool blended) {
    const uint flags = imageLoad(materials, at).w;
    const uvec4 alphaTexel = imageLoad(materials, at + 3);
    float alpha = uintBitsToFloat(alphaTexel.x);
    if (HAS_VERTEX_DATA) {
        const VertexData data = loadVertexData(indices, barycentrics);
        alpha *= data.color.a;
        if (HAS_TEXTURES) alpha *= materialTexture(imageLoad(materials, at + 4).x, data).a;
    }
    blended = (flags & MATERIAL_BLEND) != 0u;
    if (!blended) alpha = (flags & MATERIAL_MASK) == 0u || alpha >= uintBitsToFloat(alphaTexel.y) ? 1.0 : 0.0;
    return clamp(alpha, 0.0, 1.0);
}

float coverageAt(uint triangle, uint instance, vec2 barycentrics, out bool blended) {
    const uvec4 shading = imageLoad(triangles, int(loadTriangleIds(triangle, instance).shadingTriangle));
    return coverageOf(int(materialOf(shading.w, instance) * MATERIAL_TEXELS), shading.xyz, barycentrics, blended);
}

/// In place of a random number: rays hit every BLEND surface that is there at all.
const uint HIT_BLENDED = 0xffffffffu;

/// True if a candidate hit on a MASK or BLEND material counts. BLEND is decided by a hash of `rng` and the
/// triangle, so that neither the order of candidates nor repeated tests make a difference.
bool passesAlphaTest(uint triangle, uint instance, vec2 barycentrics, uint rng) {
    bool blended;
    const float coverage = coverageAt(triangle, instance, barycentrics, blended);
    const bool random = blended && rng != HIT_BLENDED;
    return coverage > (random ? randomOf(rng, triangle, instance) : 0.0);
}

/// Decides whether a ray that was traced with HIT_BLENDED passes what it hit. Each decision takes the ray's next random
/// number, which is spread evenly over a pixel's samples; during traversal, where the order of surfaces is unknown,
/// decisions are independent. Counts `decisions`.
bool passesBlended(uint triangle, uint instance, vec2 barycentrics, inout uint decisions, inout uint rng) {
    bool blended;
    const float coverage = coverageAt(triangle, instance, barycentrics, blended);
    if (!blended) return false;
    ++decisions;
    return stratified(rng) >= coverage;
}

#endif

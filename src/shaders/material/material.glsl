// Computes the surface at a hit: geometry, material parameters after textures and vertex colours, and the
// alpha test. Materials: glTF 2.0, section 3.9 and appendix B.
#ifndef LIMPID_MATERIAL_GLSL
#define LIMPID_MATERIAL_GLSL

#include "shaders/material/microfacet.glsl"
#include "shaders/common/sampling.glsl"
#include "shaders/common/rng.glsl"
#include "shaders/material/texture.glsl"

struct Surface {
    vec3 position;
    vec3 geometricNormal;  // unit, on the viewer's side
    vec3 normal;           // shading normal: unit, on the viewer's side
    float magnitude;       // the largest coordinate used in computing `position`, for offsetRay
    bool front;            // the viewer is on the front side, according to the winding order
    uint instance, primitive, material;
    vec3 baseColor;
    float metallic, roughness, specular, ior, transmission;
    vec3 specularColor;  // factor of the dielectric's reflectance at normal incidence
    bool thin, unlit;
    float clearcoat, clearcoatRoughness;
    vec3 clearcoatNormal;  // unit, on the viewer's side
    float anisotropy;           // strength
    vec3 anisotropyDirection;   // along which it is rougher, unit; 0: unknown
    vec3 sheenColor;
    float sheenRoughness;
    float diffuseTransmission;  // share of the diffuse light
    vec3 diffuseTransmissionColor;
    float dispersion;           // 20 / Abbe number
    float iridescence, iridescenceIor;
    float iridescenceThickness;  // of the film, nanometres
    vec3 absorption;       // of the body that begins at this surface, per unit of length; 0 if there is none
    bool culled;    // the back of a single-sided material without transmission
    vec3 emission;  // radiance towards the viewer
    float area;     // of the triangle
};

/// True if light passes through the surface, as glass does or diffusely.
bool transmitsLight(Surface s) {
    return s.transmission > 0.0 || (HAS_DIFFUSE_TRANSMISSION && s.diffuseTransmission > 0.0);
}

/// True if another medium begins behind the surface: a transmitting body, not a thin wall.
bool isBoundary(Surface s) {
    return !s.thin && transmitsLight(s);
}

/// Returns the origin of a ray that leaves the surface in `direction`.
vec3 leavingPoint(Surface s, vec3 direction) {
    const float side = dot(direction, s.geometricNormal) < 0.0 ? -1.0 : 1.0;
    return offsetRay(s.position, side * s.geometricNormal, s.magnitude);
}

/// The ids stored with a triangle in bvhTriangles.
struct TriangleIds {
    uint instance, primitive, shadingTriangle;
};

TriangleIds loadTriangleIds(uint triangle, uint instance) {
    const int at = int(triangle * BVH_TRIANGLE_TEXELS);
    const uint primitive = floatBitsToUint(imageLoad(bvhTriangles, at).w) & ~BVH_TRIANGLE_ALPHA;
    const uint named = floatBitsToUint(imageLoad(bvhTriangles, at + 1).w);
    return TriangleIds(named != NONE ? named : instance, primitive, floatBitsToUint(imageLoad(bvhTriangles, at + 2).w));
}

/// Material indices of static triangles are absolute; those of instanced meshes are relative to the
/// instance's material.
uint materialOf(uint word, uint instance) {
    uint material = word & TRIANGLE_MATERIAL_MASK;
    if (TWO_LEVEL && instance != NONE) {
        material += imageLoad(instances, int(instance * INSTANCE_TEXELS) + 3).x;
    }
    return material;
}

/// True for materials of surfaces without thickness that transmit light.
bool isThinGlass(uint triangle, uint hitInstance) {
    const uint shading = loadTriangleIds(triangle, hitInstance).shadingTriangle;
    const uint instance = TWO_LEVEL ? hitInstance : NONE;
    const int at = int(materialOf(imageLoad(triangles, int(shading)).w, instance) * MATERIAL_TEXELS);
    const bool thin = (imageLoad(materials, at).w & MATERIAL_THIN) != 0u;
    return thin && uintBitsToFloat(imageLoad(materials, at + 2).w) > 0.0;
}

vec3 interpolate(vec3 a, vec3 b, vec3 c, vec2 barycentrics) {
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

struct VertexData {
    vec3 normal;
    vec4 tangent;
    vec2 uv0, uv1;
    vec4 color;
    vec4 uv0Edges, uv1Edges;  // uv differences along the two edges from the first vertex
};

VertexData loadVertexData(uvec3 indices, vec2 barycentrics) {
    vec3 normals[3];
    vec4 tangents[3], colors[3];
    vec2 uv0[3], uv1[3];
    for (int i = 0; i < 3; ++i) {
        const int at = int(indices[i] * VERTEX_TEXELS);
        const uvec4 a = imageLoad(vertices, at), b = imageLoad(vertices, at + 1);
        normals[i] = decodeOctahedral(a.x);
        tangents[i] = vec4(decodeOctahedral(a.y), (a.y & 1u) != 0u ? -1.0 : 1.0);
        uv0[i] = uintBitsToFloat(a.zw);
        uv1[i] = uintBitsToFloat(b.xy);
        colors[i] = vec4(unpackUnorm2x16(b.z), unpackUnorm2x16(b.w));
    }
    const float u = barycentrics.x, v = barycentrics.y;
    // Interpolates from the first vertex, which is exact if all three are equal, as needed for an alpha at
    // its cutoff.
    VertexData data;
    data.normal = interpolate(normals[0], normals[1], normals[2], barycentrics);
    data.tangent.xyz = interpolate(tangents[0].xyz, tangents[1].xyz, tangents[2].xyz, barycentrics);
    data.tangent.w = tangents[0].w;
    data.uv0 = uv0[0] + u * (uv0[1] - uv0[0]) + v * (uv0[2] - uv0[0]);
    data.uv1 = uv1[0] + u * (uv1[1] - uv1[0]) + v * (uv1[2] - uv1[0]);
    data.color = colors[0] + u * (colors[1] - colors[0]) + v * (colors[2] - colors[0]);
    data.uv0Edges = vec4(uv0[1] - uv0[0], uv0[2] - uv0[0]);
    data.uv1Edges = vec4(uv1[1] - uv1[0], uv1[2] - uv1[0]);
    return data;
}

/// A ray's cone at a hit: textures are averaged over it.
struct RayCone {
    float width;
    /// The ray comes from a rough surface's lobe. Next-event estimation can sample the same emission and
    /// reads it at points. Both must use the same light for their weighted sum to be correct, so emission is
    /// read at a point here too. Other textures need less precision, since the lobe blurs them.
    bool scattered;
    bool wide;  // as wide across as along the ray; for rays through pixel centres, which would otherwise
                // shimmer
};

/// The axes of a ray's footprint on a triangle: full widths, in barycentrics.
struct Footprint {
    vec2 across, along;
    bool exact;  // argument of sampleFootprint()
};

/// Returns the barycentrics of a vector in the triangle's plane. `unitNormal` is that of edge1 x edge2, whose
/// length is doubleArea.
vec2 barycentricsOf(vec3 v, vec3 edge1, vec3 edge2, vec3 unitNormal, float doubleArea) {
    return vec2(dot(cross(v, edge2), unitNormal), dot(cross(edge1, v), unitNormal)) / doubleArea;
}

/// Intersects a cone of this width with the triangle's plane: an ellipse, longer by 1 / cosine along the ray
/// (T. Akenine-Moeller et al., "Improved shader and texture level of detail using ray cones", JCGT 2021), or
/// a circle around it if the cone is `wide`.
Footprint footprintOn(vec3 edge1, vec3 edge2, vec3 unitNormal, float doubleArea, vec3 toViewer, RayCone cone) {
    const float cosine = dot(unitNormal, toViewer);
    const vec3 inPlane = toViewer - cosine * unitNormal;
    const vec3 along = inPlane * inversesqrt(max(dot(inPlane, inPlane), 1e-20));
    const bool tilted = dot(inPlane, inPlane) > 1e-8;
    const vec3 axis = tilted ? along : edge1 * inversesqrt(max(dot(edge1, edge1), 1e-37));
    const vec3 other = cross(unitNormal, axis);
    const float length_ = cone.width / max(abs(cosine), 0.05);
    return Footprint(barycentricsOf((cone.wide ? length_ : cone.width) * other, edge1, edge2, unitNormal, doubleArea),
                     barycentricsOf(length_ * axis, edge1, edge2, unitNormal, doubleArea),
                     !cone.scattered);
}

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

/// Returns the normal map's normal in world space.
vec3 mappedNormal(vec3 normal, vec4 tangent, vec3 texel, float scale) {
    const vec3 t = tangent.xyz - normal * dot(normal, tangent.xyz);
    const float length2 = dot(t, t);
    if (length2 < 1e-12) return normal;
    const vec3 local = (texel * 2.0 - 1.0) * vec3(scale, scale, 1.0);
    const vec3 unit = t * inversesqrt(length2);
    const vec3 mapped = local.x * unit + local.y * tangent.w * cross(normal, unit) + local.z * normal;
    return dot(mapped, mapped) > 1e-12 ? normalize(mapped) : normal;
}

/// Returns the share of emission that a clear coat transmits. It uses the geometric normal, since light
/// sampling knows no other and must agree with rays that hit the light.
float emissionThroughClearcoat(float weight, float cosine) {
    return 1.0 - weight * mix(CLEARCOAT_F0, 1.0, schlickWeight(cosine));
}

vec3 objectToWorldNormal(uint instance, vec3 n) {
    const int at = int(instance * INSTANCE_TEXELS);
    const vec3 r0 = uintBitsToFloat(imageLoad(instances, at).xyz);
    const vec3 r1 = uintBitsToFloat(imageLoad(instances, at + 1).xyz);
    const vec3 r2 = uintBitsToFloat(imageLoad(instances, at + 2).xyz);
    // Cofactors: the inverse transpose except for the determinant, whose sign keeps the side.
    const vec3 result = vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
    return normalize(dot(r0, cross(r1, r2)) < 0.0 ? -result : result);
}

vec3 objectToWorld(uint instance, vec4 p) {
    const int at = int(instance * INSTANCE_TEXELS);
    return vec3(dot(uintBitsToFloat(imageLoad(instances, at)), p), dot(uintBitsToFloat(imageLoad(instances, at + 1)), p),
                dot(uintBitsToFloat(imageLoad(instances, at + 2)), p));
}

/// Returns the shading normal on the viewer's side. A mapped or interpolated normal may face away from the
/// viewer, or reflect the view direction into the surface, which would be black. It is tilted just enough to
/// face the viewer and to reflect along the surface.
vec3 facingNormal(vec3 normal, vec3 geometricNormal, vec3 toViewer) {
    const float least = 0.01;
    vec3 facing = normal;
    const float cosine = dot(normal, toViewer);
    if (cosine < least) {
        const vec3 tilted = normal + (least - cosine) * toViewer;
        facing = dot(tilted, tilted) > 1e-8 ? normalize(tilted) : geometricNormal;
    }
    const vec3 mirrored = reflect(-toViewer, facing);
    const float height = dot(mirrored, geometricNormal);
    const float lowest = min(least, 0.5 * dot(geometricNormal, toViewer));
    return height >= lowest ? facing : normalize(toViewer + normalize(mirrored + (lowest - height) * geometricNormal));
}

void applySpecularTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 6);
    s.specular *= materialTexture(refs.x, data, footprint).a;
    s.specularColor *= materialTexture(refs.y, data, footprint).rgb;
}

void applyClearcoatTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 6);
    s.clearcoat *= materialTexture(refs.z, data, footprint).r;
    s.clearcoatRoughness *= materialTexture(refs.w, data, footprint).g;
}

/// Sets the direction of the greater roughness: the mesh's tangent, turned by the texture and the material's rotation.
void applyAnisotropy(inout Surface s, int material, VertexData data, Footprint footprint, vec3 normal, vec4 tangent) {
    const uvec4 record = imageLoad(materials, material + 9);
    vec2 direction = uintBitsToFloat(record.yz);
    if (HAS_TEXTURES) {
        if (record.w != NONE) {
            const vec3 texel = materialTexture(record.w, data, footprint).rgb;
            const vec2 axis = texel.rg * 2.0 - 1.0;
            const float axis2 = dot(axis, axis);
            const vec2 unit = axis2 > 1e-8 ? axis * inversesqrt(axis2) : vec2(1.0, 0.0);
            direction = vec2(direction.x * unit.x - direction.y * unit.y, direction.y * unit.x + direction.x * unit.y);
            s.anisotropy *= texel.b;
        }
    }
    const vec3 t = tangent.xyz - normal * dot(normal, tangent.xyz);
    const float length2 = dot(t, t);
    if (length2 < 1e-12) return;
    const vec3 unit = t * inversesqrt(length2);
    s.anisotropyDirection = direction.x * unit + direction.y * tangent.w * cross(normal, unit);
}

void applySheenTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 11);
    s.sheenColor *= materialTexture(refs.x, data, footprint).rgb;
    s.sheenRoughness *= materialTexture(refs.y, data, footprint).a;
}

void applyDiffuseTransmissionTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 11);
    s.diffuseTransmission *= materialTexture(refs.z, data, footprint).a;
    s.diffuseTransmissionColor *= materialTexture(refs.w, data, footprint).rgb;
}

/// The film's thickness is between two values if a texture says where, else the greater.
void applyIridescenceTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec2 refs = imageLoad(materials, material + 14).xy;
    s.iridescence *= materialTexture(refs.x, data, footprint).r;
    const float least = uintBitsToFloat(imageLoad(materials, material + 13).z);
    s.iridescenceThickness = mix(least, s.iridescenceThickness, materialTexture(refs.y, data, footprint).g);
}

/// Reads the factors of the extensions that few scenes have.
void loadExtensions(inout Surface s, int material) {
    s.anisotropy = s.sheenRoughness = s.diffuseTransmission = s.dispersion = 0.0;
    s.iridescence = s.iridescenceIor = s.iridescenceThickness = 0.0;
    s.anisotropyDirection = s.sheenColor = s.diffuseTransmissionColor = vec3(0.0);
    if (HAS_ANISOTROPY) s.anisotropy = uintBitsToFloat(imageLoad(materials, material + 9).x);
    if (HAS_SHEEN) {
        const vec4 sheen = uintBitsToFloat(imageLoad(materials, material + 10));
        s.sheenColor = sheen.rgb;
        s.sheenRoughness = sheen.w;
    }
    if (HAS_DIFFUSE_TRANSMISSION) {
        const vec4 diffuse = uintBitsToFloat(imageLoad(materials, material + 12));
        s.diffuseTransmissionColor = diffuse.rgb;
        s.diffuseTransmission = diffuse.w;
    }
    if (HAS_IRIDESCENCE) {
        const vec4 film = uintBitsToFloat(imageLoad(materials, material + 13));
        s.iridescence = film.x;
        s.iridescenceIor = film.y;
        s.iridescenceThickness = film.w;
    }
    if (HAS_DISPERSION) s.dispersion = uintBitsToFloat(imageLoad(materials, material + 8).w);
}

/// The coat has its own normal map or none; the base's does not affect it.
vec3 clearcoatNormal(int material, VertexData data, Footprint footprint, vec3 normal, vec4 tangent) {
    const uvec4 coat = imageLoad(materials, material + 7);
    if (coat.x == NONE) return normal;
    return mappedNormal(normal, tangent, materialTexture(coat.x, data, footprint).rgb, uintBitsToFloat(coat.w));
}

/// `toViewer` is a unit vector.
Surface loadSurface(uint triangle, uint hitInstance, vec2 barycentrics, vec3 toViewer, RayCone cone) {
    Surface s;
    const int at = int(triangle * BVH_TRIANGLE_TEXELS);
    const vec4 t0 = imageLoad(bvhTriangles, at), t1 = imageLoad(bvhTriangles, at + 1), t2 = imageLoad(bvhTriangles, at + 2);
    const bool instanced = TWO_LEVEL && hitInstance != NONE;
    s.primitive = floatBitsToUint(t0.w) & ~BVH_TRIANGLE_ALPHA;
    s.instance = instanced ? hitInstance : floatBitsToUint(t1.w);
    vec3 v0 = t0.xyz, v1 = t1.xyz, v2 = t2.xyz;
    bool mirrored = false;
    if (TWO_LEVEL) {
        if (instanced) {
            v0 = objectToWorld(hitInstance, vec4(v0, 1.0));
            v1 = objectToWorld(hitInstance, vec4(v1, 1.0));
            v2 = objectToWorld(hitInstance, vec4(v2, 1.0));
        }
    }
    s.position = interpolate(v0, v1, v2, barycentrics);
    s.magnitude = max(maxAbs(v0), max(maxAbs(v1), maxAbs(v2)));
    const vec3 perpendicular = cross(v1 - v0, v2 - v0);
    const float doubleArea = length(perpendicular);
    s.area = 0.5 * doubleArea;
    vec3 windingNormal = perpendicular / max(doubleArea, 1e-37);
    const uvec4 shading = imageLoad(triangles, int(floatBitsToUint(t2.w)));
    s.material = materialOf(shading.w, instanced ? hitInstance : NONE);
    if (HAS_MIRRORED) {
        mirrored = (imageLoad(instances, int(s.instance * INSTANCE_TEXELS) + 3).w & INSTANCE_MIRRORED) != 0u;
    }
    if (mirrored) windingNormal = -windingNormal;
    s.front = dot(windingNormal, toViewer) >= 0.0;
    s.geometricNormal = s.front ? windingNormal : -windingNormal;
    s.normal = s.geometricNormal;

    const int material = int(s.material * MATERIAL_TEXELS);
    const uvec4 m0 = imageLoad(materials, material), m1 = imageLoad(materials, material + 1);
    const uvec4 m2 = imageLoad(materials, material + 2);
    s.baseColor = uintBitsToFloat(m0.xyz);
    s.emission = uintBitsToFloat(m1.xyz);
    s.roughness = uintBitsToFloat(m1.w);
    s.metallic = uintBitsToFloat(m2.x);
    s.specular = uintBitsToFloat(m2.y);
    s.ior = uintBitsToFloat(m2.z);
    s.transmission = uintBitsToFloat(m2.w);
    s.specularColor = HAS_SPECULAR ? uintBitsToFloat(imageLoad(materials, material + 5).yzw) : vec3(1.0);
    s.thin = (m0.w & MATERIAL_THIN) != 0u;
    if (HAS_PANES) {
        // Light behind a pane can be sampled through it, too (shadow.glsl), which reads its textures at points.
        if (cone.scattered && s.thin && s.transmission > 0.0) cone.width = 0.0;
    }
    s.unlit = (m0.w & MATERIAL_UNLIT) != 0u;
    const vec2 coat = HAS_CLEARCOAT ? uintBitsToFloat(imageLoad(materials, material + 7).yz) : vec2(0.0);
    s.clearcoat = coat.x;
    s.clearcoatRoughness = coat.y;
    float coatOverEmission = coat.x;
    loadExtensions(s, material);
    s.clearcoatNormal = s.geometricNormal;
    if (HAS_VERTEX_DATA) {
        const VertexData data = loadVertexData(shading.xyz, barycentrics);
        vec3 normal = data.normal;
        vec3 tangent = data.tangent.xyz;
        const bool smoothShaded = (shading.w & TRIANGLE_SMOOTH) != 0u;
        if (TWO_LEVEL) {
            if (instanced) {
                normal = objectToWorldNormal(hitInstance, normal);
                tangent = objectToWorld(hitInstance, vec4(tangent, 0.0));
            }
        }
        normal = smoothShaded && dot(normal, normal) > 1e-12 ? normalize(normal) : windingNormal;
        vec3 coatNormal = normal;
        s.baseColor *= data.color.rgb;
        if (HAS_TEXTURES) {
            const uvec4 refs = imageLoad(materials, material + 4);
            const Footprint footprint = footprintOn(v1 - v0, v2 - v0, perpendicular / max(doubleArea, 1e-37),
                                                    max(doubleArea, 1e-37), toViewer, cone);
            const float share = cone.scattered ? 0.0 : 1.0;
            const Footprint emitting = Footprint(share * footprint.across, share * footprint.along, footprint.exact);
            s.baseColor *= materialTexture(refs.x, data, footprint).rgb;
            s.emission *= materialTexture(refs.w, data, emitting).rgb;
            const vec4 metallicRoughness = materialTexture(refs.y, data, footprint);
            s.roughness *= metallicRoughness.g;
            s.metallic *= metallicRoughness.b;
            const float handedness = data.tangent.w * (instanced && mirrored ? -1.0 : 1.0);
            if (refs.z != NONE) {
                const float scale = uintBitsToFloat(imageLoad(materials, material + 3).z);
                normal = mappedNormal(normal, vec4(tangent, handedness), materialTexture(refs.z, data, footprint).rgb, scale);
            }
            if (HAS_CLEARCOAT) {
                coatOverEmission *= materialTexture(imageLoad(materials, material + 6).z, data, emitting).r;
                applyClearcoatTextures(s, material, data, footprint);
                coatNormal = clearcoatNormal(material, data, footprint, coatNormal, vec4(tangent, handedness));
            }
            if (HAS_SPECULAR_TEXTURES) applySpecularTextures(s, material, data, footprint);
            if (HAS_TRANSMISSION) {
                s.transmission *= materialTexture(imageLoad(materials, material + 5).x, data, footprint).r;
            }
            if (HAS_IRIDESCENCE) applyIridescenceTextures(s, material, data, footprint);
            if (HAS_SHEEN) applySheenTextures(s, material, data, footprint);
            if (HAS_DIFFUSE_TRANSMISSION) applyDiffuseTransmissionTextures(s, material, data, footprint);
        }
        if (HAS_ANISOTROPY) {
            const float handedness = data.tangent.w * (instanced && mirrored ? -1.0 : 1.0);
            const Footprint footprint = footprintOn(v1 - v0, v2 - v0, perpendicular / max(doubleArea, 1e-37),
                                                    max(doubleArea, 1e-37), toViewer, cone);
            applyAnisotropy(s, material, data, footprint, normal, vec4(tangent, handedness));
        }
        s.normal = facingNormal(s.front ? normal : -normal, s.geometricNormal, toViewer);
        if (HAS_CLEARCOAT) {
            s.clearcoatNormal = facingNormal(s.front ? coatNormal : -coatNormal, s.geometricNormal, toViewer);
        }
    }
    const bool visible = s.front || (m0.w & MATERIAL_DOUBLE_SIDED) != 0u;
    s.emission = s.unlit ? s.baseColor : visible ? s.emission : vec3(0.0);
    if (HAS_CLEARCOAT) s.emission *= emissionThroughClearcoat(coatOverEmission, dot(s.geometricNormal, toViewer));
    s.culled = !visible && !transmitsLight(s);
    s.absorption = vec3(0.0);
    if (HAS_VOLUME) {
        if (isBoundary(s)) s.absorption = uintBitsToFloat(imageLoad(materials, material + 8).xyz);
    }
    s.roughness = clamp(s.roughness, 0.0, 1.0);
    s.metallic = clamp(s.metallic, 0.0, 1.0);
    return s;
}

#endif

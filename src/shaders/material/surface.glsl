// The triangle that a ray hits: its vertices, and the part of its textures that a pixel covers.
#ifndef LIMPID_SURFACE_GLSL
#define LIMPID_SURFACE_GLSL

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
    /// As wide across as along the ray, and wider than a pixel; for rays through pixel centres, which would
    /// otherwise shimmer.
    bool wide;
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

/// How much wider than a pixel `wide` cones are.
const float WIDE = 1.7320508;

/// Intersects a cone of this width with the triangle's plane: an ellipse, longer by 1 / cosine along the ray
/// (T. Akenine-Moeller et al., "Improved shader and texture level of detail using ray cones", JCGT 2021), or
/// a larger circle around it if the cone is `wide`.
Footprint footprintOn(vec3 edge1, vec3 edge2, vec3 unitNormal, float doubleArea, vec3 toViewer, RayCone cone) {
    const float cosine = dot(unitNormal, toViewer);
    const vec3 inPlane = toViewer - cosine * unitNormal;
    const vec3 along = inPlane * inversesqrt(max(dot(inPlane, inPlane), 1e-20));
    const bool tilted = dot(inPlane, inPlane) > 1e-8;
    const vec3 axis = tilted ? along : edge1 * inversesqrt(max(dot(edge1, edge1), 1e-37));
    const vec3 other = cross(unitNormal, axis);
    const float width = cone.wide && !cone.scattered ? WIDE * cone.width : cone.width;
    const float length_ = width / max(abs(cosine), 0.05);
    return Footprint(barycentricsOf((cone.wide ? length_ : width) * other, edge1, edge2, unitNormal, doubleArea),
                     barycentricsOf(length_ * axis, edge1, edge2, unitNormal, doubleArea),
                     !cone.scattered);
}

#endif

// How a surface is curved around a hit, which says where a curved mirror's image is.
#ifndef LIMPID_CURVATURE_GLSL
#define LIMPID_CURVATURE_GLSL

#include "shaders/material/material.glsl"

struct Shape {
    vec3 normal;      // without a normal map; on the viewer's side
    float curvature;  // 1 / radius; positive if that side is convex
};

/// `surface` is the result of loadSurface() for `hit`. The curvature is how much the vertex normals turn per length,
/// averaged over the triangle's edges; 0 without smooth shading.
Shape shapeAt(Hit hit, Surface surface) {
    const Shape flatShape = Shape(surface.geometricNormal, 0.0);
    if (!HAS_VERTEX_DATA) return flatShape;
    const int at = int(hit.triangle * BVH_TRIANGLE_TEXELS);
    const vec4 t2 = imageLoad(bvhTriangles, at + 2);
    vec3 v[3] = vec3[3](imageLoad(bvhTriangles, at).xyz, imageLoad(bvhTriangles, at + 1).xyz, t2.xyz);
    const uvec4 corners = imageLoad(triangles, int(floatBitsToUint(t2.w)));
    if ((corners.w & TRIANGLE_SMOOTH) == 0u) return flatShape;
    const bool instanced = TWO_LEVEL && hit.instance != NONE;
    vec3 n[3];
    for (int i = 0; i < 3; ++i) {
        n[i] = decodeOctahedral(imageLoad(vertices, int(corners[i] * VERTEX_TEXELS)).x);
        if (instanced) {
            n[i] = normalize(objectToWorldNormal(hit.instance, n[i]));
            v[i] = objectToWorld(hit.instance, vec4(v[i], 1.0));
        }
    }
    float turns = 0.0;
    for (int i = 0; i < 3; ++i) {
        const vec3 edge = v[(i + 1) % 3] - v[i];
        turns += dot(n[(i + 1) % 3] - n[i], edge) / max(dot(edge, edge), 1e-30);
    }
    const vec3 normal = interpolate(n[0], n[1], n[2], hit.barycentrics);
    const float side = dot(normal, surface.geometricNormal) < 0.0 ? -1.0 : 1.0;
    return Shape(side * normalize(normal), side * turns / 3.0);
}

#endif

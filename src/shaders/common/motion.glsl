// Finds the hit point's position in the previous frame: the same barycentrics on the previous frame's
// triangle.
#ifndef LIMPID_MOTION_GLSL
#define LIMPID_MOTION_GLSL

#include "shaders/trace/trace.glsl"

struct PreviousPoint {
    vec3 position, normal;
};

vec3 previousToWorld(uint instance, vec4 p) {
    const int at = int(instance * PREVIOUS_INSTANCE_TEXELS);
    return vec3(dot(uintBitsToFloat(imageLoad(previousGeometry, at)), p),
                dot(uintBitsToFloat(imageLoad(previousGeometry, at + 1)), p),
                dot(uintBitsToFloat(imageLoad(previousGeometry, at + 2)), p));
}

/// Returns a right-handed orthonormal frame whose third axis is `normal` and whose first axis follows `edge`.
mat3 surfaceFrame(vec3 normal, vec3 edge) {
    const vec3 along = edge - normal * dot(normal, edge);
    const vec3 x = dot(along, along) > 1e-30 ? normalize(along) : frameAround(normal)[0];
    return mat3(x, cross(normal, x), normal);
}

vec3 safeNormalize(vec3 v, vec3 otherwise) {
    v *= scaleToOne(maxAbs(v));
    const float length2 = dot(v, v);
    return length2 > 1e-30 ? v * inversesqrt(length2) : otherwise;
}

/// `surface` is the result of loadSurface() for `hit`. The normal rotates with the surface's frame, including
/// a normal map: exact for rigid motion and for interpolated normals.
PreviousPoint previousPoint(Hit hit, Surface surface, SceneParams scene) {
    PreviousPoint previous = PreviousPoint(surface.position, surface.normal);
    if (!HAS_MOTION || hit.instance == NONE) return previous;
    const int at = int(hit.triangle * BVH_TRIANGLE_TEXELS);
    const vec4 t2 = imageLoad(bvhTriangles, at + 2);
    vec3 v[3] = vec3[3](imageLoad(bvhTriangles, at).xyz, imageLoad(bvhTriangles, at + 1).xyz, t2.xyz);
    const uvec4 corners = imageLoad(triangles, int(floatBitsToUint(t2.w)));
    const uint flags = imageLoad(instances, int(hit.instance * INSTANCE_TEXELS) + 3).w;
    const bool deforming = (flags & INSTANCE_DEFORMING) != 0u;
    const bool isSmooth = HAS_VERTEX_DATA && (corners.w & TRIANGLE_SMOOTH) != 0u;

    // Both frames in the instance's own space first; they only differ for deforming vertices.
    const vec3 edgeNow = v[1] - v[0];
    vec3 normalNow = cross(edgeNow, v[2] - v[0]), normalBefore = normalNow;
    if (isSmooth) normalBefore = normalNow = loadVertexData(corners.xyz, hit.barycentrics).normal;
    if (deforming) {
        vec3 normals[3];
        for (int i = 0; i < 3; ++i) {
            const uvec4 vertex = imageLoad(previousGeometry, int(scene.previousVertexBase + corners[i]));
            v[i] = uintBitsToFloat(vertex.xyz);
            normals[i] = decodeOctahedral(vertex.w);
        }
        normalBefore = isSmooth ? interpolate(normals[0], normals[1], normals[2], hit.barycentrics)
                                : cross(v[1] - v[0], v[2] - v[0]);
    }
    const vec3 p = interpolate(v[0], v[1], v[2], hit.barycentrics);
    previous.position = previousToWorld(hit.instance, vec4(p, 1.0));

    const vec3 up = vec3(0.0, 0.0, 1.0);
    const vec3 worldNow = objectToWorldNormal(hit.instance, safeNormalize(normalNow, up));
    const vec3 r0 = previousToWorld(hit.instance, vec4(1.0, 0.0, 0.0, 0.0));
    const vec3 r1 = previousToWorld(hit.instance, vec4(0.0, 1.0, 0.0, 0.0));
    const vec3 r2 = previousToWorld(hit.instance, vec4(0.0, 0.0, 1.0, 0.0));
    // Columns; their cross products are the inverse transpose except for the determinant, whose sign keeps
    // the side.
    const vec3 n = safeNormalize(normalBefore, up);
    const vec3 turned = cross(r1, r2) * n.x + cross(r2, r0) * n.y + cross(r0, r1) * n.z;
    const vec3 worldBefore = safeNormalize(dot(r0, cross(r1, r2)) < 0.0 ? -turned : turned, worldNow);
    const mat3 frameNow = surfaceFrame(worldNow, objectToWorld(hit.instance, vec4(edgeNow, 0.0)));
    const mat3 frameBefore = surfaceFrame(worldBefore, previousToWorld(hit.instance, vec4(v[1] - v[0], 0.0)));
    previous.normal = frameBefore * (transpose(frameNow) * surface.normal);
    return previous;
}

#endif

// What denoisers read of a frame (docs/denoising.md, "What a frame gives"), made harmless: other renderers' files may
// hold NaN and infinity.
#ifndef LIMPID_GUIDES_GLSL
#define LIMPID_GUIDES_GLSL

#include "shaders/common/camera.h"
#include "shaders/common/sampling.glsl"

/// Albedo below this is not divided by: dark texels would amplify what little light they scatter.
const float MIN_ALBEDO = 0.1;
/// None is above 1; far above it modulation would overflow.
const float MAX_ALBEDO = 65504.0;

vec3 finiteOr(vec3 value, vec3 otherwise) {
    return isFinite(value) ? value : otherwise;
}

/// From the `depth` image; 0 where nothing is seen.
float hitDistance(vec4 depth) {
    return depth.y > 0.0 && depth.x > 0.0 && isFinite(depth.xyz) ? depth.x / depth.y : 0.0;
}

/// From the `normal` and `previousNormal` images; 0 where there is none.
vec3 unitNormal(vec4 normal) {
    const vec3 n = finiteOr(normal.xyz, vec3(0.0));
    const float length2 = dot(n, n);
    return length2 > 0.0 ? n * inversesqrt(length2) : vec3(0.0);
}

vec3 modulation(vec4 albedo) {
    return clamp(finiteOr(albedo.rgb, vec3(1.0)), vec3(MIN_ALBEDO), vec3(MAX_ALBEDO));
}

/// Where in [-1, 1]^2, y up, the centre of a pixel is.
vec2 pixelOnScreen(vec2 pixel, vec2 size) {
    return (pixel + 0.5) / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
}

/// The ray through it; its length along `forward` is 1.
vec3 viewVector(CameraParams camera, vec2 onScreen) {
    if (camera.orthographic != 0u) return camera.forward;
    return camera.forward + onScreen.x * camera.right + onScreen.y * camera.up;
}

#endif

// How denoisers read a frame's images (docs/denoising.md, "What a frame gives"): other renderers' files may contain
// NaN and infinity, which are replaced here.
#ifndef LIMPID_GUIDES_GLSL
#define LIMPID_GUIDES_GLSL

#include "denoise/stages/layer.glsl"
#include "shaders/common/camera.h"
#include "shaders/common/sampling.glsl"

/// Real albedos are at most 1. Much larger values would overflow.
const float MAX_ALBEDO = 65504.0;

vec3 finiteOr(vec3 value, vec3 otherwise) {
    return isFinite(value) ? value : otherwise;
}

/// `depth` is a texel of the `depth` image. Returns 0 where nothing is seen.
float hitDistance(vec4 depth) {
    return depth.y > 0.0 && depth.x > 0.0 && isFinite(depth.xyz) ? depth.x / depth.y : 0.0;
}

/// `normal` is a texel of the `normal` or `previousNormal` image. Returns 0 where there is no normal.
vec3 unitNormal(vec4 normal) {
    const vec3 n = finiteOr(normal.xyz, vec3(0.0));
    const float length2 = dot(n, n);
    return length2 > 0.0 ? n * inversesqrt(length2) : vec3(0.0);
}

/// What light is divided by before filtering, and multiplied by afterwards. Albedos below `minAlbedo` count as that:
/// dividing by less would amplify the noise of dark texels. 0: light is not demodulated.
vec3 modulation(vec4 albedo, float minAlbedo) {
    const vec3 divisor = clamp(finiteOr(albedo.rgb, vec3(1.0)), vec3(minAlbedo), vec3(MAX_ALBEDO));
    return minAlbedo == 0.0 ? vec3(1.0) : divisor;
}

/// The centre of a pixel in [-1, 1]^2, y up.
vec2 pixelOnScreen(vec2 pixel, vec2 size) {
    return (pixel + 0.5) / size * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
}

/// The ray through that point; its component along `forward` is 1.
vec3 viewVector(CameraParams camera, vec2 onScreen) {
    if (camera.orthographic != 0u) return camera.forward;
    return camera.forward + onScreen.x * camera.right + onScreen.y * camera.up;
}

#endif

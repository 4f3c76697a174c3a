// Where a pixel's surface point was in the previous frame, and how near something there must be to be the same point.
// docs/denoising.md, "Temporal accumulation", steps 1 to 3.
#ifndef LIMPID_REPROJECTION_GLSL
#define LIMPID_REPROJECTION_GLSL

#include "denoise/stages/guides.glsl"

/// Less of the four taps than this is no history: the rest is another surface.
const float MIN_SHARE = 0.01;

struct Reprojection {
    vec2 position;  // in the previous picture, pixels, minus one half
    float depthChange;
    bool onScreen;
};

/// `moved` from the `motion` image.
Reprojection reprojectionOf(vec4 moved, vec2 pixel, vec2 size) {
    const vec3 motion = moved.xyz / max(moved.w, 1e-20);
    const vec2 position = pixel + motion.xy;
    const bool onScreen = moved.w > 0.0 && isFinite(motion) && all(greaterThanEqual(position, vec2(-0.5))) &&
                          all(lessThan(position, size - 0.5));
    return Reprojection(position, motion.z, onScreen);
}

/// Of distances, relative to the expected one by `share`. Neighbouring pixels of a tilted plane differ in distance; the
/// tolerance leaves room for that.
float depthTolerance(CameraParams camera, float expectedDepth, vec3 n, vec2 pixel, vec2 size, float share) {
    const vec3 v = viewVector(camera, pixelOnScreen(pixel, size));
    const float cosine = max(abs(dot(n, v)) * inversesqrt(dot(v, v)), 0.05);
    const float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine;
    const float spread = camera.spread / (camera.orthographic != 0u ? expectedDepth : 1.0);
    return expectedDepth * (share + 1.5 * spread * tangent);
}

#endif

// Where a pixel's surface point was in the previous frame. docs/denoising.md, "Temporal accumulation", steps 1 to 3.
#ifndef LIMPID_REPROJECTION_GLSL
#define LIMPID_REPROJECTION_GLSL

#include "denoise/stages/guides.glsl"

struct Reprojection {
    vec2 position;  // in the previous picture, pixels, minus one half
    float depthChange;
    bool onScreen;
};

/// `moved` is a texel of the `motion` image.
Reprojection reprojectionOf(vec4 moved, vec2 pixel, vec2 size) {
    const vec3 motion = moved.xyz / max(moved.w, 1e-20);
    const vec2 position = pixel + motion.xy;
    const bool onScreen = moved.w > 0.0 && isFinite(motion) && all(greaterThanEqual(position, vec2(-0.5))) &&
                          all(lessThan(position, size - 0.5));
    return Reprojection(position, motion.z, onScreen);
}

#endif

// How the moments of a signal's luminance are stored: the mean, the deviation of one frame's luminance, the fast mean,
// and the frames of history. Halves are enough for that. They would not be for the second moment: where there is little
// noise, its difference from the squared mean would be lost in rounding.
#ifndef LIMPID_SVGF_MOMENTS_GLSL
#define LIMPID_SVGF_MOMENTS_GLSL

#include "shaders/common/filter_image.glsl"

float varianceOf(vec4 moments) {
    return max(moments.y - moments.x * moments.x, 0.0);
}

/// Returns first and second moment, fast first moment, frames.
vec4 unpackedMoments(vec4 texel) {
    return vec4(texel.x, texel.x * texel.x + texel.y * texel.y, texel.zw);
}

vec4 packedMoments(vec4 moments) {
    const vec4 texel = vec4(moments.x, sqrt(varianceOf(moments)), moments.zw);
    return nearestHalf(clamp(texel, vec4(-MAX_HALF), vec4(MAX_HALF)));
}

#endif

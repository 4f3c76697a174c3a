// Reads the lags of tiles (svgf_lags.comp) at a pixel, bilinearly: docs/denoising.md, SVGF, step 4. The including shader
// declares `params` with width and height, and the image `tiles` beforehand.
#ifndef LIMPID_SVGF_LAG_BETWEEN_GLSL
#define LIMPID_SVGF_LAG_BETWEEN_GLSL

#include "denoise/methods/svgf/svgf_params.h"

/// The position of a pixel's centre between the centres of 2x2 tiles.
struct Between {
    ivec2 first;  // of 2x2 tiles
    vec2 share;   // interpolation weights of the right and the lower tiles
};

Between tilesAround(ivec2 at) {
    const vec2 tile = (vec2(at) + 0.5) / float(SVGF_TILE) - 0.5;
    return Between(ivec2(floor(tile)), fract(tile));
}

float tileAt(ivec2 tile) {
    return imageLoad(tiles, clamp(tile, ivec2(0), (ivec2(params.width, params.height) - 1) / SVGF_TILE)).x;
}

/// Interpolates the lags of 2x2 tiles, given row by row.
float lagBetween(vec4 corners, vec2 share) {
    return mix(mix(corners.x, corners.y, share.x), mix(corners.z, corners.w, share.x), share.y);
}

float lagAt(ivec2 at) {
    const Between b = tilesAround(at);
    const vec4 corners = vec4(tileAt(b.first), tileAt(b.first + ivec2(1, 0)), tileAt(b.first + ivec2(0, 1)),
                              tileAt(b.first + 1));
    return lagBetween(corners, b.share);
}

#endif

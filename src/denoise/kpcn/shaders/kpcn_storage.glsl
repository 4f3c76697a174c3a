// Texels in the buffers of the network's passes: four channels each, as halves, or as floats if KPCN_FLOAT is defined.
#ifndef LIMPID_KPCN_STORAGE_GLSL
#define LIMPID_KPCN_STORAGE_GLSL

#include "denoise/kpcn/kpcn_params.h"
#include "shaders/common/filter_image.glsl"

#ifdef KPCN_FLOAT
#define KPCN_TEXEL vec4
vec4 fromTexel(vec4 texel) {
    return texel;
}
vec4 toTexel(vec4 value) {
    return value;
}
#else
#define KPCN_TEXEL uvec2
vec4 fromTexel(uvec2 texel) {
    return unpackHalf4(texel);
}
uvec2 toTexel(vec4 value) {
    return packHalf4(clamp(value, -MAX_HALF, MAX_HALF));
}
#endif

/// Returns the texel index of a pixel's first channels in a slab.
uint channelTexel(KpcnRegion region, uint slab, ivec2 pixel) {
    return ((slab * uint(region.rows) + uint(pixel.y - region.originY)) * uint(region.pitch) + uint(pixel.x - region.originX)) * 4u;
}

/// Returns the texel index of a pixel in a buffer with one texel per pixel.
uint pixelTexel(KpcnRegion region, ivec2 pixel) {
    return uint(pixel.y - region.originY) * uint(region.pitch) + uint(pixel.x - region.originX);
}

bool inPicture(KpcnRegion region, ivec2 pixel) {
    return pixel.x >= 0 && pixel.y >= 0 && pixel.x < region.pictureWidth && pixel.y < region.pictureHeight;
}

#endif

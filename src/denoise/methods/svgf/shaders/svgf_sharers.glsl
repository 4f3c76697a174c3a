// The young pixels of a group. They are either few and scattered, or many in one place. So a group collects them and
// distributes the rows of their taps over all of its invocations. For GPUs; all invocations must call both functions.
#ifndef LIMPID_SVGF_SHARERS_GLSL
#define LIMPID_SVGF_SHARERS_GLSL

#include "denoise/methods/svgf/svgf_params.h"

const uint GROUP = uint(SVGF_YOUNG_TILE);
layout(local_size_x = SVGF_YOUNG_TILE, local_size_y = SVGF_YOUNG_TILE) in;

shared uint youngCount;
shared uint youngPixels[GROUP * GROUP];

/// What an invocation does: a part of the rows of one pixel's taps. `sharers` invocations after one another have the
/// same pixel.
struct Share {
    bool any;  // false: nothing to do
    ivec2 at;
    uint part;
    uint sharers;
};

/// Returns the number of young pixels, the same to all invocations.
uint collectYoung(bool isYoung) {
    if (gl_LocalInvocationIndex == 0u) youngCount = 0u;
    barrier();
    if (isYoung) youngPixels[atomicAdd(youngCount, 1u)] = gl_LocalInvocationIndex;
    barrier();
    return youngCount;
}

/// More sharers than there are rows would be idle. `count` is collectYoung()'s result, not 0.
Share shareOf(uint count, uint rows) {
    const uint sharers = min(GROUP * GROUP / count, rows), number = gl_LocalInvocationIndex / sharers;
    if (number >= count) return Share(false, ivec2(0), 0u, sharers);
    const uint pixel = youngPixels[number];
    const ivec2 at = ivec2(gl_WorkGroupID.xy * GROUP + uvec2(pixel % GROUP, pixel / GROUP));
    return Share(true, at, gl_LocalInvocationIndex % sharers, sharers);
}

#endif

#version 460
#extension GL_EXT_scalar_block_layout : require
// Smooths the edges that edges_find.comp found, by their shape. docs/denoising.md, "Edges".
#include "denoise/stages/guides.glsl"
#include "denoise/stages/taa/edges_params.h"
#include "denoise/stages/taa/encoding.glsl"
#include "shaders/common/filter_image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    EdgesParams params;
};
READ_LAYER(1, beauty);
layout(set = 0, binding = 2, r32ui) uniform readonly uimage2D edges;
#ifdef LIMPID_FILTER_BUFFERS
layout(set = 0, binding = 3, rgba16f) uniform writeonly image2D smoothed;
#else
layout(set = 0, binding = 3, rgba32f) uniform writeonly image2D smoothed;
#endif

const ivec2 RIGHT = ivec2(1, 0), BELOW = ivec2(0, 1);

bool isInside(ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && at.x < int(params.width) && at.y < int(params.height);
}

/// Whether there is an edge between the pixel and the next one in this direction.
bool hasEdge(ivec2 at, ivec2 direction) {
    return isInside(at) && (imageLoad(edges, at).x & (direction == RIGHT ? EDGE_RIGHT : EDGE_BELOW)) != 0u;
}

/// The number of pixels, at most `reach`, by which the edge beside `at` goes on in the direction `step_`. `across`: from
/// one side of the edge to the other.
int lengthOf(ivec2 at, ivec2 across, ivec2 step_) {
    int pixels = 0;
    while (pixels < int(params.reach) && hasEdge(at + (pixels + 1) * step_, across)) ++pixels;
    return pixels;
}

/// How far the surface's border lies beyond the pixels' at one end of an edge: half a pixel on `side`, where the edge
/// turns to this side; the same negative, where it turns away; 0 where it ends, forks or goes on. `before` and the next
/// pixel `along` lie on both sides of that end.
float heightAt(ivec2 before, ivec2 side, ivec2 along) {
    const bool here = hasEdge(before, along), beyond = hasEdge(before + side, along);
    return here == beyond ? 0.0 : here ? 0.5 : -0.5;
}

/// The share of a pixel that the surface of its neighbour at `at` + `side` covers, by the edge between them. The border
/// is a straight line between two ends that lie on different sides of the pixels' edge; otherwise it goes from each end
/// to the edge's middle.
float coverage(ivec2 at, ivec2 side) {
    const ivec2 across = abs(side), along = across == RIGHT ? BELOW : RIGHT;
    const ivec2 owner = min(at, at + side);  // its bits tell of the edge
    if (!hasEdge(owner, across)) return 0.0;
    const int before = lengthOf(owner, across, -along), after = lengthOf(owner, across, along);
    const bool begins = before < int(params.reach), ends = after < int(params.reach);
    const float first = begins ? heightAt(at - (before + 1) * along, side, along) : 0.0;
    const float last = ends ? heightAt(at + after * along, side, along) : 0.0;
    const float all_ = float(before + after + 1), here = float(before) + 0.5;
    if (first * last < 0.0) return max(mix(first, last, here / all_), 0.0);
    const float towards = 2.0 * here / all_;  // 0 and 2: the ends
    return max(first * max(1.0 - towards, 0.0) + last * max(towards - 1.0, 0.0), 0.0);
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (!isInside(at)) return;
    vec3 color = LOAD_LAYER(beauty, at).rgb;
    const bool isEdge = hasEdge(at, RIGHT) || hasEdge(at, BELOW) || hasEdge(at - RIGHT, RIGHT) || hasEdge(at - BELOW, BELOW);
    if (isEdge) {
        const ivec2 sides[4] = {RIGHT, BELOW, -RIGHT, -BELOW};
        vec3 sum = vec3(0.0);
        float covered = 0.0;
        for (int i = 0; i < 4; ++i) {
            const float share = coverage(at, sides[i]);
            if (share == 0.0) continue;
            sum += share * encode(LOAD_LAYER(beauty, at + sides[i]).rgb);
            covered += share;
        }
        // Pixels between several edges may be covered from all sides.
        const float scale = 1.0 / max(covered, 1.0);
        if (covered > 0.0) color = decode(scale * sum + (1.0 - scale * covered) * encode(color));
    }
    imageStore(smoothed, at, vec4(color, 1.0));
}

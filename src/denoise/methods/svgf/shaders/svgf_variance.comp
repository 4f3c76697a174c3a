#version 460
#extension GL_EXT_scalar_block_layout : require
// svgf_variance.glsl with gpu::Backing::Image. An invocation handles a column of pixels, which share most of their
// neighbours.
#extension GL_EXT_control_flow_attributes : require
#include "denoise/methods/svgf/shaders/svgf_variance.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

/// A neighbour: its surface and its first and second moment. It counts if it lies in the picture and has light.
struct Neighbour {
    Surface surface;
    vec2 moments;
    bool counts;
};

Neighbour neighbourAt(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const vec4 m = imageLoad(moments, inside);
    return Neighbour(surfaceAt(inside), momentsBeside(m), at == inside && m.w > 0.0);
}

/// Adds weighted moments and the weight. `from` is the neighbour's offset.
void add(inout vec3 sum, SurfaceCentre centre, Neighbour other, ivec2 from) {
    const float weight = from == ivec2(0) ? 1.0 : exp2(surfaceExponent(centre, other.surface, perDepthOf(centre, from)));
    if (other.counts) sum += weight * vec3(other.moments, 1.0);
}

void main() {
    const ivec2 first = ivec2(gl_GlobalInvocationID.xy) * ivec2(1, SVGF_COLUMN);
    SurfaceCentre centres[SVGF_COLUMN];
    vec3 sums[SVGF_COLUMN];
    bool young[SVGF_COLUMN];
    bool any = false;
    [[unroll]] for (int n = 0; n < SVGF_COLUMN; ++n) {
        const ivec2 at = first + ivec2(0, n);
        young[n] = isYoung(at);
        any = any || young[n];
        sums[n] = vec3(0.0);
        if (young[n]) centres[n] = centreOf(surfaceAt(at), at);
    }
    if (!any) return;
    for (int i = -RADIUS; i <= RADIUS; ++i) {
        [[unroll]] for (int j = -RADIUS; j < RADIUS + SVGF_COLUMN; ++j) {
            const Neighbour other = neighbourAt(first + ivec2(i, j));
            [[unroll]] for (int n = 0; n < SVGF_COLUMN; ++n) {
                if (abs(j - n) <= RADIUS && young[n]) add(sums[n], centres[n], other, ivec2(i, j - n));
            }
        }
    }
    [[unroll]] for (int n = 0; n < SVGF_COLUMN; ++n) {
        if (young[n]) storeDeviation(first + ivec2(0, n), sums[n]);
    }
}

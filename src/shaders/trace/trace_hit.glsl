// Identifies the candidate hit in the hit shaders of the `hardware` tracer.
#ifndef LIMPID_TRACE_HIT_GLSL
#define LIMPID_TRACE_HIT_GLSL

#include "shaders/common/scene_data.glsl"

/// Returns the instance and the first triangle of the tree that was hit.
uvec2 placementOfHit() {
    if (!TWO_LEVEL) return uvec2(NONE, 0u);
    return imageLoad(bvhInstances, int(uint(gl_InstanceID) * BVH_INSTANCE_TEXELS) + 3).yz;
}

#endif

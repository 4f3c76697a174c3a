// Light sampling from one point, for shaders that test it.
#include "shaders/trace/trace.glsl"
#include "shaders/material/lights.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 20, scalar) uniform Params {
    SceneParams scene;
    vec3 from, normal;
    uint count, seed;
} params;

// Both sides back to radiance, and what the camera sees directly.
#include "denoise/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    KpcnComposeParams params;
};
#ifdef KPCN_BUFFERS
layout(set = 0, binding = 1, scalar) readonly buffer diffuseTexels { vec4 texels[]; } diffuse;
layout(set = 0, binding = 2, scalar) readonly buffer specularTexels { vec4 texels[]; } specular;
#define LOAD(clean, at) clean.texels[(at).y * params.width + (at).x]
#else
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D diffuse;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D specular;
#define LOAD(clean, at) imageLoad(clean, at)
#endif
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D beauty;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.width || at.y >= params.height) return;
    const vec3 surface = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + KPCN_EPSILON;
    const vec3 scattered = LOAD(diffuse, at).rgb * surface + exp(LOAD(specular, at).rgb) - 1.0;
    imageStore(beauty, at, vec4(scattered + finiteOr(imageLoad(emission, at).rgb, vec3(0.0)), 1.0));
}

// Both sides back to radiance, each as near to its noisy light as that is sure; and what the camera sees directly.
#include "denoise/guides.glsl"
#include "denoise/kpcn/kpcn_params.h"
#include "shaders/filter_image.glsl"

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
layout(set = 0, binding = 6, rgba32f) uniform readonly image2D noisyDiffuse;
layout(set = 0, binding = 7, rgba32f) uniform readonly image2D noisySpecular;

/// Towards `noisy` until their luminances are no further apart than so many of its standard errors.
vec3 within(vec3 clean, vec4 noisy) {
    const vec3 light = clamp(finiteOr(noisy.rgb, vec3(0.0)), 0.0, MAX_HALF);
    if (params.standardErrors == 0.0 || !isFinite(vec3(noisy.a))) return clean;
    const float reach = params.standardErrors * sqrt(max(noisy.a, 0.0) * params.ofMean);
    const float apart = abs(luminance(clean) - luminance(light));
    return apart > reach ? mix(light, clean, reach / apart) : clean;
}

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= params.width || at.y >= params.height) return;
    const vec3 surface = clamp(finiteOr(imageLoad(albedo, at).rgb, vec3(0.0)), 0.0, MAX_ALBEDO) + KPCN_EPSILON;
    const vec3 scattered = within(LOAD(diffuse, at).rgb * surface, imageLoad(noisyDiffuse, at)) +
                           within(exp(LOAD(specular, at).rgb) - 1.0, imageLoad(noisySpecular, at));
    imageStore(beauty, at, vec4(scattered + finiteOr(imageLoad(emission, at).rgb, vec3(0.0)), 1.0));
}

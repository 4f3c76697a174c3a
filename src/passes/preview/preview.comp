#version 460
#extension GL_EXT_scalar_block_layout : require
// Shades first hits with a light at the camera and a sky above, independent of the scene's lights, to show
// shape and colour.
#include "passes/preview/preview_params.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    PreviewParams params;
};
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D albedo;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D albedoSpecular;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D emission;
layout(set = 0, binding = 4, rgba32f) uniform readonly image2D normal;
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D position;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D shaded;

const float AMBIENT = 0.15, SKY = 0.25, HEADLIGHT = 0.6;  // they sum to 1: a white surface that faces camera
                                                          // and sky
const vec3 BACKDROP = vec3(0.16, 0.18, 0.21);

/// Scales radiance, which is unbounded, to a colour in [0,1].
vec3 emittedColor(vec3 radiance) {
    return radiance / max(1.0, max(radiance.r, max(radiance.g, radiance.b)));
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel);
    const vec3 n = imageLoad(normal, at).xyz;
    vec3 color = BACKDROP;
    if (n != vec3(0.0)) {
        const vec3 away = imageLoad(position, at).xyz - params.camera.origin;
        const vec3 toViewer = params.camera.orthographic != 0u ? -params.camera.forward : -normalize(away);
        const float light = AMBIENT + SKY * (0.5 + 0.5 * n.y) + HEADLIGHT * abs(dot(n, toViewer));
        const vec3 reflected = min(imageLoad(albedo, at).rgb + imageLoad(albedoSpecular, at).rgb, vec3(1.0));
        color = max(reflected * light, emittedColor(imageLoad(emission, at).rgb));
    }
    imageStore(shaded, at, vec4(color, 0.0));
}

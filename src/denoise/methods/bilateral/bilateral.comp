#version 460
#extension GL_EXT_scalar_block_layout : require
// The joint bilateral filter of bilateral.h, where its weights are.
#include "denoise/methods/bilateral/bilateral_params.h"
#include "denoise/stages/guides.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    BilateralParams params;
};
layout(constant_id = 0) const bool TWO_LIGHTS = true;  // light is diffuse + specular, else diffuse alone
layout(constant_id = 1) const bool EMISSION = true;
READ_LAYER(1, diffuse);
READ_LAYER(2, specular);
READ_LAYER(3, albedo);
READ_LAYER(4, emission);
READ_LAYER(5, normal);
READ_LAYER(6, depth);
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D beauty;

struct Tap {
    vec3 light;   // without albedo
    vec3 normal;
    vec3 point;   // seen from the eye
    bool counts;  // a surface is seen, and its light is a number
};

vec3 lightAt(ivec2 at) {
    vec3 light = LOAD_LAYER(diffuse, at).rgb;
    if (TWO_LIGHTS) light += LOAD_LAYER(specular, at).rgb;
    return light;
}

vec3 pointAt(ivec2 at, float distance) {
    const vec2 onScreen = pixelOnScreen(vec2(at), vec2(params.width, params.height));
    const CameraParams camera = params.camera;
    if (camera.orthographic != 0u)
        return onScreen.x * camera.right + onScreen.y * camera.up + distance * camera.forward;
    return distance * normalize(viewVector(camera, onScreen));
}

Tap tapAt(ivec2 at) {
    const float distance = hitDistance(LOAD_LAYER(depth, at));
    const vec3 light = lightAt(at) / modulation(LOAD_WIDE_LAYER(albedo, at), params.minAlbedo);
    const bool counts = distance > 0.0 && isFinite(light);
    return Tap(light, unitNormal(LOAD_LAYER(normal, at)), pointAt(at, distance), counts);
}

float weightOf(Tap centre, Tap tap, ivec2 offset) {
    const float cosine = max(dot(centre.normal, tap.normal), 1e-6);
    const float deviation = abs(dot(tap.point - centre.point, centre.normal));
    return exp(-params.spatial * float(offset.x * offset.x + offset.y * offset.y)) *
           pow(cosine, params.normalPower) * exp(-deviation / (params.plane * length(centre.point)));
}

vec3 filtered(ivec2 pixel) {
    const Tap centre = tapAt(pixel);
    const vec3 own = centre.counts ? centre.light : vec3(0.0);
    vec4 sum = centre.counts ? vec4(own, 1.0) : vec4(0.0);
    for (int y = -params.radius; y <= params.radius; ++y) {
        for (int x = -params.radius; x <= params.radius; ++x) {
            const ivec2 at = pixel + ivec2(x, y);
            const bool inside = all(greaterThanEqual(at, ivec2(0))) && at.x < params.width && at.y < params.height;
            if ((x == 0 && y == 0) || !inside) continue;
            const Tap tap = tapAt(at);
            if (tap.counts) sum += weightOf(centre, tap, ivec2(x, y)) * vec4(tap.light, 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : own;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    // Where no surface is seen, there is nothing to filter.
    const bool seen = hitDistance(LOAD_LAYER(depth, pixel)) > 0.0;
    vec3 light = seen ? filtered(pixel) * modulation(LOAD_WIDE_LAYER(albedo, pixel), params.minAlbedo)
                      : finiteOr(lightAt(pixel), vec3(0.0));
    if (EMISSION) light += finiteOr(LOAD_LAYER(emission, pixel).rgb, vec3(0.0));
    imageStore(beauty, pixel, vec4(light, 1.0));
}

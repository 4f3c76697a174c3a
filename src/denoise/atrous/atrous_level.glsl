// One level of the edge-avoiding a-trous transform: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, "Edge-Avoiding A-Trous
// Wavelet Transform for fast Global Illumination Filtering", HPG 2010. docs/denoising.md has the weights.
#include "denoise/atrous/atrous_params.h"
#include "denoise/guides.glsl"
#include "shaders/filter_image.glsl"

layout(constant_id = 1) const uint GROUP_X = 8;
layout(constant_id = 2) const uint GROUP_Y = 8;
layout(local_size_x = 8, local_size_y = 8, local_size_x_id = 1, local_size_y_id = 2) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousLevelParams params;
};
READ_HALF4(1, signal);
READ_UINT2(2, geometry);
WRITE_HALF4(3, filtered);

const float B3[3] = float[3](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
const float LOG2_E = 1.4426950408889634;

/// What a pixel's stored depth says of its distance from a centre's plane: depth * (constant + offset), where `offset`
/// changes by `perPixel` from pixel to pixel (perspective).
struct PlaneDistance {
    float constant;
    float offset;  // at the centre
    vec2 perPixel;
};

/// In units of the centre's distance from the eye. Without `plane`: the difference of depths.
PlaneDistance planeDistance(vec3 n, float depth, vec2 pixel) {
    if (params.plane == 0u) return PlaneDistance(1.0, 0.0, vec2(0.0));
    const vec2 size = vec2(params.width, params.height);
    const vec2 onScreen = pixelOnScreen(pixel, size);
    const vec3 v = viewVector(params.camera, onScreen);
    const vec3 scaled = n * (inversesqrt(dot(v, v)) / max(depth, 1e-30));
    const vec2 across = vec2(dot(scaled, params.camera.right), dot(scaled, params.camera.up));
    return PlaneDistance(dot(scaled, params.camera.forward), dot(onScreen, across), across * vec2(2.0, -2.0) / size);
}

float alongNormal(PlaneDistance plane, float depth, vec2 pixels) {
    const float offset = plane.offset + dot(plane.perPixel, pixels);
    return params.camera.orthographic != 0u && params.plane != 0u ? depth * plane.constant + offset
                                                                  : depth * (plane.constant + offset);
}

struct Centre {
    vec3 normal;
    PlaneDistance plane;
    float here;
    vec4 sum;  // of weighted light; of weights
};

struct Tap {
    vec4 light;
    vec3 normal;
    float depth;
};

// An invocation filters 2x2 pixels that lie a step apart: of their 4 x 25 taps only 36 are different, and reading them
// is what costs.
Centre centres[4];

Tap loadTap(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 packed = LOAD_UINT2(geometry, inside);
    return Tap(LOAD_HALF4(signal, inside), decodeOctahedral(packed.x), at == inside ? uintBitsToFloat(packed.y) : 0.0);
}

Centre centreOf(ivec2 at) {
    const Tap tap = loadTap(at);
    Centre centre;
    centre.normal = tap.normal;
    centre.plane = planeDistance(tap.normal, tap.depth, vec2(at));
    centre.here = alongNormal(centre.plane, tap.depth, vec2(0.0));
    // Relative to its neighbours, the centre weighs more the more samples it has.
    const float weight = B3[0] * B3[0] * (1.0 + tap.light.a * params.fade);
    centre.sum = vec4(tap.light.rgb * weight, weight);
    return centre;
}

void addTo(int number, Tap tap, ivec2 from) {
    if (abs(from.x) > 2 || abs(from.y) > 2 || from == ivec2(0)) return;  // known when compiled
    const vec3 turned = tap.normal - centres[number].normal;
    const float deviation =
        alongNormal(centres[number].plane, tap.depth, vec2(params.step * from)) - centres[number].here;
    const float exponent = dot(turned, turned) * params.normalScale + deviation * deviation * params.depthScale;
    const float weight = B3[abs(from.x)] * B3[abs(from.y)] * exp2(-LOG2_E * exponent);
    centres[number].sum += tap.depth > 0.0 ? weight * vec4(tap.light.rgb, 1.0) : vec4(0.0);
}

void addTap(ivec2 first, int i, int j) {
    const Tap tap = loadTap(first + params.step * ivec2(i, j));
    addTo(0, tap, ivec2(i, j));
    addTo(1, tap, ivec2(i - 1, j));
    addTo(2, tap, ivec2(i, j - 1));
    addTo(3, tap, ivec2(i - 1, j - 1));
}

// Spelled out rather than looped: the weights are constants only so.
void addRow(ivec2 first, int j) {
    addTap(first, -2, j);
    addTap(first, -1, j);
    addTap(first, 0, j);
    addTap(first, 1, j);
    addTap(first, 2, j);
    addTap(first, 3, j);
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const vec4 before = LOAD_HALF4(signal, at);
    const bool seen = uintBitsToFloat(LOAD_UINT2(geometry, at).y) > 0.0;
    STORE_HALF4(filtered, at, seen ? vec4(centre.sum.rgb / centre.sum.a, before.a) : before);
}

void main() {
    const ivec2 invocation = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 first = invocation / params.step * (2 * params.step) + invocation % params.step;
    if (first.x >= int(params.width) || first.y >= int(params.height)) return;
    const ivec2 right = ivec2(params.step, 0), down = ivec2(0, params.step);
    centres[0] = centreOf(first);
    centres[1] = centreOf(first + right);
    centres[2] = centreOf(first + down);
    centres[3] = centreOf(first + right + down);
    addRow(first, -2);
    addRow(first, -1);
    addRow(first, 0);
    addRow(first, 1);
    addRow(first, 2);
    addRow(first, 3);
    store(first, centres[0]);
    store(first + right, centres[1]);
    store(first + down, centres[2]);
    store(first + right + down, centres[3]);
}

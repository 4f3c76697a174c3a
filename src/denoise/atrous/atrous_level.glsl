// One level of the edge-avoiding a-trous transform: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, "Edge-Avoiding A-Trous
// Wavelet Transform for fast Global Illumination Filtering", HPG 2010. docs/denoising.md has the weights.
#include "denoise/atrous/atrous_params.h"
#include "denoise/guides.glsl"
#include "shaders/filter_image.glsl"

layout(constant_id = 1) const uint GROUP_X = 8;
layout(constant_id = 2) const uint GROUP_Y = 8;
layout(constant_id = 3) const bool PLANE = true;
layout(constant_id = 4) const bool ORTHOGRAPHIC = false;
layout(local_size_x = 8, local_size_y = 8, local_size_x_id = 1, local_size_y_id = 2) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousLevelParams params;
};
READ_HALF4(1, signal);
READ_UINT2(2, geometry);
WRITE_HALF4(3, filtered);

const float B3[3] = float[3](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);
// On CPUs reading is what costs: an invocation filters 4x2 pixels that lie a step apart, of whose 8 x 25 taps only 48 are
// different. On GPUs registers are what is scarce: one pixel each.
#ifdef LIMPID_FILTER_BUFFERS
const ivec2 BLOCK = ivec2(1, 1);
#else
const ivec2 BLOCK = ivec2(4, 2);
#endif


struct Tap {
    vec4 light;
    vec3 normal;
    vec3 point;  // without PLANE: the depth, and nothing
    bool seen;
};

struct Centre {
    vec3 normal;
    vec3 across;  // dot(across, tap's point) - here is the tap's distance from the plane, in units of that from the eye
    float here;
    vec4 sum;  // of weighted light; of weights
    vec4 light;
    bool seen;
};

Centre centres[8];  // as many as the block has pixels

/// In space, relative to the eye. Without PLANE: the depth alone.
vec3 pointAt(ivec2 at, float depth) {
    if (!PLANE) return vec3(depth, 0.0, 0.0);
    const vec2 onScreen = pixelOnScreen(vec2(at), vec2(params.width, params.height));
    const vec3 beside = onScreen.x * params.camera.right + onScreen.y * params.camera.up;
    return ORTHOGRAPHIC ? beside + depth * params.camera.forward : depth * (params.camera.forward + beside);
}

Tap loadTap(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 packed = LOAD_UINT2(geometry, inside);
    const float depth = uintBitsToFloat(packed.y);
    return Tap(LOAD_HALF4(signal, inside), decodeOctahedral(packed.x), pointAt(at, depth), at == inside && depth > 0.0);
}

Centre centreOf(Tap tap) {
    Centre centre;
    centre.normal = tap.normal;
    const float distance2 = ORTHOGRAPHIC ? pow(dot(tap.point, params.camera.forward), 2.0) : dot(tap.point, tap.point);
    centre.across = PLANE ? tap.normal * inversesqrt(max(distance2, 1e-36)) : vec3(1.0, 0.0, 0.0);
    centre.here = dot(centre.across, tap.point);
    // Relative to its neighbours, the centre weighs more the more samples it has.
    const float weight = B3[0] * B3[0] * (1.0 + tap.light.a * params.fade);
    centre.sum = vec4(tap.light.rgb * weight, weight);
    centre.light = tap.light;
    centre.seen = tap.seen;
    return centre;
}

/// `from` and `number` are known when this is compiled.
void addTo(int number, Tap tap, ivec2 from) {
    if (abs(from.x) > 2 || abs(from.y) > 2 || from == ivec2(0)) return;
    const float deviation = dot(centres[number].across, tap.point) - centres[number].here;
    // |n - n'|^2 of unit vectors is 2 - 2 dot(n, n').
    const float exponent = (dot(tap.normal, centres[number].normal) - 1.0) * params.normalScale -
                           deviation * deviation * params.depthScale;
    const float weight = B3[abs(from.x)] * B3[abs(from.y)] * exp2(exponent);
    centres[number].sum += (tap.seen ? weight : 0.0) * vec4(tap.light.rgb, 1.0);
}

void addTap(ivec2 first, int i, int j) {
    const Tap tap = loadTap(first + params.step * ivec2(i, j));
    addTo(0, tap, ivec2(i, j));
    if (BLOCK.x == 1) return;
    addTo(1, tap, ivec2(i - 1, j));
    addTo(2, tap, ivec2(i - 2, j));
    addTo(3, tap, ivec2(i - 3, j));
    addTo(4, tap, ivec2(i, j - 1));
    addTo(5, tap, ivec2(i - 1, j - 1));
    addTo(6, tap, ivec2(i - 2, j - 1));
    addTo(7, tap, ivec2(i - 3, j - 1));
}

// Spelled out rather than looped: only so is it certain that the weights are constants.
void addRow(ivec2 first, int j) {
    addTap(first, -2, j);
    addTap(first, -1, j);
    addTap(first, 0, j);
    addTap(first, 1, j);
    addTap(first, 2, j);
    if (BLOCK.x == 1) return;
    addTap(first, 3, j);
    addTap(first, 4, j);
    addTap(first, 5, j);
}

void addRows(ivec2 first) {
    addRow(first, -2);
    addRow(first, -1);
    addRow(first, 0);
    addRow(first, 1);
    addRow(first, 2);
    if (BLOCK.y > 1) addRow(first, 3);
}

ivec2 pixelOfBlock(ivec2 first, int number) {
    return first + params.step * ivec2(number % BLOCK.x, number / BLOCK.x);
}

void begin(ivec2 first, int number) {
    centres[number] = centreOf(loadTap(pixelOfBlock(first, number)));
}

void finish(ivec2 first, int number) {
    const ivec2 at = pixelOfBlock(first, number);
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const Centre c = centres[number];
    STORE_HALF4(filtered, at, c.seen ? vec4(c.sum.rgb / c.sum.a, c.light.a) : c.light);
}

void main() {
    const ivec2 invocation = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 first = invocation / params.step * (BLOCK * params.step) + invocation % params.step;
    if (first.x >= int(params.width) || first.y >= int(params.height)) return;
    begin(first, 0);
    if (BLOCK.x > 1) {
        begin(first, 1);
        begin(first, 2);
        begin(first, 3);
        begin(first, 4);
        begin(first, 5);
        begin(first, 6);
        begin(first, 7);
    }
    addRows(first);
    finish(first, 0);
    if (BLOCK.x > 1) {
        finish(first, 1);
        finish(first, 2);
        finish(first, 3);
        finish(first, 4);
        finish(first, 5);
        finish(first, 6);
        finish(first, 7);
    }
}

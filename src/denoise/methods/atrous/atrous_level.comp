#version 460
#extension GL_EXT_scalar_block_layout : require
// One level of the edge-avoiding a-trous transform: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, "Edge-Avoiding
// A-Trous Wavelet Transform for fast Global Illumination Filtering", HPG 2010. docs/denoising.md has the weights.
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 1) const bool PLANE = true;
layout(constant_id = 2) const bool ORTHOGRAPHIC = false;
layout(constant_id = 3) const bool COLOR = false;  // compare light, too

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousLevelParams params;
};
READ_HALF4(1, signal);
READ_UINT2(2, geometry);
WRITE_HALF4(3, filtered);

#include "denoise/stages/atrous/kernel.glsl"

// GPUs decode taps at some cost, and more pixels would need more registers than there are. CPUs mainly wait for
// loads, of which a larger block shares more. As in atrous.cpp.
#ifdef LIMPID_FILTER_BUFFERS
layout(local_size_x = 32, local_size_y = 4) in;
const ivec2 BLOCK = ivec2(2, 2);
#else
layout(local_size_x = 8, local_size_y = 8) in;
const ivec2 BLOCK = ivec2(4, 2);
#endif
const int REACH = 2;

struct Tap {
    vec4 light;
    vec3 normal;
    float depth;
    bool seen;
};

struct Centre {
    vec3 normal;   // times normalScale
    // The distance from the pixel's plane of a point of depth 1 on the ray through this pixel; its change from tap to
    // tap to the right, and down. Times `depth` that is the distance of any point.
    vec3 towards;
    float here;  // the pixel's own point
    vec4 sum;    // of weighted light, and of the weights
    vec4 light;
    bool seen;
};

Tap loadTap(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 packed = LOAD_UINT2(geometry, inside);
    const float depth = uintBitsToFloat(packed.y);
    return Tap(LOAD_HALF4(signal, inside), decodeOctahedral(packed.x), depth, at == inside && depth > 0.0);
}

/// Centre::towards. Distances are in units of the point's distance from the eye, times the tolerance.
vec3 planeOf(Tap tap, ivec2 at) {
    if (!PLANE) return vec3(params.depthScale, 0.0, 0.0);
    const vec2 onScreen = (vec2(at) + 0.5) * params.toScreen + vec2(-1.0, 1.0);
    const vec3 ray = viewVector(params.camera, onScreen);
    const vec3 across = tap.normal * (params.depthScale * inversesqrt(dot(ray, ray)) / max(tap.depth, 1e-18));
    const vec2 oneTap = float(params.step) * params.toScreen;
    return vec3(dot(across, ray), dot(across, params.camera.right) * oneTap.x,
                dot(across, params.camera.up) * oneTap.y);
}

Centre begin(ivec2 at, int number) {
    const Tap tap = loadTap(at);
    Centre centre;
    centre.normal = tap.normal * params.normalScale;
    centre.towards = planeOf(tap, at);
    centre.here = tap.depth * centre.towards.x;
    // The more samples the mean has, the more the centre weighs relative to its neighbours.
    const float weight = tap.light.a > 0.0 ? splineWeight(ivec2(0)) * (1.0 + tap.light.a * params.fade) : 0.0;
    centre.sum = vec4(tap.light.rgb * weight, weight);
    centre.light = tap.light;
    centre.seen = tap.seen;
    return centre;
}

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    const float beside = dot(vec2(from), centre.towards.yz);
    const float point = ORTHOGRAPHIC ? tap.depth * centre.towards.x + beside : tap.depth * (centre.towards.x + beside);
    const float deviation = point - centre.here;
    // |n - n'|^2 of unit vectors is 2 - 2 dot(n, n').
    const float turned = min(dot(tap.normal, centre.normal) - params.normalScale, 0.0);  // rounding may say more
    float exponent = turned - deviation * deviation;
    if (COLOR) {
        const vec3 change = tap.light.rgb - centre.light.rgb;
        exponent -= dot(change, change) * params.colorScale;
    }
    const float weight = splineWeight(from) * exp2(exponent);
    centre.sum += (tap.seen && tap.light.a > 0.0 ? weight : 0.0) * vec4(tap.light.rgb, 1.0);
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    const bool hasMean = centre.seen && centre.sum.a > 0.0;
    // Light that comes from neighbours alone counts at the next level.
    const vec4 mean = vec4(centre.sum.rgb / centre.sum.a, max(centre.light.a, 1e-3));
    STORE_HALF4(filtered, at, hasMean ? mean : centre.light);
}

bool isFiltered(Centre centre) {
    return centre.seen;
}

#include "denoise/stages/atrous/level.glsl"

void main() {
    const ivec2 first = firstOfBlock(ivec2(gl_GlobalInvocationID.xy));
    if (inPicture(first)) filterBlock(first);
}

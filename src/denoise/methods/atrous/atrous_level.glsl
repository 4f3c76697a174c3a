// One level of the edge-avoiding a-trous transform: H. Dammertz, D. Sewtz, J. Hanika, H. Lensch, "Edge-Avoiding A-Trous
// Wavelet Transform for fast Global Illumination Filtering", HPG 2010. docs/denoising.md has the weights.
#include "denoise/methods/atrous/atrous_params.h"
#include "denoise/stages/guides.glsl"
#include "shaders/common/filter_image.glsl"

layout(constant_id = 1) const bool PLANE = true;
layout(constant_id = 2) const bool ORTHOGRAPHIC = false;
layout(constant_id = 3) const bool COLOR = false;  // differences of light count

layout(set = 0, binding = 0, scalar) uniform Params {
    AtrousLevelParams params;
};
READ_HALF4(1, signal);
READ_UINT2(2, geometry);
WRITE_HALF4(3, filtered);

const float B3[3] = float[3](6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0);

struct Tap {
    vec4 light;
    vec3 normal;
    float depth;
    bool seen;
};

struct Centre {
    vec3 normal;   // times normalScale
    vec3 towards;  // of a point as deep as the eye's `forward` is long, its distance from the plane: at the centre's pixel,
                   // and how much it changes by a tap to the right and by one down
    float here;
    vec4 sum;  // of weighted light; of weights
    vec4 light;
    bool seen;
};

Tap loadTap(ivec2 at) {
    const ivec2 inside = clamp(at, ivec2(0), ivec2(params.width, params.height) - 1);
    const uvec2 packed = LOAD_UINT2(geometry, inside);
    const float depth = uintBitsToFloat(packed.y);
    return Tap(LOAD_HALF4(signal, inside), decodeOctahedral(packed.x), depth, at == inside && depth > 0.0);
}

/// The plane through a pixel's point. Distances from it are in units of the point's from the eye and of the tolerance.
vec3 planeOf(Tap tap, ivec2 at) {
    if (!PLANE) return vec3(params.depthScale, 0.0, 0.0);
    const vec2 onScreen = (vec2(at) + 0.5) * params.toScreen + vec2(-1.0, 1.0);
    const vec3 ray = viewVector(params.camera, onScreen);
    const vec3 across = tap.normal * (params.depthScale * inversesqrt(dot(ray, ray)) / max(tap.depth, 1e-18));
    const vec2 oneTap = float(params.step) * params.toScreen;
    return vec3(dot(across, ray), dot(across, params.camera.right) * oneTap.x,
                dot(across, params.camera.up) * oneTap.y);
}

Centre centreOf(Tap tap, ivec2 at) {
    Centre centre;
    centre.normal = tap.normal * params.normalScale;
    centre.towards = planeOf(tap, at);
    centre.here = tap.depth * centre.towards.x;
    // Relative to its neighbours, the centre weighs more the more samples it has.
    const float weight = B3[0] * B3[0] * (1.0 + tap.light.a * params.fade);
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
    float exponent = dot(tap.normal, centre.normal) - params.normalScale - deviation * deviation;
    if (COLOR) {
        const vec3 change = tap.light.rgb - centre.light.rgb;
        exponent -= dot(change, change) * params.colorScale;
    }
    const float weight = B3[abs(from.x)] * B3[abs(from.y)] * exp2(exponent);
    centre.sum += (tap.seen ? weight : 0.0) * vec4(tap.light.rgb, 1.0);
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    STORE_HALF4(filtered, at, centre.seen ? vec4(centre.sum.rgb / centre.sum.a, centre.light.a) : centre.light);
}

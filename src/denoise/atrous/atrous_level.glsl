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

/// In space, relative to the eye. Without PLANE: the depth alone.
vec3 pointAt(ivec2 at, float depth) {
    if (!PLANE) return vec3(depth, 0.0, 0.0);
    const vec2 onScreen = (vec2(at) + 0.5) * params.toScreen + vec2(-1.0, 1.0);
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

void addTo(inout Centre centre, Tap tap, ivec2 from) {
    const float deviation = dot(centre.across, tap.point) - centre.here;
    // |n - n'|^2 of unit vectors is 2 - 2 dot(n, n').
    const float exponent =
        (dot(tap.normal, centre.normal) - 1.0) * params.normalScale - deviation * deviation * params.depthScale;
    const float weight = B3[abs(from.x)] * B3[abs(from.y)] * exp2(exponent);
    centre.sum += (tap.seen ? weight : 0.0) * vec4(tap.light.rgb, 1.0);
}

void store(ivec2 at, Centre centre) {
    if (at.x >= int(params.width) || at.y >= int(params.height)) return;
    STORE_HALF4(filtered, at, centre.seen ? vec4(centre.sum.rgb / centre.sum.a, centre.light.a) : centre.light);
}

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

/// What a pixel's stored depth says of its distance from the centre's plane: depth * (constant + offset), where `offset`
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
    const vec3 scaled = n * (inversesqrt(dot(v, v)) / depth);
    const vec2 across = vec2(dot(scaled, params.camera.right), dot(scaled, params.camera.up));
    return PlaneDistance(dot(scaled, params.camera.forward), dot(onScreen, across), across * vec2(2.0, -2.0) / size);
}

float alongNormal(PlaneDistance plane, float depth, vec2 pixels) {
    const float offset = plane.offset + dot(plane.perPixel, pixels);
    return params.camera.orthographic != 0u && params.plane != 0u ? depth * plane.constant + offset
                                                                  : depth * (plane.constant + offset);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width || pixel.y >= params.height) return;
    const ivec2 at = ivec2(pixel), last = ivec2(params.width, params.height) - 1;
    const vec4 centre = LOAD_HALF4(signal, at);
    const uvec2 centreGeometry = LOAD_UINT2(geometry, at);
    const vec3 n = decodeOctahedral(centreGeometry.x);
    const float d = uintBitsToFloat(centreGeometry.y);
    if (d <= 0.0) {
        STORE_HALF4(filtered, at, centre);
        return;
    }
    const PlaneDistance plane = planeDistance(n, d, vec2(pixel));
    const float here = alongNormal(plane, d, vec2(0.0));
    // Relative to its neighbours, the centre weighs more the more samples it has.
    const float centreWeight = B3[0] * B3[0] * (1.0 + centre.a * params.fade);
    vec3 sum = centre.rgb * centreWeight;
    float weights = centreWeight;
    for (int j = -2; j <= 2; ++j) {
        for (int i = -2; i <= 2; ++i) {
            if (i == 0 && j == 0) continue;
            const ivec2 offset = params.step * ivec2(i, j), q = at + offset, inside = clamp(q, ivec2(0), last);
            const uvec2 tapGeometry = LOAD_UINT2(geometry, inside);
            const float depth = uintBitsToFloat(tapGeometry.y);
            const vec3 turned = decodeOctahedral(tapGeometry.x) - n;
            const float deviation = alongNormal(plane, depth, vec2(offset)) - here;
            const float exponent =
                dot(turned, turned) * params.normalScale + deviation * deviation * params.depthScale;
            const bool counts = q == inside && depth > 0.0;
            const float weight = counts ? B3[abs(i)] * B3[abs(j)] * exp2(-LOG2_E * exponent) : 0.0;
            sum += weight * LOAD_HALF4(signal, inside).rgb;
            weights += weight;
        }
    }
    STORE_HALF4(filtered, at, vec4(sum / weights, centre.a));
}

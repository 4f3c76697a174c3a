#version 460
// Converts encoded sRGB of an extended range to the numbers of a surface of a high dynamic range.
layout(push_constant) uniform Push {
    uint encoding;     // SurfaceEncoding
    float paperWhite;  // cd/m^2 of 1
    float peak;        // largest cd/m^2 of a channel
} push;
layout(set = 0, binding = 0, rgba16f) uniform readonly image2D composed;

layout(location = 0) out vec4 result;

/// The inverse of sRGB's curve, which continues above 1.
vec3 srgbDecode(vec3 encoded) {
    return mix(pow((encoded + 0.055) / 1.055, vec3(2.4)), encoded / 12.92, lessThanEqual(encoded, vec3(0.04045)));
}

/// Rec. ITU-R BT.2087: from the primaries of Rec. 709 to those of Rec. 2020; columns.
const mat3 toRec2020 = mat3(0.6274, 0.0691, 0.0164, 0.3293, 0.9195, 0.0880, 0.0433, 0.0114, 0.8956);

/// SMPTE ST 2084: cd/m^2 of each channel, as a share of 10,000.
vec3 pq(vec3 share) {
    const float m1 = 2610.0 / 16384.0, m2 = 2523.0 / 4096.0 * 128.0;
    const float c1 = 3424.0 / 4096.0, c2 = 2413.0 / 4096.0 * 32.0, c3 = 2392.0 / 4096.0 * 32.0;
    const vec3 power = pow(clamp(share, 0.0, 1.0), vec3(m1));
    return pow((c1 + c2 * power) / (1.0 + c3 * power), vec3(m2));
}

void main() {
    const vec3 encoded = imageLoad(composed, ivec2(gl_FragCoord.xy)).rgb;
    const vec3 light = min(push.paperWhite * srgbDecode(max(encoded, vec3(0.0))), vec3(push.peak));
    result = vec4(push.encoding == 2u ? pq(toRec2020 * light / 10000.0) : light / 80.0, 1.0);
}

// Orthonormal frames, spherical maps and warps of the unit square.
#ifndef LIMPID_SAMPLING_GLSL
#define LIMPID_SAMPLING_GLSL

const float PI = 3.14159265358979;

float luminance(vec3 c) {
    return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

bool isFinite(vec3 v) {
    // Checks bits, since compilers may assume that NaN does not occur and remove isnan().
    const uvec3 exponents = floatBitsToUint(v) & 0x7f800000u;
    return all(notEqual(exponents, uvec3(0x7f800000u)));
}

/// Returns an orthonormal frame around a unit vector: T. Duff et al., "Building an orthonormal basis,
/// revisited", JCGT 2017.
mat3 frameAround(vec3 n) {
    const float s = n.z >= 0.0 ? 1.0 : -1.0;
    const float a = -1.0 / (s + n.z);
    const float b = n.x * n.y * a;
    return mat3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y), n);
}

/// Returns an orthonormal frame around a unit vector whose first axis is as near to `direction` as possible; any frame
/// if it is along the vector, or 0.
mat3 frameAlong(vec3 n, vec3 direction) {
    const vec3 t = direction - n * dot(n, direction);
    const float length2 = dot(t, t);
    if (length2 < 1e-12) return frameAround(n);
    const vec3 unit = t * inversesqrt(length2);
    return mat3(unit, cross(n, unit), n);
}

/// Samples a direction with probability density cos(theta) / pi about +Z.
vec3 sampleCosineHemisphere(vec2 u) {
    const float r = sqrt(u.x);
    const float phi = 2.0 * PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), sqrt(max(0.0, 1.0 - u.x)));
}

/// Samples the unit disc uniformly: P. Shirley, K. Chiu, "A low distortion map between disk and square", JGT 1997.
/// Neighbours in the square stay neighbours, so evenly spread points stay evenly spread.
vec2 sampleDisc(vec2 u) {
    const vec2 q = 2.0 * u - 1.0;
    const bool wide = abs(q.x) > abs(q.y);
    const float r = wide ? q.x : q.y;
    const float ratio = r != 0.0 ? (wide ? q.y : q.x) / r : 0.0;
    const float phi = 0.25 * PI * (wide ? ratio : 2.0 - ratio);
    return r * vec2(cos(phi), sin(phi));
}

/// Samples uniform barycentrics (of vertices 1 and 2).
vec2 sampleTriangle(vec2 u) {
    const float s = sqrt(u.x);
    return vec2(s * (1.0 - u.y), s * u.y);
}

/// The power heuristic with exponent 2: E. Veach, "Robust Monte Carlo methods for light transport simulation", 1997.
float powerHeuristic(float a, float b) {
    // The limit keeps squares finite: the density of a tiny, distant lamp is large.
    a = min(a, 1e18);
    b = min(b, 1e18);
    const float a2 = a * a, b2 = b * b;
    return a2 > 0.0 ? a2 / (a2 + b2) : 0.0;
}

/// Latitude-longitude map: row 0 is +Y, the centre column is -Z (scene/lights/environment.h).
vec2 latLongOf(vec3 d) {
    // Not acos(d.y): lavapipe's has an error of 5e-5 of the picture's height.
    return vec2(atan(d.x, -d.z) / (2.0 * PI) + 0.5, atan(length(d.xz), d.y) / PI);
}

vec3 directionOfLatLong(vec2 uv) {
    const float phi = (uv.x - 0.5) * 2.0 * PI, theta = uv.y * PI;
    return vec3(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
}

/// Octahedral coordinates of a unit vector, -1 to 1. 0 becomes +Z.
vec2 octahedralOf(vec3 n) {
    const vec2 e = n.xy / max(abs(n.x) + abs(n.y) + abs(n.z), 1e-30);
    const vec2 signs = vec2(e.x >= 0.0 ? 1.0 : -1.0, e.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? e : (1.0 - abs(e.yx)) * signs;
}

/// Encodes a unit vector as 2 x snorm16: Q. Meyer et al., "On Floating-Point Normal Vectors", EGSR 2010. 0
/// becomes +Z.
uint encodeOctahedral(vec3 n) {
    return packSnorm2x16(octahedralOf(n));
}

/// The integer of `bits` bits. Adds half of their range as a bit, because GPUs convert integers at an eighth of their
/// addition rate.
float signedOf(uint low, uint bits) {
    const uint sign = 1u << (bits - 1u);
    return uintBitsToFloat(0x4B000000u | (low ^ sign)) - (8388608.0 + float(sign));
}

/// `e` are octahedral coordinates from -`one` to `one`.
vec3 fromOctahedral(vec2 e, float one) {
    vec3 n = vec3(e, one - abs(e.x) - abs(e.y));
    const float t = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -t : t;
    n.y += n.y >= 0.0 ? -t : t;
    return normalize(n);
}

vec3 decodeOctahedral(uint packed) {
    return fromOctahedral(vec2(signedOf(packed & 0xFFFFu, 16u), signedOf(packed >> 16, 16u)), 32767.0);
}

/// Offsets the origin of a secondary ray so that rounding cannot make it hit the same surface again. `n` is
/// the geometric normal on the ray's side. `magnitude` is the largest coordinate used in computing p: the
/// error of p is a few of its ulps, so the offset scales with it and works at any scale and distance from the
/// origin.
vec3 offsetRay(vec3 p, vec3 n, float magnitude) {
    const float ulps = 128.0 / 16777216.0;
    return p + n * (ulps * magnitude);
}

/// Maps an invocation of an 8x8 group to a pixel so that every eight consecutive ones cover 4x2 pixels and
/// every 32 cover 8x4. This keeps a SIMD unit's rays coherent (13 % fewer instructions on lavapipe in `heavy`
/// than rows of eight).
uvec2 pixelOfInvocation(uvec2 group, uint local) {
    return group * 8u + uvec2((local & 3u) | ((local >> 3) & 1u) << 2, ((local >> 2) & 1u) | (local >> 4) << 1);
}

float maxAbs(vec3 v) {
    const vec3 a = abs(v);
    return max(a.x, max(a.y, a.z));
}

/// Returns the power of two that takes a magnitude to between 1 and 2. It changes no digit of what it scales, whose
/// squares then neither overflow nor underflow.
float scaleToOne(float magnitude) {
    return uintBitsToFloat(0x7f000000u - (floatBitsToUint(magnitude) & 0x7f800000u));
}

struct Face {
    vec3 normal;       // unit; 0 if the triangle has no area
    float doubleArea;  // twice the area
};

/// Returns the triangle between two edges from the same corner.
Face faceBetween(vec3 edge1, vec3 edge2) {
    // Unscaled, the square of the area would overflow for edges above 4e9, and underflow for edges below 1e-10.
    const float scale = scaleToOne(max(maxAbs(edge1), maxAbs(edge2)));
    const vec3 perpendicular = cross(scale * edge1, scale * edge2);
    const float doubleArea = length(perpendicular), back = scaleToOne(scale);
    return Face(perpendicular / max(doubleArea, 1e-37), doubleArea * back * back);
}

/// Takes the first part of an interval that is divided in proportion to two weights, or the second. `u`, in [0,1),
/// becomes the place in that part, which is again uniform.
uint takePart(float first, float second, inout float u) {
    const float share = first / (first + second);
    const bool isFirst = u < share;
    u = isFirst ? u / share : (u - share) / (1.0 - share);
    u = clamp(u, 0.0, 1.0 - 1.0 / float(0x01000000));
    return isFirst ? 0u : 1u;
}

/// Takes one of four parts by their weights; like takePart(). Never one without weight.
uint takeOfFour(vec4 weights, inout float u) {
    const vec2 halves = vec2(weights.x + weights.y, weights.z + weights.w);
    u *= halves.x + halves.y;
    const bool upper = u >= halves.x && halves.y > 0.0;
    u -= upper ? halves.x : 0.0;
    const vec2 pair = upper ? weights.zw : weights.xy;
    const bool second = u >= pair.x && pair.y > 0.0;
    u = (u - (second ? pair.x : 0.0)) / (second ? pair.y : pair.x);
    u = clamp(u, 0.0, 1.0 - 1.0 / float(0x01000000));
    return (upper ? 2u : 0u) + (second ? 1u : 0u);
}

#endif

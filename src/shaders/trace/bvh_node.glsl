// Intersects a ray with the four children of a node, in either format of scene_layout.h.
#ifndef LIMPID_BVH_NODE_GLSL
#define LIMPID_BVH_NODE_GLSL

#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_data.glsl"

const uint KEY_MISS = 0xffffffffu;

struct TraversalRay {
    vec3 origin, direction, inverse;
    vec3 acrossX, acrossY;        // perpendicular to the ray; as long as 1, roughly
    vec3 offsetNear, offsetFar;  // the t of a plane at p is p * inverse + offset; lower and upper bound
};

TraversalRay traversalRay(vec3 origin, vec3 direction) {
    // A component of 0 would give 0 * infinity, so it is replaced by the smallest value that does not
    // overflow.
    const vec3 tiny = vec3(1e-18);
    const vec3 safe = mix(direction, mix(tiny, -tiny, lessThan(direction, vec3(0.0))), lessThan(abs(direction), tiny));
    // In an instance's own space the direction may have any length, the fifth power of which would be in products.
    const vec3 along = TWO_LEVEL ? scaleToOne(maxAbs(direction)) * direction : direction;
    const vec3 acrossX = abs(along.x) > abs(along.z) ? vec3(-along.y, along.x, 0.0) : vec3(0.0, -along.z, along.y);
    const vec3 inverse = 1.0 / safe;
    const vec3 offset = -origin * inverse, padding = 3e-7 * abs(offset);
    return TraversalRay(origin, direction, inverse, acrossX, cross(along, acrossX), offset - padding,
                        offset + padding);
}

/// Returns entry distances as sortable keys: distance bits with the child's number in the lowest two;
/// KEY_MISS if the ray misses.
uvec4 keysOf(vec4 tNear, vec4 tFar) {
    const uvec4 keys = (floatBitsToUint(tNear) & ~3u) | uvec4(0u, 1u, 2u, 3u);
    return mix(uvec4(KEY_MISS), keys, lessThanEqual(tNear, tFar));
}

vec4 bytesOf(uint word) {
    return vec4(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u), float(word >> 24));
}

float exponentScale(uint biased) {
    return uintBitsToFloat(biased << 23);
}

uvec4 intersectQuantised(uint node, TraversalRay ray, float tMax, out uvec4 children) {
    const int at = int(node * BVH_NODE_TEXELS);
    const uvec4 head = imageLoad(bvhNodes, at);
    const uvec4 boundsA = imageLoad(bvhNodes, at + 1);
    const uvec4 boundsB = imageLoad(bvhNodes, at + 2);
    children = imageLoad(bvhNodes, at + 3);
    const vec3 scale = ray.inverse * vec3(exponentScale(head.w & 255u), exponentScale((head.w >> 8) & 255u),
                                          exponentScale((head.w >> 16) & 255u));
    const vec3 base = (uintBitsToFloat(head.xyz) - ray.origin) * ray.inverse;
    // Both sides of a box move outwards by a bound on the rounding error of origin and cells in ray space, so
    // that flat boxes and hits on their edges are not lost (compare T. Ize, "Robust BVH ray traversal", JCGT
    // 2013).
    const vec3 padding = 5e-7 * (abs(base) + 255.0 * abs(scale));
    const vec3 baseNear = base - padding, baseFar = base + padding;
    const bvec3 flip = lessThan(ray.inverse, vec3(0.0));
    const vec4 nearX = bytesOf(flip.x ? boundsA.w : boundsA.x) * scale.x + baseNear.x;
    const vec4 nearY = bytesOf(flip.y ? boundsB.x : boundsA.y) * scale.y + baseNear.y;
    const vec4 nearZ = bytesOf(flip.z ? boundsB.y : boundsA.z) * scale.z + baseNear.z;
    const vec4 farX = bytesOf(flip.x ? boundsA.x : boundsA.w) * scale.x + baseFar.x;
    const vec4 farY = bytesOf(flip.y ? boundsA.y : boundsB.x) * scale.y + baseFar.y;
    const vec4 farZ = bytesOf(flip.z ? boundsA.z : boundsB.y) * scale.z + baseFar.z;
    const vec4 tNear = max(max(nearX, nearY), max(nearZ, vec4(0.0)));
    const vec4 tFar = min(min(farX, farY), min(farZ, vec4(tMax)));
    return keysOf(tNear, tFar);
}

/// Faster on GPUs, where arithmetic costs more than loads.
uvec4 intersectExpanded(uint node, TraversalRay ray, float tMax, out uvec4 children) {
    const int at = int(node * EXPANDED_NODE_TEXELS);
    children = imageLoad(bvhNodes, at + 6);
    const bvec3 flip = lessThan(ray.inverse, vec3(0.0));
    const ivec3 near = at + mix(ivec3(0, 1, 2), ivec3(3, 4, 5), flip), far = at + mix(ivec3(3, 4, 5), ivec3(0, 1, 2), flip);
    const vec4 nearX = uintBitsToFloat(imageLoad(bvhNodes, near.x)) * ray.inverse.x + ray.offsetNear.x;
    const vec4 nearY = uintBitsToFloat(imageLoad(bvhNodes, near.y)) * ray.inverse.y + ray.offsetNear.y;
    const vec4 nearZ = uintBitsToFloat(imageLoad(bvhNodes, near.z)) * ray.inverse.z + ray.offsetNear.z;
    const vec4 farX = uintBitsToFloat(imageLoad(bvhNodes, far.x)) * ray.inverse.x + ray.offsetFar.x;
    const vec4 farY = uintBitsToFloat(imageLoad(bvhNodes, far.y)) * ray.inverse.y + ray.offsetFar.y;
    const vec4 farZ = uintBitsToFloat(imageLoad(bvhNodes, far.z)) * ray.inverse.z + ray.offsetFar.z;
    const vec4 tNear = max(max(nearX, nearY), max(nearZ, vec4(0.0)));
    const vec4 tFar = min(min(farX, farY), min(farZ, vec4(tMax)));
    // The offsets include their own rounding error; this is that of the sum.
    return keysOf(tNear, tFar * 1.000001);
}

uvec4 intersectChildren(uint node, TraversalRay ray, float tMax, out uvec4 children) {
    return EXPANDED_NODES ? intersectExpanded(node, ray, tMax, children)
                          : intersectQuantised(node, ray, tMax, children);
}

uint childOf(uint key, uvec4 children) {
    const uint low = (key & 1u) != 0u ? children.y : children.x;
    const uint high = (key & 1u) != 0u ? children.w : children.z;
    return (key & 2u) != 0u ? high : low;
}

#endif

// Between the picture and the world: the ray through a point of the picture, and the point that sees a place.
#ifndef LIMPID_CAMERA_RAY_GLSL
#define LIMPID_CAMERA_RAY_GLSL

#include "shaders/camera.h"
#include "shaders/rng.glsl"
#include "shaders/trace.glsl"

/// Point `index` of the Halton sequence in the bases 2 and 3, in [0, 1)^2.
vec2 halton(uint index) {
    vec2 point = vec2(float(bitfieldReverse(index) >> 8) / float(0x01000000), 0.0);
    for (float digit = 1.0 / 3.0; index > 0u; index /= 3u) {
        point.y += digit * float(index % 3u);
        digit /= 3.0;
    }
    return point;
}

/// The point in the pixel; draws two numbers in every mode, so that all that follow are the same.
vec2 subpixel(ViewParams view, uint sampleOfLaunch, inout uint rng) {
    const vec2 u = random2(rng);
    const uint index = view.firstSample + sampleOfLaunch;
    if (view.jitter == JITTER_OFF || index == 0u) return vec2(0.5);
    return view.jitter == JITTER_PIXEL ? u : halton(index);
}

Ray cameraRay(CameraParams camera, vec2 size, vec2 pixel) {
    const vec2 p = vec2(2.0, -2.0) * pixel / size + vec2(-1.0, 1.0);
    const vec3 offset = p.x * camera.right + p.y * camera.up;
    if (camera.orthographic != 0u) return Ray(camera.origin + offset, camera.forward, INFINITE_DISTANCE);
    return Ray(camera.origin, normalize(camera.forward + offset), INFINITE_DISTANCE);
}

Ray cameraRay(ViewParams view, vec2 pixel) {
    return cameraRay(view.camera, vec2(view.width, view.height), pixel);
}

/// A pixel's footprint, for texture levels: its width at the eye and what that grows by with distance.
struct Cone {
    float width, spread;
};

Cone pixelCone(CameraParams camera) {
    return camera.orthographic != 0u ? Cone(camera.spread, 0.0) : Cone(0.0, camera.spread);
}

/// Pixel that sees the point (of a miss: the direction) in xy; distance in z; valid in w.
vec4 project(CameraParams camera, vec2 size, vec3 point, bool isDirection) {
    const vec3 d = isDirection ? point : point - camera.origin;
    const vec2 along = vec2(dot(d, camera.right) / dot(camera.right, camera.right),
                            dot(d, camera.up) / dot(camera.up, camera.up));
    const float w = dot(d, camera.forward);
    const bool orthographic = camera.orthographic != 0u;
    const vec2 ndc = orthographic ? along : along / max(w, 1e-20);
    const vec2 pixel = (ndc * vec2(0.5, -0.5) + 0.5) * size;
    return vec4(pixel, orthographic ? w : length(d), w > 0.0 && !(orthographic && isDirection) ? 1.0 : 0.0);
}

#endif

// Converts between the picture and the world: the ray through a point of the picture, and the projection of a
// point.
#ifndef LIMPID_CAMERA_RAY_GLSL
#define LIMPID_CAMERA_RAY_GLSL

#include "shaders/common/camera.h"
#include "shaders/common/rng.glsl"
#include "shaders/common/sampling.glsl"
#include "shaders/trace/trace.glsl"

/// Returns point `index` of the Halton sequence in bases 2 and 3, in [0, 1)^2.
vec2 halton(uint index) {
    vec2 point = vec2(float(bitfieldReverse(index) >> 8) / float(0x01000000), 0.0);
    for (float digit = 1.0 / 3.0; index > 0u; index /= 3u) {
        point.y += digit * float(index % 3u);
        digit /= 3.0;
    }
    return point;
}

/// Returns the position within the pixel. Draws two random numbers in every mode, so that later numbers are
/// the same.
vec2 subpixel(ViewParams view, uint sampleOfLaunch, inout uint rng) {
    const vec2 u = stratified2(rng);
    const uint index = view.firstSample + sampleOfLaunch;
    if (view.jitter == JITTER_OFF || index == 0u) return vec2(0.5);
    return view.jitter == JITTER_PIXEL ? u : 0.5 + view.jitterSpan * (halton(index) - 0.5);
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

layout(constant_id = 25) const bool HAS_LENS = false;  // the camera has a thin lens, not a pinhole

/// Like cameraRay(), but through a random point of the lens, uniform by area: all rays of one point of the picture meet
/// where the ray through the lens's centre meets the plane in focus (M. Potmesil, I. Chakravarty, "A lens and aperture
/// camera model for synthetic image generation", SIGGRAPH 1981; R. L. Cook et al., "Distributed ray tracing", SIGGRAPH
/// 1984). Draws two random numbers if there is a lens.
Ray lensRay(ViewParams view, vec2 pixel, inout uint rng) {
    if (!HAS_LENS) return cameraRay(view, pixel);
    const CameraParams camera = view.camera;
    const vec2 p = vec2(2.0, -2.0) * pixel / vec2(view.width, view.height) + vec2(-1.0, 1.0);
    const vec2 lens = camera.lensRadius * sampleDisc(stratified2(rng));
    const vec3 shift = lens.x * normalize(camera.right) + lens.y * normalize(camera.up);
    const vec3 inFocus = camera.focusDistance * (camera.forward + p.x * camera.right + p.y * camera.up);
    return Ray(camera.origin + shift, normalize(inFocus - shift), INFINITE_DISTANCE);
}

/// The ray cone for texture filtering: the width at the eye, and its growth with distance (T. Akenine-Moeller
/// et al., "Texture level of detail strategies for real-time ray tracing", Ray Tracing Gems, 2019).
struct Cone {
    float width, spread;
};

/// Returns the relative width of the n-th ray (from 1) through the same pixel: 1 / sqrt(n), as if n rays
/// shared it evenly. The mean converges to the unfiltered texture, while few rays are still smooth (compare
/// the shrinking kernels in C. Knaus, M. Zwicker, "Progressive photon mapping: a probabilistic approach", ACM
/// TOG 2011).
float shareOfRay(float n) {
    return inversesqrt(n);
}

/// Returns the number of the ray within its pixel, from 1, over all launches of a mean.
float rayNumber(ViewParams view, uint sampleIndex) {
    return view.samplesBefore + float(sampleIndex) + 1.0;
}

/// Returns the cone of a camera ray: its share of the pixel, or the whole pixel if every ray goes through the
/// centre.
Cone pixelCone(ViewParams view, uint sampleIndex) {
    const float n = view.jitter != JITTER_OFF ? rayNumber(view, sampleIndex) : 1.0;
    const float width = view.camera.spread * shareOfRay(n);
    return view.camera.orthographic != 0u ? Cone(width, 0.0) : Cone(0.0, width);
}

/// Projects a point (for a miss: a direction) to a pixel position in xy; distance in z; valid in w.
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

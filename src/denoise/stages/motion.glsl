// The encodings of an embedding program's motion. docs/denoising.md, "What a frame gives", describes the layer that comes
// of them: previous minus current position in pixels, the change of the distance, and 1 where they are known.
#ifndef LIMPID_MOTION_GLSL
#define LIMPID_MOTION_GLSL

#include "denoise/stages/guides.glsl"
#include "denoise/stages/motion_encoding.h"

vec3 positionOf(CameraParams camera, float distance, vec3 v, vec2 onScreen) {
    if (camera.orthographic != 0u)
        return camera.origin + onScreen.x * camera.right + onScreen.y * camera.up + distance * camera.forward;
    return camera.origin + v * (distance / length(v));
}

float previousDistance(MotionEncoding encoding, vec3 position) {
    const CameraParams before = encoding.previousCamera;
    const vec3 toPoint = position - before.origin;
    return before.orthographic != 0u ? dot(toPoint, before.forward) : length(toPoint);
}

/// The distance from the previous eye at which its ray through a pixel (minus one half) meets the tangent plane of a
/// reflector that stands still; not above 0 if it does not.
float previousReflector(MotionEncoding encoding, vec3 position, vec3 normal, vec2 pixel, vec2 size) {
    const CameraParams before = encoding.previousCamera;
    const vec2 onScreen = pixelOnScreen(pixel, size);
    const vec3 direction = normalize(viewVector(before, onScreen));
    const vec3 origin =
        before.origin + (before.orthographic != 0u ? onScreen.x * before.right + onScreen.y * before.up : vec3(0.0));
    const float facing = dot(direction, normal);
    return facing != 0.0 ? dot(position - origin, normal) / facing : 0.0;
}

/// The motion in pixels of a point, or of a direction (w 0: the sky), that stands still and that the jittered ray of
/// `pixel` sees; 0 if it was behind the previous eye.
vec4 motionOfStill(MotionEncoding encoding, vec4 point, vec2 pixel, vec2 size) {
    const float w = dot(encoding.previousClipW, point);
    if (!(w > 0.0)) return vec4(0.0);
    const vec2 before = vec2(dot(encoding.previousClipX, point), dot(encoding.previousClipY, point)) / w;
    return vec4((0.5 * before + 0.5) * size - (pixel + 0.5 + encoding.jitter), 0.0, 1.0);
}

/// `texel` is one of the program's, `distance` that of the pixel's surface; 0: nothing is seen.
vec4 motionOfTexel(MotionEncoding encoding, vec4 texel, CameraParams camera, vec2 pixel, vec2 size, float distance) {
    if (encoding.kind == MOTION_LAYER) return texel;
    if (encoding.hasPrevious == 0u) return vec4(0.0);
    const bool given = encoding.kind == MOTION_GIVEN;
    vec4 moved = vec4(texel.xy * encoding.toPixels, texel.z * encoding.toDistance, 1.0);
    if (!given || encoding.toDistance == 0.0) {
        const vec2 onScreen = pixelOnScreen(pixel + encoding.jitter, size);
        const vec3 v = viewVector(camera, onScreen);
        const bool seen = distance > 0.0;
        const vec4 point = seen ? vec4(positionOf(camera, distance, v, onScreen), 1.0) : vec4(v, 0.0);
        if (!given) moved = motionOfStill(encoding, point, pixel, size);
        moved.z = seen ? previousDistance(encoding, point.xyz) - distance : 0.0;
    }
    return isFinite(moved.xyz) ? moved : vec4(0.0);
}

/// The same for the motion of reflections. All zero says that there is no reflection to follow. Without a third
/// component (reflectionsAreFlat()), the change of the distance is 0 here.
vec4 reflectionOfTexel(MotionEncoding encoding, vec4 texel) {
    if (encoding.reflections == MOTION_LAYER) return texel;
    if (encoding.toDistance == 0.0) texel.z = 0.0;
    const bool valid = encoding.hasPrevious != 0u && texel.xyz != vec3(0.0) && isFinite(texel.xyz);
    return valid ? vec4(texel.xy * encoding.toPixels, texel.z * encoding.toDistance, 1.0) : vec4(0.0);
}

/// Whether the motion of reflections has no change of the distance, so that it follows from the reflector.
bool reflectionsAreFlat(MotionEncoding encoding) {
    return encoding.reflections == MOTION_GIVEN && encoding.toDistance == 0.0;
}

#endif

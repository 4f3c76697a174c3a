// Positions, and motion. The including shader declares `IngestParams params` beforehand.
#include "shaders/common/filter_image.glsl"

/// Motion in halves: wrong by at most 1/128 pixel up to 32 pixels, and by 1/2048 of itself beyond.
vec4 storedMotion(vec4 moved) {
    if (!isFinite(moved.xyz)) return vec4(0.0);
    return nearestHalf(clamp(moved, -MAX_HALF, MAX_HALF));
}

vec3 positionOf(float distance, vec3 v, vec2 onScreen) {
    const CameraParams c = params.camera;
    if (c.orthographic != 0u) return c.origin + onScreen.x * c.right + onScreen.y * c.up + distance * c.forward;
    return c.origin + v * (distance / length(v));
}

float previousDistance(vec3 position) {
    const vec3 toPoint = position - params.previousCamera.origin;
    return params.previousCamera.orthographic != 0u ? dot(toPoint, params.previousCamera.forward) : length(toPoint);
}

/// The motion in pixels of a point, or of a direction (w 0: the sky), that stands still; 0 if it was behind the
/// previous eye.
vec4 motionOfStill(vec4 point, vec2 pixel) {
    const float w = dot(params.previousClipW, point);
    if (!(w > 0.0)) return vec4(0.0);
    const vec2 before = vec2(dot(params.previousClipX, point), dot(params.previousClipY, point)) / w;
    const vec2 pixelBefore = (0.5 * before + 0.5) * vec2(params.width, params.height);
    return vec4(pixelBefore - pixel - 0.5, 0.0, 1.0);
}

// Where smooth glass shows what is behind it: rays near the camera's ray are followed through every surface to first
// order (ray transfer matrices: E. Hecht, "Optics", section 6.2; surfaces hit at an angle: H. Coddington's sagittal
// equation), which says how the picture moves. Exact for panes; for curved glass, errors grow away from its centre.
#ifndef LIMPID_LENS_GLSL
#define LIMPID_LENS_GLSL

#include "shaders/common/mirror.glsl"

/// Height above the camera's ray, and slope against it, as multiples of a neighbouring ray's height (x) and slope (y)
/// where it meets the glass.
struct Lens {
    vec2 height, slope;
};

const Lens NO_LENS = Lens(vec2(1.0, 0.0), vec2(0.0, 1.0));

void travel(inout Lens lens, float distance) {
    lens.height += distance * lens.slope;
}

/// At a surface that is met at this cosine. eta: relative index of refraction. curvature: of shapeAt().
void refractAt(inout Lens lens, float cosine, float eta, float curvature) {
    const float behind = sqrt(max(0.0, 1.0 - (1.0 - cosine * cosine) / (eta * eta)));
    lens.slope = lens.slope / eta - lens.height * ((behind - cosine / eta) * curvature);
}

void reflectAt(inout Lens lens, float cosine, float curvature) {
    lens.slope += lens.height * (2.0 * cosine * curvature);
}

/// Returns the point of the glass, at the distance of `front`, where `camera` sees an image through the lens that has
/// moved by `shift`; for the sky, the direction. The image lies at front + along * height.y / height.x.
vec3 shownAt(CameraParams camera, vec3 front, vec3 along, Lens lens, vec3 shift, bool isSky) {
    const vec3 offset = front - camera.origin;
    vec3 towards = lens.height.x * offset + lens.height.y * along + shift;
    if (camera.orthographic != 0u) {
        towards /= abs(lens.height.x) > 1e-6 ? lens.height.x : 1e-6;
        towards += camera.forward * dot(offset - towards, camera.forward);
    } else {
        // An image behind the camera is seen in the opposite direction.
        towards = normalize(dot(towards, camera.forward) < 0.0 ? -towards : towards);
        if (!isSky) towards *= length(offset);
    }
    return isSky ? towards : camera.origin + towards;
}

/// Returns `seen`, what the glass shows, at the point `front` of the glass; in the previous frame, at the point where
/// the glass showed the same. For a miss, the lens shows the sky. Its light is multiplied by `tint`.
FirstHit seenThrough(Mirror front, Lens lens, FirstHit seen, vec3 tint, ViewParams view) {
    seen.albedo *= tint;
    seen.albedoSpecular *= tint;
    const bool parallel = view.camera.orthographic != 0u;
    const vec3 along = parallel ? view.camera.forward : normalize(front.position - view.camera.origin);
    if (!seen.hit) lens.height = lens.slope;  // after an infinite distance
    // What is seen moves its image by 1 / height.x times as much, relative to the glass.
    vec3 shift = vec3(0.0);
    if (seen.hit) shift = seen.previous.position - seen.position - (front.previous.position - front.position);
    // The same arithmetic for both frames, so that nothing moves where nothing has moved.
    seen.position = shownAt(view.camera, front.position, along, lens, vec3(0.0), !seen.hit);
    seen.previous.position =
        shownAt(view.previousCamera, front.previous.position, along, lens, shift, !seen.hit);
    return seen;
}

#endif

// The camera as shaders see it. Included by C++ and GLSL.
#ifndef LIMPID_SHADERS_CAMERA_H
#define LIMPID_SHADERS_CAMERA_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#endif

/// A pixel at (x, y) in [-1, 1]^2 (y up) sees along forward + x right + y up (perspective; right and up are
/// scaled by the tangents of the half angles), or along forward from origin + x right + y up (orthographic;
/// half extents).
struct CameraParams {
    vec3 origin;
    uint orthographic;
    vec3 forward;  // unit
    float spread;  // growth of a pixel's width with distance; of an orthographic camera: the width itself
    vec3 right;
    vec3 up;
};

/// A launch of primary rays: from where, through which points of the pixels, by which random numbers.
struct ViewParams {
    CameraParams camera;
    CameraParams previousCamera;
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid
    uint width;
    uint height;
    uint frame;   // since the last reset
    uint stream;  // of random numbers
    uint seed;
    uint jitterPerPixel;
    vec2 jitter;  // otherwise: the point in every pixel
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

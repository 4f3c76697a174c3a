// The camera in the form that shaders read. Included by C++ and GLSL.
#ifndef LIMPID_SHADERS_CAMERA_H
#define LIMPID_SHADERS_CAMERA_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

/// For a pixel at (x, y) in [-1, 1]^2 (y up), the view direction of a perspective camera is forward + x right
/// + y up (right and up are scaled by the tangents of the half angles). An orthographic camera looks along
/// forward from origin + x right + y up (half extents).
struct CameraParams {
    vec3 origin;
    uint orthographic;
    vec3 forward;  // unit
    float spread;  // growth of a pixel's width with distance; for an orthographic camera: the width itself
    vec3 right;
    vec3 up;
    float lensRadius;     // of a thin lens around origin, world units; 0: a pinhole
    float focusDistance;  // from origin along forward to the plane in focus; only with a lens
};

// Where a primary ray goes through its pixel. The first sample since the last reset always goes through the
// centre.
LIMPID_CONST uint JITTER_PIXEL = 0u;  // a random point for each pixel
LIMPID_CONST uint JITTER_FRAME =
    1u;  // the same point for all pixels, a new one for each sample: Halton, bases 2 and 3
LIMPID_CONST uint JITTER_OFF = 2u;  // the centre

/// A launch of primary rays: the camera, the jitter and the random numbers.
struct ViewParams {
    CameraParams camera;
    CameraParams previousCamera;
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid
    uint width;
    uint height;
    uint firstSample;  // samples per pixel since the last reset, before this launch
    uint stream;       // of random numbers
    uint seed;
    uint jitter;          // JITTER_*
    float jitterSpan;     // part of the pixel that JITTER_FRAME covers, around the centre
    float samplesBefore;  // of each pixel in the mean, before this launch
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

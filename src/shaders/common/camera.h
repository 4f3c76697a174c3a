// The camera as shaders see it. Included by C++ and GLSL.
#ifndef LIMPID_SHADERS_CAMERA_H
#define LIMPID_SHADERS_CAMERA_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
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

// Where in its pixel a primary ray goes. The first sample since the last reset always goes through the
// centre.
LIMPID_CONST uint JITTER_PIXEL = 0u;  // anywhere, each pixel by its own random numbers
LIMPID_CONST uint JITTER_FRAME =
    1u;  // one point for all pixels, another one for each sample: Halton, bases 2 and 3
LIMPID_CONST uint JITTER_OFF = 2u;  // the centre

/// A launch of primary rays: from where, through which points of the pixels, by which random numbers.
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
    float samplesBefore;  // of each pixel in the mean, before this launch
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

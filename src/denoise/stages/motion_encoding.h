// How an embedding program encodes motion. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_MOTION_ENCODING_H
#define LIMPID_DENOISE_MOTION_ENCODING_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint MOTION_LAYER = 0u;  // none: it is the layer of base/layers/layer_table.h
LIMPID_CONST uint MOTION_GIVEN = 1u;  // the program's, scaled by `toPixels` and `toDistance`
LIMPID_CONST uint MOTION_STILL = 2u;  // there is none: all stands still, and only the camera moves

/// All zero: layers, for motion as well as for the motion of reflections.
struct MotionEncoding {
    uint kind;         // MOTION_*
    uint reflections;  // MOTION_LAYER or MOTION_GIVEN
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid. Not read of layers
    vec2 toPixels;     // scales motion to previous minus current position
    float toDistance;  // scales the third component; 0: motion has none, and distances change as of what
                       // stands still, also those of reflectors
    vec2 jitter;       // pixels
    CameraParams previousCamera;
    vec4 previousClipX;  // rows of the previous frame's matrix from world to clip space
    vec4 previousClipY;  // y points down
    vec4 previousClipW;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

// Parameters of the ingest pass. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_INGEST_PARAMS_H
#define LIMPID_DENOISE_INGEST_PARAMS_H

#include "denoise/stages/normal_encoding.h"
#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint DEPTH_DISTANCE = 0u;
LIMPID_CONST uint DEPTH_LINEAR = 1u;
LIMPID_CONST uint DEPTH_DEVICE = 2u;

struct IngestParams {
    CameraParams camera;
    CameraParams previousCamera;
    vec4 previousClipX;  // rows of the previous frame's matrix from world to clip space
    vec4 previousClipY;  // y points down
    vec4 previousClipW;
    vec4 deviceDepth;  // elements zz, zw, wz, ww (row, column) of the projection matrix
    NormalEncoding normals;
    vec2 motionToPixels;     // scales motion to previous minus current position
    float motionToDistance;  // scales the third component; 0: motion has none
    float farDepth;
    vec2 jitter;  // pixels
    uint width;
    uint height;
    uint depthKind;  // DEPTH_*
    uint reversed;   // device depth: 0 is far
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

// Parameters of the ingest pass. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_INGEST_PARAMS_H
#define LIMPID_DENOISE_INGEST_PARAMS_H

#include "denoise/stages/motion_encoding.h"
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
    MotionEncoding motion;
    vec4 deviceDepth;  // elements zz, zw, wz, ww (row, column) of the projection matrix
    NormalEncoding normals;
    float farDepth;
    uint width;
    uint height;
    uint depthKind;  // DEPTH_*
    uint reversed;   // device depth: 0 is far
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

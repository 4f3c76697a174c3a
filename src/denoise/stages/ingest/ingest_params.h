// Parameters of the ingest pass. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_INGEST_PARAMS_H
#define LIMPID_DENOISE_INGEST_PARAMS_H

#include "shaders/common/camera.h"

#ifdef __cplusplus
namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

// Bits of IngestParams::present, one for each input that the caller has.
LIMPID_CONST uint INGEST_SPECULAR = 1u << 1;
LIMPID_CONST uint INGEST_EMISSION = 1u << 2;
LIMPID_CONST uint INGEST_ALBEDO = 1u << 3;
LIMPID_CONST uint INGEST_ALBEDO_SPECULAR = 1u << 4;
LIMPID_CONST uint INGEST_MOTION = 1u << 7;
LIMPID_CONST uint INGEST_PREVIOUS_NORMAL = 1u << 8;
LIMPID_CONST uint INGEST_REFLECTION_MOTION = 1u << 9;

LIMPID_CONST uint NORMAL_SIGNED = 0u;
LIMPID_CONST uint NORMAL_UNORM = 1u;
LIMPID_CONST uint NORMAL_OCTAHEDRAL_SIGNED = 2u;
LIMPID_CONST uint NORMAL_OCTAHEDRAL_UNORM = 3u;

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
    vec3 viewX;        // axes of view space in the world
    vec3 viewY;
    vec3 viewZ;
    vec2 motionToPixels;     // scales motion to previous minus current position
    float motionToDistance;  // scales the third component; 0: motion has none
    float farDepth;
    vec2 jitter;  // pixels
    uint width;
    uint height;
    uint present;         // INGEST_*
    uint normalEncoding;  // NORMAL_*
    uint normalInView;
    uint depthKind;    // DEPTH_*
    uint reversed;     // device depth: 0 is far
    uint hasPrevious;  // 0: there is no previous frame, all motion is invalid
    uint twoSignals;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

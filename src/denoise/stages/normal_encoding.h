// How an embedding program encodes normals. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_NORMAL_ENCODING_H
#define LIMPID_DENOISE_NORMAL_ENCODING_H

#ifdef __cplusplus
#include "shaders/common/camera.h"

namespace limpid::denoise {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint NORMAL_SIGNED = 0u;
LIMPID_CONST uint NORMAL_UNORM = 1u;
LIMPID_CONST uint NORMAL_OCTAHEDRAL_SIGNED = 2u;
LIMPID_CONST uint NORMAL_OCTAHEDRAL_UNORM = 3u;

/// All zero: signed, in the world.
struct NormalEncoding {
    uint kind;  // NORMAL_*
    uint inView;
    vec3 viewX;  // axes of view space in the world
    vec3 viewY;
    vec3 viewZ;
};

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

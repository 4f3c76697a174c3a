// The choices of --sampler (rng.glsl). Included by C++ and GLSL.
#ifndef LIMPID_SHADERS_SAMPLER_H
#define LIMPID_SHADERS_SAMPLER_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#define LIMPID_CONST inline constexpr
#else
#define LIMPID_CONST const
#endif

LIMPID_CONST uint SAMPLER_PCG = 0u;
LIMPID_CONST uint SAMPLER_TEA = 1u;
LIMPID_CONST uint SAMPLER_SOBOL = 2u;

#undef LIMPID_CONST
#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

// Parameters of the compose shader. Included by C++ and GLSL.
#ifndef LIMPID_DENOISE_COMPOSE_PARAMS_H
#define LIMPID_DENOISE_COMPOSE_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid::denoise {
#endif

struct ComposeParams {
    uint width;
    uint height;
    float minAlbedo;  // as light was demodulated; 0: it was not
};

#ifdef __cplusplus
}  // namespace limpid::denoise
#endif
#endif

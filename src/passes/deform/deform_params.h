// Parameters of the refit shader. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_DEFORM_PARAMS_H
#define LIMPID_PASSES_DEFORM_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#endif

struct RefitParams {
    uint first;  // of refitNodes
    uint count;
    uint firstNode;  // of nodeBounds: the node that its first entry belongs to
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

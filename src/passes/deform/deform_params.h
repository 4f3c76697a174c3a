// Parameters of the refit and expand shaders. Included by C++ and GLSL.
#ifndef LIMPID_PASSES_DEFORM_PARAMS_H
#define LIMPID_PASSES_DEFORM_PARAMS_H

#ifdef __cplusplus
#include "base/math.h"
namespace limpid {
#endif

struct RefitParams {
    uint first;  // first entry of refitNodes
    uint count;
    uint firstNode;  // node of the first entry of nodeBounds
};

struct ExpandParams {
    uint first;  // node
    uint count;
};

#ifdef __cplusplus
}  // namespace limpid
#endif
#endif

#include "shaders/trace/ray_shaders.h"

#include "trace.rahit.h"
#include "trace.rchit.h"
#include "trace.rmiss.h"

namespace limpid {

const gpu::RayShaders& rayShaders() {
    static const gpu::RayShaders all{
        .miss = shaders::trace_rmiss, .closestHit = shaders::trace_rchit, .anyHit = shaders::trace_rahit};
    return all;
}

}  // namespace limpid

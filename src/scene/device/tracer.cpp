#include "scene/device/tracer.h"

namespace limpid::scene {

std::string_view toString(Tracer tracer) {
    return tracer == Tracer::Pipeline ? "pipeline" : "compute";
}

Tracer automaticTracer(const gpu::DeviceInfo& device) {
    return device.rayTracingCores ? Tracer::Pipeline : Tracer::Compute;
}

}  // namespace limpid::scene

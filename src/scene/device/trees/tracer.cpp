#include "scene/device/trees/tracer.h"

namespace limpid::scene {

std::string_view toString(Tracer tracer) {
    return tracer == Tracer::Hardware ? "hardware" : "compute";
}

Tracer automaticTracer(const gpu::DeviceInfo& device) {
    return device.rayTracingCores ? Tracer::Hardware : Tracer::Compute;
}

}  // namespace limpid::scene

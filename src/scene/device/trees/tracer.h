// Selects how rays are traced: the implementations of shaders/trace.glsl.
#pragma once

#include <optional>
#include <string_view>

#include "gpu/vulkan/device.h"

namespace limpid::scene {

enum class Tracer {
    Compute,   ///< our own tree, traversed in a compute shader; on every device
    Hardware,  ///< VK_KHR_ray_tracing_pipeline
};

struct TraceOptions {
    Tracer tracer = Tracer::Compute;
    /// Whether the `compute` tracer uses the traversal for GPUs or the one for CPUs. Empty: the one that
    /// suits the device. Both give the same pictures, so tests can run either on any device.
    std::optional<bool> gpuTraversal;
};

std::string_view toString(Tracer tracer);

/// Returns `hardware` if the device has ray-tracing hardware. Drivers that emulate the extension are slower
/// than our own tree (docs/benchmarks.md).
Tracer automaticTracer(const gpu::DeviceInfo& device);

}  // namespace limpid::scene

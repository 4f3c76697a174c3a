// How rays are traced: the implementations of shaders/trace.glsl.
#pragma once

#include <optional>
#include <string_view>

#include "gpu/vulkan/device.h"

namespace limpid::scene {

enum class Tracer {
    Compute,   ///< our own tree, walked in a compute shader; on every device
    Hardware,  ///< VK_KHR_ray_tracing_pipeline
};

struct TraceOptions {
    Tracer tracer = Tracer::Compute;
    /// How the `compute` tracer walks its trees: in the way of GPUs, or of CPUs. Unset: as suits the device.
    /// Pictures do not depend on it, so that tests can try either anywhere.
    std::optional<bool> gpuTraversal;
};

std::string_view toString(Tracer tracer);

/// `hardware` where there is hardware for it. Drivers that offer the extension without are slower at it than
/// our own tree (docs/benchmarks.md).
Tracer automaticTracer(const gpu::DeviceInfo& device);

}  // namespace limpid::scene

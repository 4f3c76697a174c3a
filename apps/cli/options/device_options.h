// --device and --tracer, the same for every command that uses a device.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "gpu/vulkan/device.h"
#include "renderer/frame/pipeline_store.h"
#include "scene/device/trees/tracer.h"

namespace limpid::cli {

struct DeviceChoice {
    gpu::DeviceOptions device;
    std::string tracer = "auto";
};

void addDeviceOptions(CLI::App& command, DeviceChoice& choice);

/// With the pipelines that earlier runs have compiled; those of this run are stored when it goes.
using OpenDevice = std::unique_ptr<gpu::Device, KeepPipelines>;
OpenDevice openDevice(const DeviceChoice& choice);
/// Throws UsageError if no picture has this size.
void checkPictureSize(gpu::Extent extent);
/// Throws UsageError if the device has no images of this size. `accumulates`: see Pipeline. Memory may be too
/// small all the same.
void checkPictureSize(gpu::Extent extent, const gpu::Device& device, bool accumulates);
/// Throws UsageError if the tracer that was asked for is not to be had on the device.
scene::Tracer chosenTracer(const DeviceChoice& choice, const gpu::Device& device);

}  // namespace limpid::cli

// --device and --tracer, the same for every command that uses a device.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "gpu/device.h"

namespace limpid::cli {

struct DeviceChoice {
    gpu::DeviceOptions device;
    std::string tracer = "auto";
};

void addDeviceOptions(CLI::App& command, DeviceChoice& choice);

/// Opens the device and settles the tracer. Throws UsageError if the tracer is not to be had there.
std::unique_ptr<gpu::Device> openDevice(const DeviceChoice& choice);

}  // namespace limpid::cli

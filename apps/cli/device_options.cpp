#include "device_options.h"

#include "base/error.h"

namespace limpid::cli {

void addDeviceOptions(CLI::App& command, DeviceChoice& choice) {
    command.add_option("--device", choice.device.select,
                       "Device by name, index, or 'cpu'; default: the best one");
    command.add_option("--tracer", choice.tracer, "How rays are traced: auto or compute")
        ->check(CLI::IsMember({"auto", "compute"}));
    command.add_flag("--validation", choice.device.validation, "Run under the Vulkan validation layer; slow");
}

std::unique_ptr<gpu::Device> openDevice(const DeviceChoice& choice) {
    return std::make_unique<gpu::Device>(choice.device);
}

}  // namespace limpid::cli

#include "cli/options/device_options.h"

#include "base/error.h"
#include "base/log.h"

namespace limpid::cli {

void addDeviceOptions(CLI::App& command, DeviceChoice& choice) {
    command.add_option("--device", choice.device.select,
                       "Device by name, index, or 'cpu'; default: the best one");
    command.add_option("--tracer", choice.tracer, "How rays are traced: auto (default), compute or pipeline")
        ->check(CLI::IsMember({"auto", "compute", "pipeline"}));
    choice.device.messages = log::write;
    command.add_flag("--validation", choice.device.validation, "Run under the Vulkan validation layer; slow");
}

std::unique_ptr<gpu::Device> openDevice(const DeviceChoice& choice) {
    return std::make_unique<gpu::Device>(choice.device);
}

scene::Tracer chosenTracer(const DeviceChoice& choice, const gpu::Device& device) {
    if (choice.tracer == "auto") return scene::automaticTracer(device.info());
    if (choice.tracer == "compute") return scene::Tracer::Compute;
    if (!device.info().rayTracing) {
        throw UsageError("--tracer pipeline: " + device.info().name +
                         " has no ray-tracing pipelines; --tracer compute runs on every device");
    }
    return scene::Tracer::Pipeline;
}

}  // namespace limpid::cli

#include "cli/options/device_options.h"

#include "base/error.h"
#include "base/log.h"
#include "cli/cluster/local_share.h"
#include "cli/cluster/session.h"
#include "cli/console/help_text.h"
#include "gpu/specialise/specialise.h"

namespace limpid::cli {

namespace {

std::string faultOfTracer(const std::string& name) {
    if (name == "auto" || name == "compute" || name == "hardware") return "";
    if (name == "pipeline") return "--tracer pipeline is now --tracer hardware";
    return "there is no tracer '" + name + "'; the tracers are auto compute hardware";
}

}  // namespace

void addDeviceOptions(CLI::App& command, DeviceChoice& choice) {
    const OptionGroup group(command, "Device");
    command.add_option("--device", choice.device.select,
                       "Device by name, index, or 'cpu'; default: the best one");
    command.add_option("--tracer", choice.tracer, "Ray tracing method: auto (default), compute or hardware")
        ->check(CLI::Validator(faultOfTracer, "auto|compute|hardware"));
    choice.device.messages = log::write;
    choice.device.specialise = gpu::specialiser();
    command.add_flag("--validation", choice.device.validation, "Run with the Vulkan validation layer; slow");
}

OpenDevice openDevice(const DeviceChoice& choice) {
    gpu::DeviceOptions options = choice.device;
    if (ranks() && ranks()->place().localSize > 1)
        options.select = deviceOfProcess(gpu::enumerateDevices(), options.select, ranks()->place().localRank);
    OpenDevice device(new gpu::Device(options));
    loadPipelines(*device, pipelineFile(*device));
    return device;
}

scene::Tracer chosenTracer(const DeviceChoice& choice, const gpu::Device& device) {
    if (choice.tracer == "auto") return scene::automaticTracer(device.info());
    if (choice.tracer == "compute") return scene::Tracer::Compute;
    if (!device.info().rayTracing) {
        throw UsageError("--tracer hardware: " + device.info().name +
                         " has no ray-tracing pipelines; --tracer compute runs on every device");
    }
    return scene::Tracer::Hardware;
}

}  // namespace limpid::cli

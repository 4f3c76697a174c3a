#include "cli/options/device_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/log.h"
#include "cli/cluster/local_share.h"
#include "cli/cluster/session.h"
#include "cli/console/help_text.h"
#include "gpu/specialise/specialise.h"
#include "image/io/rows/limits.h"

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

void checkPictureSize(gpu::Extent extent) {
    const uint64_t pixels = uint64_t{extent.width} * extent.height;
    if (pixels > image::maxPixels)
        throw UsageError(
            fmt::format("--width and --height: {}x{} are {} pixels, but a picture has at most {}",
                        extent.width, extent.height, pixels, image::maxPixels));
}

void checkPictureSize(gpu::Extent extent, const gpu::Device& device, bool accumulates) {
    const auto refuse = [&](uint64_t most, const char* unit) {
        throw UsageError(fmt::format("--width and --height: {}x{} pixels, but {} has at most {} {}",
                                     extent.width, extent.height, device.info().name, most, unit));
    };
    if (std::max(extent.width, extent.height) > device.maxImageSide())
        refuse(device.maxImageSide(), "a side");
    // Means have four floats a pixel, and the inputs of denoisers at least four halves.
    const uint64_t most = device.maxAllocationBytes() / (accumulates ? 16 : 8);
    if (uint64_t{extent.width} * extent.height > most) refuse(most, "in an image");
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

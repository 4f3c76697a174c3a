// What the driver has compiled, kept in the user's cache folder from one run of the program to the next.
#pragma once

#include <filesystem>

#include "gpu/vulkan/device.h"

namespace limpid {

/// $XDG_CACHE_HOME/limpid or ~/.cache/limpid, with a file for each device, driver and version of Limpid.
/// Empty if the environment names neither folder.
std::filesystem::path pipelineFile(const gpu::Device& device);

/// Before the device's first pipeline is made. A file that is not there, or damaged, is ignored.
void loadPipelines(gpu::Device& device, const std::filesystem::path& file);

/// Failures are ignored: the next run compiles again. Nothing is written where the driver keeps nothing
/// (lavapipe).
void storePipelines(const gpu::Device& device, const std::filesystem::path& file);

/// Deletes a device after its pipelines are stored.
struct KeepPipelines {
    void operator()(gpu::Device* device) const {
        storePipelines(*device, pipelineFile(*device));
        delete device;
    }
};

}  // namespace limpid

// Stores the driver's compiled pipelines in the user's cache folder between runs.
#pragma once

#include <filesystem>

#include "gpu/vulkan/device.h"

namespace limpid {

/// Returns a file in $XDG_CACHE_HOME/limpid or ~/.cache/limpid; there is one for each device, driver and
/// version of Limpid. Empty if the environment names neither folder.
std::filesystem::path pipelineFile(const gpu::Device& device);

/// Call it before the device's first pipeline is created. Ignores a file that is missing or damaged.
void loadPipelines(gpu::Device& device, const std::filesystem::path& file);

/// Failures are ignored: the next run compiles again. Writes nothing if the driver has nothing to store
/// (lavapipe).
void storePipelines(const gpu::Device& device, const std::filesystem::path& file);

/// A deleter that stores a device's pipelines before it deletes the device.
struct KeepPipelines {
    void operator()(gpu::Device* device) const {
        storePipelines(*device, pipelineFile(*device));
        delete device;
    }
};

}  // namespace limpid

// What `limpid bench quality` was asked to do.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/options/device_options.h"
#include "lab/quality/quality_methods.h"

namespace limpid::cli {

struct QualityOptions {
    DeviceChoice device;
    MethodChoice methods;
    std::string preset;
    std::vector<std::string> scenes, assignments;
    std::string jitter, integrator, environment, cameraPath = "orbit", folder, report, scenesFolder,
                                                 pathsFolder, referenceFolder, weights;
    uint32_t width = 640, height = 360, samples = 1, reportMegabytes = 64;
    std::optional<uint64_t> referenceSamples;  ///< overrides the sequences' own numbers
    std::optional<uint64_t> first, frames;     ///< likewise
    bool lab = false, quick = false, json = false, aliased = false;
};

}  // namespace limpid::cli

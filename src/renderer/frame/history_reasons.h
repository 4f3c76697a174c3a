// Why the denoiser kept or rejected the history of each pixel, on the host.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gpu/graph/frame_graph.h"

namespace limpid {

struct HistoryReasons {
    struct Signal {
        std::string name;              ///< "diffuse", "specular", or "joint" for all light
        std::vector<uint32_t> texels;  ///< two words per pixel: denoise/stages/reproject/reasons_params.h
    };
    gpu::Extent extent;
    std::vector<Signal> signals;  ///< empty: the denoiser keeps no histories, or was not asked
};

}  // namespace limpid

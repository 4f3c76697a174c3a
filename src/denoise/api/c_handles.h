// What stands behind the C interface's handles.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "denoise/api/instance.h"
#include "gpu/vulkan/device.h"

struct limpid_device {
    std::shared_ptr<limpid::gpu::Device> device;
    bool adopted = false;  ///< a device of the caller's: frames are recorded, not executed
};

struct limpid_denoiser {
    limpid_denoiser(const limpid_device& on, const limpid_denoiser_desc& desc);

    /// Reads and clears that a cut was asked for; the frame's own word counts, too.
    bool startsAnew(bool reset);
    /// A frame has been recorded for real.
    void finish() { hasPrevious = true; }

    std::shared_ptr<limpid::gpu::Device> device;
    bool adopted;
    limpid_denoiser_desc desc;
    limpid::denoise::FilterSettings settings;
    limpid::gpu::FrameGraph graph;
    bool hasPrevious = false;                  ///< a frame has been recorded since the last cut
    std::vector<limpid::gpu::PassTime> times;  ///< that limpid_denoiser_timings() told last
    std::vector<std::unique_ptr<limpid::gpu::FrameGraph>> warmUps;  ///< may be under way on the device
};

namespace limpid::denoise {

/// The options of a denoiser's graph.
gpu::GraphOptions graphOptions(const limpid_denoiser_desc& desc);

/// Records a frame of inputs that do not exist: what prepare() and memory need to know.
void recordDryFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc, const FilterSettings& settings,
                    gpu::Backing filters, bool orthographic, bool signalsToo);

/// Throws UsageError if an input that the method needs is not there.
void requireInputs(const limpid_denoiser_desc& desc, const IngestImages& images);

/// By limpid_input.
gpu::ImageHandle& imageOf(IngestImages& images, size_t input);

}  // namespace limpid::denoise

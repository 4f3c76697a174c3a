// The objects behind the C interface's handles.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "denoise/api/instance.h"
#include "gpu/vulkan/device.h"

struct limpid_device {
    std::shared_ptr<limpid::gpu::Device> device;
    bool adopted = false;  ///< the caller's own device: frames are recorded, not executed
};

struct limpid_denoiser {
    limpid_denoiser(const limpid_device& on, const limpid_denoiser_desc& desc);

    /// Resets the histories if `reset` is set. Returns true if the next frame starts without history, or the
    /// method keeps none.
    bool startsAnew(bool reset);
    /// Call it when a frame has really been recorded.
    void finish() { hasPrevious = true; }

    std::shared_ptr<limpid::gpu::Device> device;
    bool adopted;
    limpid_denoiser_desc desc;
    limpid::denoise::FilterSettings settings;
    limpid::gpu::FrameGraph graph;
    bool hasPrevious = false;                  ///< a frame has been recorded since the last reset
    std::vector<limpid::gpu::PassTime> times;  ///< as last returned by limpid_denoiser_timings()
    std::vector<std::unique_ptr<limpid::gpu::FrameGraph>> warmUps;  ///< may still be executing on the device
};

namespace limpid::denoise {

/// Returns the options of a denoiser's graph.
gpu::GraphOptions graphOptions(const limpid_denoiser_desc& desc);

/// A frame that is recorded, but never executed.
struct DryFrame {
    std::vector<limpid_input> without;  ///< of all inputs
    bool orthographic = false;
    gpu::Format color = gpu::Format::RGBA32Float;  ///< of the output
};

/// Frames that together contain every pass, in the variants of shaders that usual inputs need.
std::vector<DryFrame> dryFrames();

/// Records the frame to find out what prepare() and memory need.
void recordDryFrame(gpu::FrameGraph& graph, const limpid_denoiser_desc& desc, const FilterSettings& settings,
                    const gpu::FilterChoice& choice, const DryFrame& frame, bool signalsToo);

/// Throws UsageError if an input that the method requires is missing.
void requireInputs(const limpid_denoiser_desc& desc, const IngestImages& images);

/// `input` is a limpid_input.
gpu::ImageHandle& imageOf(IngestImages& images, size_t input);

}  // namespace limpid::denoise

// The accumulation pass: the running mean, by count, of an image over frames.
#pragma once

#include <string>

#include "base/layers/layer_table.h"
#include "gpu/graph/frame_graph.h"

namespace limpid {

/// Writes the mean of `countBefore` samples in `before` and `countAdded` samples in `added` to `after`, all
/// within one frame. Alpha is as in the function below.
struct AccumulateStep {
    gpu::ImageHandle before, added, after;
    float countBefore = 0.0f;  ///< 0: `before` is not read
    float countAdded = 1.0f;
    VarianceOf varianceOf = VarianceOf::Nothing;
};
void accumulateStep(gpu::FrameGraph& graph, const std::string& name, const AccumulateStep& step);

/// Adds `added` (mean of `countAdded` samples; alpha: their mean squared deviation) to the history `name`,
/// which holds the mean of `countBefore` samples, and returns the new mean. countBefore = 0 starts a new
/// mean. All images are rgba32f; with VarianceOf::Nothing alpha is averaged like the rest.
gpu::ImageHandle accumulate(gpu::FrameGraph& graph, const std::string& name, gpu::ImageHandle added,
                            uint64_t countBefore, uint32_t countAdded, VarianceOf varianceOf);

}  // namespace limpid

// Exact sums of a frame's samples, block by block, independent of who renders the blocks and in which order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "passes/accumulate/accumulate.h"
#include "renderer/frame/frame.h"
#include "renderer/layers/layers.h"
#include "renderer/long/block_plan.h"
#include "renderer/long/sums/fixed_point.h"

namespace limpid {

/// Means are summed as count * mean in units of 2^-62: exact for every float32 mean that is 0 or of magnitude
/// 2^-38 to 2^40 (1e12), rounded below, clamped above. 2^24 samples of the largest cannot overflow.
inline constexpr int meanFraction = 62;
inline constexpr double meanLimit = 0x1p40;
/// Squares (of luminance, distance or normals) in units of 2^-38, each clamped at 2^63 (9e18).
inline constexpr int squareFraction = 38;
inline constexpr double squareLimit = 0x1p63;

/// The sums of one layer.
struct LayerSums {
    const LayerInfo* info = nullptr;  ///< one that is a mean; beautyLayer where layers are not computed
    bool squares = false;             ///< squares are summed, too, for the variance
    std::vector<Int128> values;  ///< by pixel: the components, then the square if there is one; empty: all 0

    size_t planes() const { return info->meanComponents() + (squares ? 1 : 0); }
};

/// Returns the means of a layer, four floats per pixel (base/layers/layer_table.h says which).
using MeansOf = std::function<std::vector<float>(const LayerInfo&)>;

/// Counters of a block's samples.
struct SampleCounts {
    uint64_t rays = 0;      ///< closest-hit and shadow rays
    uint64_t rejected = 0;  ///< samples dropped because they were NaN or infinite
    uint64_t clamped = 0;   ///< block means that were NaN or beyond the limits above

    SampleCounts& operator+=(const SampleCounts& other);
};

/// The sums of one frame, and which blocks are in them.
struct FrameSums {
    gpu::Extent extent;
    BlockPlan plan;
    std::vector<LayerSums> layers;
    std::vector<bool> blocks;  ///< by number: whether it is in the sums
    uint64_t partSamples = 0;  ///< samples of an unfinished block; used for pictures, not for files
    bool wantsIds = false;
    std::vector<uint32_t> ids;  ///< instance and material per pixel; empty until block 0 is added
    SampleCounts counts;

    /// Sums that are zero and take no memory yet, for the named layers (layers.h; none: beauty only).
    FrameSums(gpu::Extent extent, const BlockPlan& plan, const std::vector<std::string>& layerNames);

    uint64_t samples() const;  ///< per pixel, in the sums
    uint32_t blockCount() const;
    bool complete() const { return blockCount() == blocks.size(); }
    uint64_t pixels() const { return uint64_t{extent.width} * extent.height; }

    /// Adds the means of a block's samples. Throws Error if the block was added before, or part of a block
    /// was.
    void addBlock(uint32_t block, const MeansOf& meansOf);
    /// Adds `samples` of an unfinished block. After this no block can be added.
    void addPart(uint32_t samples, const MeansOf& meansOf);
    /// Adds the other's blocks. Both must have the same frame and layers. Throws Error if a block is in both.
    void merge(const FrameSums& other);

    /// The means, as the layers of a picture. Without block 0, `ids` say that no pixel hit anything. Throws
    /// Error if there are no samples.
    RenderedLayers means() const;

  private:
    void add(uint32_t samples, const MeansOf& meansOf);
};

}  // namespace limpid

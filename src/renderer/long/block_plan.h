// Divides the samples of a frame into blocks, in the same way for every process that renders some of them.
#pragma once

#include <algorithm>
#include <cstdint>

namespace limpid {

/// Samples per pixel in a block. A block is summed on the device in float32 and then added to the exact sums
/// (renderer/long/sums/accumulation.h). It is also the most that a killed render loses, and the least that a
/// shard gets. On a fast GPU, downloading a block costs as much time as some samples, so blocks are larger if
/// there are many samples. The size depends on nothing else, so all devices divide a render alike.
inline constexpr uint32_t blockSamplesFor(uint64_t samples) {
    return samples < 4096 ? 64 : 256;
}

inline constexpr uint64_t maxSamplesPerPixel = uint64_t{1} << 24;
inline constexpr uint32_t maxBlockSamples = 1u << 16;

/// Divides a frame's samples into blocks, and blocks into launches. A launch never spans two blocks. The last
/// block, and the last launch of each block, may be short. Random numbers depend on the launch's number in
/// the frame, so the plan affects the pixels.
struct BlockPlan {
    uint64_t samples = 1;        ///< per pixel: 1 to maxSamplesPerPixel
    uint32_t blockSamples = 64;  ///< 1 to maxBlockSamples
    uint32_t launchSamples = 1;  ///< 1 to blockSamples

    uint32_t blocks() const { return static_cast<uint32_t>((samples - 1) / blockSamples + 1); }
    uint32_t samplesOf(uint32_t block) const {
        return static_cast<uint32_t>(
            std::min<uint64_t>(blockSamples, samples - uint64_t{block} * blockSamples));
    }
    uint32_t launchesOf(uint32_t block) const { return (samplesOf(block) - 1) / launchSamples + 1; }
    /// Number of the block's first launch in the frame.
    uint32_t firstLaunch(uint32_t block) const {
        return block * static_cast<uint32_t>((blockSamples - 1) / launchSamples + 1);
    }
    /// Number of launches of the whole frame.
    uint64_t launches() const {
        return uint64_t{firstLaunch(blocks() - 1)} + uint64_t{launchesOf(blocks() - 1)};
    }
    bool operator==(const BlockPlan&) const = default;
};

}  // namespace limpid

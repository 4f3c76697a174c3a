// How the samples of a frame are divided, the same for every process that renders a part of them.
#pragma once

#include <algorithm>
#include <cstdint>

namespace limpid {

/// Samples per pixel in a block: what is summed on the device in float32 before it goes into the exact sums
/// (renderer/long/accumulation.h), what a killed render loses at most, and the least that a shard gets.
/// Fetching a block costs a fast GPU as much as some samples, hence larger blocks where there are many of
/// them. Depends on nothing else, so that any two devices divide a render alike.
inline constexpr uint32_t blockSamplesFor(uint64_t samples) {
    return samples < 4096 ? 64 : 256;
}

inline constexpr uint64_t maxSamplesPerPixel = uint64_t{1} << 24;
inline constexpr uint32_t maxBlockSamples = 1u << 16;

/// A frame's samples, in blocks, in launches. A launch never straddles two blocks; the last block, and the
/// last launch of each, may be short. Random numbers depend on the launch's number in the frame, so the plan
/// is part of what decides the pixels.
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
    /// Number, in the frame, of the block's first launch.
    uint32_t firstLaunch(uint32_t block) const {
        return block * static_cast<uint32_t>((blockSamples - 1) / launchSamples + 1);
    }
    /// Of the whole frame.
    uint64_t launches() const {
        return uint64_t{firstLaunch(blocks() - 1)} + uint64_t{launchesOf(blocks() - 1)};
    }
    bool operator==(const BlockPlan&) const = default;
};

}  // namespace limpid

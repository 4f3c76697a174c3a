#include "renderer/long/merge/merge.h"

#include <fmt/format.h>

#include <set>

#include "base/error.h"
#include "base/files/frame_pattern.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

void checkStill(const fs::path& file, const AccumulationHeader& header) {
    if (header.frames > 1) throw InputError(file, "is a checkpoint of a sequence; stills are merged");
}

void checkBelongs(const fs::path& file, const Accumulation& added, const fs::path& first,
                  const Accumulation& sum) {
    if (const auto difference = firstDifference(added.header, sum.header))
        throw InputError(file, fmt::format("does not belong to {}: {}", first.string(), *difference));
    if (const auto difference = firstDifferenceOfLook(added.header, sum.header))
        throw InputError(file, fmt::format("does not belong to {}: {}", first.string(), *difference));
    for (uint32_t block = 0; block < added.sums.blocks.size(); ++block) {
        if (added.sums.blocks[block] && sum.sums.blocks[block])
            throw InputError(file, fmt::format("has block {}, which is in an earlier file too", block));
    }
}

/// Throws if blocks are missing, naming them, and their shards if all files were divided alike.
void checkComplete(const fs::path& first, const FrameSums& sums, const std::set<uint32_t>& shardCounts) {
    std::vector<int> missing, shards;
    std::set<uint32_t> indices;
    for (uint32_t block = 0; block < sums.blocks.size(); ++block) {
        if (sums.blocks[block]) continue;
        missing.push_back(static_cast<int>(block));
        indices.insert(block % *shardCounts.begin() + 1);
    }
    if (missing.empty()) return;
    std::string text = fmt::format("together with the others lacks block {} of 0-{}", describeFrames(missing),
                                   sums.blocks.size() - 1);
    if (shardCounts.size() == 1) {
        shards.assign(indices.begin(), indices.end());
        text += fmt::format(": shard {} of {} is missing or unfinished", describeFrames(shards),
                            *shardCounts.begin());
    }
    throw InputError(first, text);
}

}  // namespace

Accumulation mergeAccumulations(std::span<const fs::path> files) {
    if (files.empty()) throw UsageError("there is nothing to merge");
    Accumulation sum = readAccumulation(files.front());
    checkStill(files.front(), sum.header);
    std::set<uint32_t> shardCounts{sum.header.shard.count};
    for (const fs::path& file : files.subspan(1)) {
        const Accumulation added = readAccumulation(file);
        checkStill(file, added.header);
        checkBelongs(file, added, files.front(), sum);
        warnOfOtherDevice(file, added.header, sum.header);
        sum.sums.merge(added.sums);
        shardCounts.insert(added.header.shard.count);
    }
    checkComplete(files.front(), sum.sums, shardCounts);
    return sum;
}

}  // namespace limpid

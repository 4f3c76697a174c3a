#include "renderer/long/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"

namespace limpid {

namespace fs = std::filesystem;

Checkpoint::Checkpoint(fs::path path) : path_(std::move(path)) {
    checkWritable(path_);
}

bool Checkpoint::exists() const {
    std::error_code status;
    return fs::exists(path_, status);
}

Accumulation Checkpoint::load(const AccumulationHeader& ours) const {
    Accumulation loaded = readAccumulation(path_);
    if (const auto difference = firstDifference(loaded.header, ours))
        throw InputError(path_, "is the checkpoint of another render: " + *difference);
    // A still is written anew as a whole, but the frames that a sequence has keep their look.
    const auto look = ours.frames > 1 ? firstDifferenceOfLook(loaded.header, ours) : std::nullopt;
    if (look) throw InputError(path_, "is the checkpoint of frames that look different: " + *look);
    const Shard theirs = loaded.header.shard;
    if (theirs != ours.shard) {
        throw InputError(path_, fmt::format("is the checkpoint of shard {}/{}, not {}/{}", theirs.index,
                                            theirs.count, ours.shard.index, ours.shard.count));
    }
    warnOfOtherDevice(path_, loaded.header, ours);
    return loaded;
}

void Checkpoint::save(const AccumulationHeader& header, const FrameSums& sums) {
    const Clock::time_point start = Clock::now();
    // Left by a process that was killed while saving; nothing else would remove it.
    removeStaleTemporaries(path_);
    writeAccumulation(path_, header, sums);
    saved_ = Clock::now();
    cost_ = saved_ - start;
}

bool Checkpoint::saveLast(const AccumulationHeader& header, const FrameSums& sums) {
    try {
        save(header, sums);
        return true;
    } catch (const OutputError& fault) {
        // The picture may lie on another disk, or need less room than the sums.
        log::warn("{}{}", fault.what(), exists() ? "; --resume goes on from an earlier state" : "");
        return false;
    }
}

void Checkpoint::saveIfDue(const AccumulationHeader& header, const FrameSums& sums) {
    if (!isDue()) return;
    try {
        save(header, sums);
    } catch (const OutputError& fault) {
        // A full disk may have room again, and the picture may lie on another one.
        log::warn("{}; the render goes on, and tries again", fault.what());
        saved_ = Clock::now();
        cost_ = std::max<Clock::duration>(cost_, std::chrono::seconds(1));
    }
}

bool Checkpoint::isDue() const {
    return Clock::now() - saved_ >= 20 * cost_;
}

}  // namespace limpid

#include "shot/run/output_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "base/error.h"
#include "base/files/file.h"
#include "shot/run/frame_choice.h"

namespace limpid::shot {
namespace {

namespace fs = std::filesystem;

/// A name by which equal files can be found, whether they exist or not.
fs::path wholePath(const fs::path& path) {
    const fs::path target = fs::absolute(linkTarget(path));
    std::error_code fault;
    const fs::path whole = fs::weakly_canonical(target, fault);
    return fault ? target.lexically_normal() : whole;
}

/// The numbers of a pattern's files that the job reads, and of those that exist: they may be frames of the
/// shot that the job leaves out.
std::set<int> sourcesOf(const FramePattern& pattern, const ShotJob& job) {
    std::set<int> frames(job.frames.begin(), job.frames.end());
    try {
        for (const int frame : pattern.existingFrames()) frames.insert(frame);
    } catch (const InputError&) {
        // The folder cannot be read: whoever reads the files will say so.
    }
    return frames;
}

/// True if a file of the pattern is an output, perhaps of another frame: "a.1%d.exr" of frame 2 is "a.%d.exr"
/// of frame 12.
bool isReplaced(const FramePattern& pattern, const std::set<fs::path>& outputs, const ShotJob& job) {
    const auto isOutput = [&](int frame) {
        const fs::path file = pattern.format(std::max(frame, 0));
        const bool written = std::ranges::binary_search(askedFrames(job), frame);
        try {
            // isSameFile() also knows hard links.
            return outputs.contains(wholePath(file)) || (written && isSameFile(file, outputOf(job, frame)));
        } catch (const std::runtime_error&) {
            return false;  // a link that leads to no file, and so to no output
        }
    };
    return std::ranges::any_of(sourcesOf(pattern, job), isOutput);
}

}  // namespace

void refuseReplacing(const ShotRequest& r, const ShotJob& job) {
    std::set<fs::path> outputs;
    for (const int frame : askedFrames(job)) outputs.insert(wholePath(outputOf(job, frame)));
    if (isReplaced(job.input, outputs, job)) throw UsageError("'" + r.output + "': the output is the input");
    for (const auto& [name, pattern] : job.load.files) {
        if (isReplaced(pattern, outputs, job))
            throw UsageError(fmt::format("'{}': the output is the file of --file {}", r.output, name));
    }
}

}  // namespace limpid::shot

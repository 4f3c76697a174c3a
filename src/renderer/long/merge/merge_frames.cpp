#include "renderer/long/merge/merge_frames.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "image/io/exr/exr.h"

namespace limpid {
namespace {

namespace fs = std::filesystem;

constexpr const char* renderKey = "limpid.render";
constexpr const char* frameKey = "limpid.frame";
constexpr const char* framesKey = "limpid.frames";
constexpr int maxMergedFrames = 1000000;

struct Origin {
    std::string render;
    int frame = 0, frames = 0;
};

int numberOf(const fs::path& file, const char* key, const std::string& text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < 0)
        throw InputError(file, fmt::format("its attribute {} is no number", key));
    return value;
}

Origin originOf(const fs::path& file) {
    const image::LayeredImage picture = image::readExr(file);
    const auto get = [&](const char* key) {
        const auto found = picture.metadata.find(key);
        if (found == picture.metadata.end())
            throw InputError(file, fmt::format("has no attribute {}: no frame of a sequence", key));
        return found->second;
    };
    const Origin origin{get(renderKey), numberOf(file, frameKey, get(frameKey)),
                        numberOf(file, framesKey, get(framesKey))};
    if (origin.frame >= origin.frames || origin.frames > maxMergedFrames)
        throw InputError(file, fmt::format("is frame {} of {}", origin.frame, origin.frames));
    return origin;
}

/// The files by frame, each checked against the first.
class Collection {
  public:
    void add(const FramePattern& input) {
        const std::vector<int> frames = input.existingFrames();
        if (frames.empty()) throw InputError(input.text(), "there are no such frames");
        for (const int frame : frames) add(input.format(frame), frame);
    }
    void checkComplete() const {
        std::vector<int> missing;
        for (int frame = 0; frame < first_.frames; ++frame) {
            if (!files_.contains(frame)) missing.push_back(frame);
        }
        if (missing.empty()) return;
        throw InputError(firstFile_, fmt::format("together with the others lacks frame {} of 0-{}",
                                                 describeFrames(missing), first_.frames - 1));
    }
    const std::map<int, fs::path>& files() const { return files_; }

  private:
    void add(const fs::path& file, int frame) {
        const Origin origin = originOf(file);
        if (files_.empty()) {
            first_ = origin;
            firstFile_ = file;
        }
        if (origin.render != first_.render || origin.frames != first_.frames) {
            throw InputError(
                file, fmt::format("does not belong to {}: it is of another render", firstFile_.string()));
        }
        if (origin.frame != frame)
            throw InputError(file,
                             fmt::format("is frame {} by its content, {} by its name", origin.frame, frame));
        const auto [at, added] = files_.emplace(frame, file);
        if (!added)
            throw InputError(file, fmt::format("is frame {}, which is {} too", frame, at->second.string()));
    }

    std::map<int, fs::path> files_;
    Origin first_;
    fs::path firstFile_;
};

void copyFile(const fs::path& from, const fs::path& to) {
    std::error_code different;
    if (fs::equivalent(from, to, different)) return;
    const std::vector<std::byte> bytes = readFile(from);
    writeAtomically(to, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        file.close();
        if (!file) throw OutputError(to, "cannot be written: the disk may be full");
    });
}

}  // namespace

std::map<std::string, std::string> frameMetadata(const AccumulationHeader& header, uint64_t frame) {
    if (header.frames == 1) return {};
    return {{renderKey, hashText(renderHash(header))},
            {frameKey, std::to_string(frame)},
            {framesKey, std::to_string(header.frames)}};
}

int mergeFrames(std::span<const FramePattern> inputs, const FramePattern& output) {
    Collection frames;
    for (const FramePattern& input : inputs) frames.add(input);
    frames.checkComplete();
    for (const auto& [frame, file] : frames.files()) copyFile(file, output.format(frame));
    return static_cast<int>(frames.files().size());
}

}  // namespace limpid
